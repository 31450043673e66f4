// The only place where radiance becomes colour: exposure, a hue for what is negative, a tone curve, then sRGB.

uniform float exposure;         // 2^stops

// The tone curves of shviewer/viewer/tone.py, of exposed radiance >= 0. What is far beyond white stays finite when squared.
vec3 toned(vec3 x) {
    x = min(x, BRIGHTEST_EXPOSED);
#if TONE == TONE_REINHARD
    return x / (1.0 + x);
#elif TONE == TONE_ACES
    return x * (ACES[0] * x + ACES[1]) / (x * (ACES[2] * x + ACES[3]) + ACES[4]);
#elif TONE == TONE_LOG
    return log2(1.0 + LOG_RANGE * x) / log2(1.0 + LOG_RANGE);
#else
    return x;
#endif
}

// What the eye gets of a radiance, linear in [0, 1]. A negative luminance has a hue of its own, which grows from black with
// the magnitude, fast at first so that faint ringing shows, and never saturates. Where channels of both signs nearly cancel,
// the colour fades to the black that parts the two: no light has a luminance below 0.0722 of its largest channel.
vec3 visible(vec3 radiance) {
    vec3 exposed = clamp(exposure * radiance, -BRIGHTEST_EXPOSED, BRIGHTEST_EXPOSED);
    float luminance = dot(exposed, vec3(0.2126, 0.7152, 0.0722));
    float magnitude = toned(vec3(abs(luminance))).r;
    vec3 negative = magnitude / (magnitude + NEGATIVE_KNEE) * NEGATIVE_HUE;
    float largest = max(max(exposed.r, exposed.g), exposed.b);
    vec3 positive = toned(max(exposed, 0.0)) * min(1.0, luminance / max(0.0722 * largest, 1e-30));
    return clamp(luminance < 0.0 ? negative : positive, 0.0, 1.0);
}

// IEC 61966-2-1 (sRGB), from linear in [0, 1].
vec3 encode(vec3 linear_colour) {
    vec3 power = 1.055 * pow(linear_colour, vec3(1.0 / 2.4)) - 0.055;
    return mix(12.92 * linear_colour, power, step(0.0031308, linear_colour));
}
