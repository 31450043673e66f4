// The only place where radiance becomes colour: exposure, a hue for what is negative, then sRGB.

uniform float exposure;         // 2^stops

// What the eye gets of a radiance, linear in [0, 1]. A negative luminance has a hue of its own, which grows from black with
// the magnitude, fast at first so that faint ringing shows, and never saturates.
vec3 visible(vec3 radiance) {
    vec3 exposed = exposure * radiance;
    float luminance = dot(exposed, vec3(0.2126, 0.7152, 0.0722));
    vec3 shown = luminance < 0.0 ? luminance / (luminance - NEGATIVE_KNEE) * NEGATIVE_HUE : exposed;
    return clamp(shown, 0.0, 1.0);
}

// IEC 61966-2-1 (sRGB), from linear in [0, 1].
vec3 encode(vec3 linear_colour) {
    vec3 power = 1.055 * pow(linear_colour, vec3(1.0 / 2.4)) - 0.055;
    return mix(12.92 * linear_colour, power, step(0.0031308, linear_colour));
}
