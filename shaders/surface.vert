#version 330 core
// A vertex of the surface of radius |f(u)|, seen from afar (orthographically) as the spheres are.

uniform mat3 view_from_light;
uniform vec2 centre;            // samples from the bottom left of the tile
uniform float radius;           // samples
uniform vec2 tile;              // samples

in float value;                 // f, signed
in vec3 direction;              // u, unit, in the frame of the light
in vec3 normal;                 // f u - grad f: outward where f > 0, inward where f < 0

out float signed_radius;
out vec3 signed_normal;

void main() {
    vec3 position = view_from_light * (abs(value) * direction);
    signed_radius = value;
    signed_normal = view_from_light * normal;
    gl_Position = vec4(2.0 * (centre + radius * position.xy) / tile - 1.0, -position.z, 1.0);
}
