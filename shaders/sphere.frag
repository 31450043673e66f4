#version 330 core
// One sphere, seen from afar (orthographically) and drawn per pixel: a light looked up in the direction of its normal.
//
// There is a program for every SHOWN, ORIGINAL, RECONSTRUCTION, TONE and PROFILES: software OpenGL runs both sides of a branch, and a
// sphere should not pay for what it does not show. Linear until the last line; display.glsl alone turns radiance into colour.

#include "constants.glsl"
#include "sh.glsl"
#include "lobes.glsl"
#include "lat_long.glsl"
#include "display.glsl"
#include "error.glsl"

uniform vec2 centre;            // pixels from the bottom left
uniform float radius;           // pixels
uniform mat3 light_from_view;   // turns a normal into the frame of the light
uniform bool linear_output;     // radiance as it is, zero outside, for comparing numbers
uniform sampler2D original_map;
uniform bool original_rows_on_poles;
uniform sampler2D reconstruction_map;

out vec4 colour;

vec3 original_radiance(vec3 direction) {
#if ORIGINAL == ORIGINAL_LOBES
    return lobe_radiance(direction, original_lobes);
#else
    return linear_map_radiance(original_map, direction, original_rows_on_poles);
#endif
}

vec3 reconstruction_radiance(vec3 direction) {
    vec3 suns = lobe_radiance(direction, sun_lobes);
#if RECONSTRUCTION == RECONSTRUCTION_SUM
    return suns + sh_radiance(direction);
#else
    return suns + spline_map_radiance(reconstruction_map, direction);
#endif
}

void main() {
    vec2 p = (gl_FragCoord.xy - centre) / radius;
    float distance_squared = dot(p, p);
    float distance_ = sqrt(distance_squared);
    bool inside = distance_squared < 1.0;
    vec3 normal = inside ? vec3(p, sqrt(1.0 - distance_squared)) : vec3(p / distance_, 0.0);
    vec3 direction = normalize(light_from_view * normal);
#if SHOWN == SHOWN_ORIGINAL
    vec3 radiance = original_radiance(direction), shown = visible(radiance);
#elif SHOWN == SHOWN_RECONSTRUCTION
    vec3 radiance = reconstruction_radiance(direction), shown = visible(radiance);
#else
    vec3 original = original_radiance(direction);
    vec3 radiance = reconstruction_radiance(direction) - original;
    vec3 shown = error_colour(error_value(original, radiance));
#endif
    if (linear_output) {
        colour = inside ? vec4(radiance, 1.0) : vec4(0.0);
        return;
    }
    float coverage = clamp((1.0 - distance_) * radius + 0.5, 0.0, 1.0);
    colour = vec4(encode(mix(BACKGROUND, shown, coverage)), 1.0);
}
