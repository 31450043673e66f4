#version 330 core
// One sphere, seen from afar (orthographically) and drawn per pixel: a light looked up in the direction of its normal.
//
// Linear until the last line; display.glsl alone turns radiance into colour.

#include "constants.glsl"
#include "sh.glsl"
#include "lobes.glsl"
#include "lat_long.glsl"
#include "display.glsl"

uniform vec2 centre;            // pixels from the bottom left
uniform float radius;           // pixels
uniform mat3 light_from_view;   // turns a normal into the frame of the light
uniform int source;             // one of SOURCE_...
uniform bool linear_output;     // radiance as it is, zero outside, for comparing numbers

out vec4 colour;

vec3 radiance_from(vec3 direction) {
    vec3 lobes = lobe_radiance(direction);  // all there is, or suns that were split off the reconstruction
    if (source == SOURCE_LOBES) return lobes;
    if (source == SOURCE_MAP) return lobes + map_radiance(direction);
    if (source == SOURCE_SMOOTH_MAP) return lobes + smooth_map_radiance(direction);
    return lobes + sh_radiance(direction);
}

void main() {
    vec2 p = (gl_FragCoord.xy - centre) / radius;
    float distance_squared = dot(p, p);
    float distance_ = sqrt(distance_squared);
    bool inside = distance_squared < 1.0;
    vec3 normal = inside ? vec3(p, sqrt(1.0 - distance_squared)) : vec3(p / distance_, 0.0);
    vec3 radiance = radiance_from(normalize(light_from_view * normal));
    if (linear_output) {
        colour = inside ? vec4(radiance, 1.0) : vec4(0.0);
        return;
    }
    float coverage = clamp((1.0 - distance_) * radius + 0.5, 0.0, 1.0);
    colour = vec4(encode(mix(BACKGROUND, visible(radiance), coverage)), 1.0);
}
