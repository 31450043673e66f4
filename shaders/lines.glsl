// Lines over a colour: rising ones over what is negative, with a line along its edge, and falling ones over what is beyond
// white. No light looks like that, to any kind of colour vision. Where single channels are negative under a light colour, the
// rising lines are dark.

uniform float scale;            // pixels of the frame for a pixel of the design
uniform float lines;            // 1, or 0 for none

// How much of a pixel a family of lines covers: `along` is across them, they are `pitch` apart and `width` wide, all in pixels.
float line_cover(float along, float pitch, float width) {
    float off = abs(along - pitch * floor(along / pitch + 0.5));
    return clamp(0.5 * width + 0.5 - off, 0.0, 1.0);
}

// `shown` with its lines. to_edge: pixels to the limb of a sphere, where a surface seen askew would crowd the line of the edge.
// That line is on the negative side alone: where light ends in black there is none. beyond: whether what is beyond white has
// lines. Derivatives: to be called by all pixels.
vec3 with_lines(vec3 shown, Exposed light, float to_edge, bool beyond) {
    float lowest = min(min(light.radiance.r, light.radiance.g), light.radiance.b);
    bool on_light = dot(shown, LUMINANCE) > LIGHT_GROUND;   // a fill is never as light
    vec3 ink = on_light ? DARK_INK : RISING_INK;
    float strength = light.luminance < -BARELY ? RISING_FAINT + RISING_GROWTH * light.darkness
                   : lowest < -BARELY ? (on_light ? RISING_DARK : RISING_FAINT) : 0.0;
    float along = gl_FragCoord.x - gl_FragCoord.y, pitch = RISING_PITCH, width = 1.0;
#if TONE == TONE_NONE
    if (beyond && light.luminance > 1.0) {
        ink = DARK_INK, pitch = BEYOND_PITCH, width = BEYOND_WIDTH, along = gl_FragCoord.x + gl_FragCoord.y;
        strength = BEYOND_STRENGTH * min((light.luminance - 1.0) / BEYOND_RISE, 1.0);
    }
#endif
    shown = mix(shown, ink, lines * strength * line_cover(0.70710678 * along, pitch * scale, width * scale));
    vec2 slope = vec2(dFdx(light.luminance), dFdy(light.luminance));
    float least = 0.25 * BARELY;
    float within = -(light.luminance + BARELY) * inversesqrt(max(dot(slope, slope), least * least));    // pixels
    float edge = light.luminance < 0.0
               ? clamp(within + 0.5, 0.0, 1.0) * clamp(EDGE_WIDTH * scale + 0.5 - within, 0.0, 1.0) : 0.0;
    return mix(shown, EDGE_INK, lines * EDGE_STRENGTH * edge * clamp(to_edge / (EDGE_FADE * scale), 0.0, 1.0));
}
