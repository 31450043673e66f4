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
const float GLOSS_FROM = 0.72, GLOSS = 0.35;    // the tone above which ink turns towards white, and how far

void main() {
    float off_ring = abs(distance(gl_FragCoord.xy, centre) - radius);
    float ring = clamp(0.5 * ring_width + 0.5 - off_ring, 0.0, min(ring_width, 1.0));
    vec3 behind = mix(BACKGROUND, RING, ring);

    ivec2 corner = ivec2(gl_FragCoord.xy - origin) * oversampling;
    vec2 tones = vec2(0.0), glosses = vec2(0.0);    // sums of positive samples, and of negative ones
    float covered = 0.0;
    for (int y = 0; y < oversampling; ++y)
        for (int x = 0; x < oversampling; ++x) {
            float signed_tone = texelFetch(signed_tones, corner + ivec2(x, y), 0).r;
            vec2 tone = max(vec2(signed_tone, -signed_tone), 0.0);
            vec2 gloss = max(tone - GLOSS_FROM, 0.0) / (1.0 - GLOSS_FROM);
            tones += tone;
            glosses += GLOSS * gloss * gloss;
            covered += signed_tone == 0.0 ? 0.0 : 1.0;
        }
    if (covered == 0.0 && ring == 0.0) discard;
    float samples = float(oversampling * oversampling);
    vec3 sum = tones.x * POSITIVE_INK + glosses.x * (1.0 - POSITIVE_INK)
             + tones.y * NEGATIVE_INK + glosses.y * (1.0 - NEGATIVE_INK);
    colour = vec4(srgb_from_linear((sum + (samples - covered) * behind) / samples), 1.0);
}
