// The only place where radiance becomes colour: exposure, a hue for what is negative, a tone curve, then sRGB. lines.glsl
// draws over it.

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);    // Rec. 709

uniform float exposure;         // 2^stops

// The tone curves of viewer/colour/tone.py, of exposed radiance >= 0. What is far beyond white stays finite when squared.
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

// Radiance at the exposure, its luminance, and how dark the colour of a negative one is: from 0 near zero to 1.
struct Exposed {
    vec3 radiance;
    float luminance, darkness;
};

Exposed exposed(vec3 radiance) {
    vec3 value = clamp(exposure * radiance, -BRIGHTEST_EXPOSED, BRIGHTEST_EXPOSED);
    float luminance = dot(value, LUMINANCE);
    float magnitude = toned(vec3(abs(luminance))).r;
    return Exposed(value, luminance, magnitude / (magnitude + NEGATIVE_KNEE));
}

// What the eye gets of a radiance, linear in [0, 1], but for its lines. A negative luminance has a hue of its own, which grows
// from black with the magnitude, fast at first so that faint ringing shows, and never saturates. Where channels of both signs
// nearly cancel, the colour fades to the black that parts the two: no light has a luminance below 0.0722 of its largest channel.
vec3 visible(Exposed light) {
    float largest = max(max(light.radiance.r, light.radiance.g), light.radiance.b);
    vec3 positive = toned(max(light.radiance, 0.0)) * min(1.0, light.luminance / max(0.0722 * largest, 1e-30));
    return clamp(light.luminance < -BARELY ? NEGATIVE_FILL * light.darkness * NEGATIVE_HUE : positive, 0.0, 1.0);
}

// IEC 61966-2-1 (sRGB), from linear in [0, 1].
vec3 srgb_from_linear(vec3 linear_colour) {
    vec3 power = 1.055 * pow(linear_colour, vec3(1.0 / 2.4)) - 0.055;
    return mix(12.92 * linear_colour, power, step(0.0031308, linear_colour));
}
