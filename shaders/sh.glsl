// Radiance in one direction from spherical-harmonic coefficients: the sum of c(l, m) Y(l, m).
//
// The recurrence of shviewer/harmonics/basis.py in float32; the convention is written there. No trigonometry, no
// division by sin(theta), and one program for every number of bands. The normalisation is already in the terms.
//
// In: direction, unit, in the frame of the light. Out: linear RGB; may be negative (ringing).

layout(std140) uniform ShBlock {
    vec4 sh_terms[SH_TERMS];    // rgb: coefficient times N(l, m); w: q(l+1, m). The order is that of layout.py
};
uniform int n_bands;

vec3 sh_radiance(vec3 direction) {
    float one_minus_z = dot(direction.xy, direction.xy) / (1.0 + abs(direction.z));
    float south = direction.z < 0.0 ? -1.0 : 1.0;
    vec3 sum = vec3(0.0);
    int i = 0;

    float ratio = 1.0, difference = 0.0, sign_ = 1.0;           // G(l, m), D(l, m), south^(l+m)
    for (int l = 0; l < n_bands; ++l, ++i) {
        vec4 term = sh_terms[i];
        sum += (sign_ * ratio) * term.rgb;
        sign_ *= south;
        difference = term.w * (difference - one_minus_z * ratio) - difference;
        ratio += difference;
    }

    vec2 azimuth = direction.xy;                                // (x + iy)^m
    for (int m = 1; m < n_bands; ++m) {
        vec3 cosines = vec3(0.0), sines = vec3(0.0);
        ratio = 1.0, difference = 0.0, sign_ = 1.0;
        for (int l = m; l < n_bands; ++l, i += 2) {
            vec4 term = sh_terms[i];
            float signed_ratio = sign_ * ratio;
            cosines += signed_ratio * term.rgb;
            sines += signed_ratio * sh_terms[i + 1].rgb;
            sign_ *= south;
            difference = term.w * (difference - one_minus_z * ratio) - difference;
            ratio += difference;
        }
        sum += azimuth.x * cosines + azimuth.y * sines;
        azimuth = vec2(azimuth.x * direction.x - azimuth.y * direction.y,
                       azimuth.x * direction.y + azimuth.y * direction.x);
    }
    return sum;
}
