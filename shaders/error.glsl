// From a difference to a colour: the error of viewer/colour/error_scale.py, of the channel where it is largest.

uniform sampler2D colour_map;   // one row, linear RGB
uniform int error_kind;         // one of ERROR_...
uniform float error_range;      // where the colours end
uniform float error_floor;      // what a darker original counts as when the error is relative to it

float error_value(vec3 original, vec3 difference) {
    vec3 error = error_kind == ERROR_RELATIVE ? difference / max(abs(original), error_floor) : difference;
    vec3 magnitude = abs(error);
    float largest = max(max(magnitude.r, magnitude.g), magnitude.b);
    if (error_kind != ERROR_SIGNED) return largest;
    return magnitude.r == largest ? error.r : magnitude.g == largest ? error.g : error.b;
}

// Linear RGB of an error. A signed one has its zero in the middle of the map.
vec3 error_colour(float error) {
    float t = clamp(error / error_range, -1.0, 1.0);
    if (error_kind == ERROR_SIGNED) t = 0.5 + 0.5 * t;
    int last = textureSize(colour_map, 0).x - 1;
    float position = t * float(last), low = min(floor(position), float(last) - 1.0);
    return mix(texelFetch(colour_map, ivec2(low, 0), 0).rgb, texelFetch(colour_map, ivec2(low + 1.0, 0), 0).rgb, position - low);
}
