#version 330 core
// Colours the samples of a pixel and averages them in linear light; where there are none, the background
// is seen, and on it a faint circle of radius 1.

#include "constants.glsl"
#include "display.glsl"

uniform sampler2D signed_tones; // 0 where there is no surface
uniform vec2 origin;            // of the tile, pixels from the bottom left of the frame
uniform int oversampling;       // samples along a side of a pixel
uniform vec2 centre;            // pixels from the bottom left of the frame
uniform float radius;           // pixels
uniform float ring_width;       // pixels

out vec4 colour;

const vec3 POSITIVE_INK = vec3(0.86, 0.80, 0.70);
const vec3 NEGATIVE_INK = mix(NEGATIVE_HUE, vec3(1.0), 0.10);
const vec3 RING = BACKGROUND + 0.022;

vec3 ink(float signed_tone) {
    float tone = abs(signed_tone);
    float gloss = smoothstep(0.72, 1.0, tone);
    return mix(tone * (signed_tone < 0.0 ? NEGATIVE_INK : POSITIVE_INK), vec3(1.0), 0.35 * gloss * gloss);
}

void main() {
    float off_ring = abs(distance(gl_FragCoord.xy, centre) - radius);
    float ring = clamp(0.5 * ring_width + 0.5 - off_ring, 0.0, min(ring_width, 1.0));
    vec3 behind = mix(BACKGROUND, RING, ring);

    ivec2 corner = ivec2(gl_FragCoord.xy - origin) * oversampling;
    vec3 sum = vec3(0.0);
    int covered = 0;
    for (int y = 0; y < oversampling; ++y)
        for (int x = 0; x < oversampling; ++x) {
            float signed_tone = texelFetch(signed_tones, corner + ivec2(x, y), 0).r;
            if (signed_tone == 0.0) continue;
            sum += ink(signed_tone);
            ++covered;
        }
    if (covered == 0 && ring == 0.0) discard;
    int samples = oversampling * oversampling;
    colour = vec4(encode((sum + float(samples - covered) * behind) / float(samples)), 1.0);
}
