// Radiance of a sum of lobes: the profiles of shviewer/harmonics/zonal.py and quantities/glossy.py, term for term.
//
// A program knows those kinds whose bit is set in PROFILES. Each profile is a function of |direction - axis|^2, which keeps its digits in float32 where the cosine is close to 1.

layout(std140) uniform LobeBlock {
    vec4 lobes[3 * LOBE_SLOTS]; // axis and kind; radiance; parameters
};
uniform ivec2 original_lobes;   // the first, and one beyond the last
uniform ivec2 sun_lobes;        // split off the light, to be added to the reconstruction
uniform bool soft_edges;        // spread the edge of a disc over one pixel, for the eye; off where numbers are compared

float profile_value(int kind, vec2 parameters, float squared_chord) {
#if (PROFILES >> PROFILE_CLAMPED_LINEAR) % 2 == 1
    if (kind == PROFILE_CLAMPED_LINEAR)
        return max(0.0, (parameters.x - parameters.y) - 0.5 * parameters.x * squared_chord);
#endif
#if (PROFILES >> PROFILE_DISC) % 2 == 1
    if (kind == PROFILE_DISC) {
        float width = fwidth(squared_chord);
        if (soft_edges && width > 0.0) return clamp((parameters.x - squared_chord) / width + 0.5, 0.0, 1.0);
        return squared_chord <= parameters.x ? 1.0 : 0.0;
    }
#endif
#if (PROFILES >> PROFILE_GAUSSIAN) % 2 == 1
    if (kind == PROFILE_GAUSSIAN) return exp(-0.5 * parameters.x * squared_chord);
#endif
#if (PROFILES >> PROFILE_GLOSSY) % 2 == 1
    if (kind == PROFILE_GLOSSY) {
        float away = 0.5 * squared_chord;
        float share = 2.0 * parameters.x / (away + parameters.x * (2.0 - away));
        return max(0.0, 1.0 - away) * share * share;
    }
#endif
    return 1.0;
}

vec3 lobe_radiance(vec3 direction, ivec2 part) {
    vec3 sum = vec3(0.0);
    for (int i = part.x; i < part.y; ++i) {
        vec4 axis_kind = lobes[3 * i];
        vec3 chord = direction - axis_kind.xyz;
        sum += profile_value(int(axis_kind.w), lobes[3 * i + 2].xy, dot(chord, chord)) * lobes[3 * i + 1].rgb;
    }
    return sum;
}
