#version 330 core
// One pane, drawn per pixel: a light looked up in the direction that the pixel shows. A sphere is seen from afar
// (orthographically), the whole sphere is a lat-long map.
//
// There is a program for every choice in constants.glsl (SHOWN, PANE, ...): software OpenGL runs both sides of a branch, and a
// pane should not pay for what it does not show. Linear until the last line; display.glsl alone turns radiance into colour.

#include "constants.glsl"
#include "lobes.glsl"
#include "lat_long.glsl"
#include "display.glsl"
#include "lines.glsl"
#if RECONSTRUCTION == RECONSTRUCTION_SUM
#include "sh.glsl"
#elif RECONSTRUCTION != RECONSTRUCTION_MAP
#include "encodings.glsl"
#endif
#include "error.glsl"

uniform vec2 centre;            // pixels from the bottom left; of a map: where azimuth and elevation are 0
uniform float radius;           // of a sphere, pixels
uniform float turn;             // of a map: pixels from a meridian round to itself
uniform mat3 light_from_pane;   // turns a normal or a direction of the world into the frame of the light
uniform bool wide_suns;         // whether the suns are so wide that lines on them are more than a stroke
uniform bool linear_output;     // radiance as it is, zero beside a sphere, for comparing numbers
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
#elif RECONSTRUCTION == RECONSTRUCTION_MAP
    return suns + spline_map_radiance(reconstruction_map, direction);
#else
    return suns + encoded_irradiance(direction);
#endif
}

#if PANE == PANE_SPHERE

// A normal as seen by the viewer; beside the sphere, that of the nearest point of its rim.
vec3 pane_direction(out bool inside, out float to_edge) {
    vec2 p = (gl_FragCoord.xy - centre) / radius;
    float distance_squared = dot(p, p);
    float distance_ = sqrt(distance_squared);
    inside = distance_squared < 1.0;
    to_edge = (1.0 - distance_) * radius;
    return inside ? vec3(p, sqrt(1.0 - distance_squared)) : vec3(p / distance_, 0.0);
}

#else

// Cosine and sine of an angle in turns, to 1e-7: OpenGL promises no accuracy of its own. Within an eighth of a turn of a
// quarter they are polynomials (Chebyshev fits), which the quarters turn.
vec2 on_circle(float turns) {
    float quarters = floor(4.0 * turns + 0.5);
    float t = 6.28318530718 * (turns - 0.25 * quarters), u = t * t;
    vec2 p = vec2(1.0 - 0.5 * u + u * u * (0.0416666647 + u * (-0.0013888303 + u * 0.0000245479)),
                  t + t * u * (-0.1666666466 + u * (0.0083327483 + u * -0.0001958789)));
    float odd = mod(quarters, 2.0);
    p = odd == 0.0 ? p : vec2(-p.y, p.x);
    return mod(quarters, 4.0) < 1.5 ? p : -p;
}

// The direction in the world of a pixel of the map, azimuth falling to the right and +z on top.
vec3 pane_direction(out bool inside, out float to_edge) {
    vec2 turns = (gl_FragCoord.xy - centre) / turn;
    inside = true;
    to_edge = 1e6;
    vec2 across = on_circle(-turns.x), up = on_circle(clamp(turns.y, -0.25, 0.25));
    return vec3(up.x * across, up.y);
}

#endif

void main() {
    bool inside;
    float to_edge;
    vec3 direction = normalize(light_from_pane * pane_direction(inside, to_edge));
#if SHOWN == SHOWN_ORIGINAL
    vec3 radiance = original_radiance(direction);
#elif SHOWN == SHOWN_RECONSTRUCTION
    vec3 radiance = reconstruction_radiance(direction);
#else
    vec3 original = original_radiance(direction);
    vec3 radiance = reconstruction_radiance(direction) - original;
#endif
    if (linear_output) {
        colour = inside ? vec4(radiance, 1.0) : vec4(0.0);
        return;
    }
#if SHOWN == SHOWN_ERROR
    vec3 shown = error_colour(error_value(original, radiance));
#else
    Exposed light = exposed(radiance);
    bool beyond = wide_suns;
#if SHOWN == SHOWN_RECONSTRUCTION
    beyond = beyond || exposure * dot(lobe_radiance(direction, sun_lobes), LUMINANCE) <= 1.0;
#endif
    vec3 shown = with_lines(visible(light), light, to_edge, beyond);
#endif
    colour = vec4(srgb_from_linear(mix(BACKGROUND, shown, clamp(to_edge + 0.5, 0.0, 1.0))), 1.0);
}
