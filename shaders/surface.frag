#version 330 core
// How bright a sample of the surface is, in (0, 1], with the sign of the value: surface_resolve.frag gives it colour.

in float signed_radius;
in vec3 signed_normal;

out float signed_tone;

const vec3 KEY = vec3(-0.40, 0.56, 0.725);  // over the viewer's left shoulder

void main() {
    float sign_ = signed_radius < 0.0 ? -1.0 : 1.0;
    vec3 normal = normalize(sign_ * signed_normal);
    float key = dot(normal, KEY);
    float wrapped = 0.5 + 0.5 * key;        // reaches round the edge, so that the shadow keeps its form
    float fill = max(normal.z, 0.0);
    float tone = 0.56 * max(key, 0.0) + 0.30 * wrapped * wrapped + 0.14 * fill;
    float pinch = smoothstep(0.0, 0.35, abs(signed_radius));
    signed_tone = sign_ * clamp(tone * mix(0.55, 1.0, pinch), 0.004, 1.0);
}
