// Radiance from a lat-long map: the look-up of shviewer/lights/lat_long.py, continuous across seam and poles.
//
// Texels are fetched and weighted here, not by the sampler: its weights have eight bits, and its derivatives jump at
// the seam. Angles are computed here, too, because OpenGL promises no accuracy of atan.

uniform sampler2D radiance_map;
uniform vec2 row_scale_offset;  // row = x theta + y
uniform bool rows_on_poles;     // rows from pole to pole, else at texel centres

const float PI = 3.14159265358979;

// The angle of (x, y) from the x axis, in [0, pi/4] for 0 <= y <= x. Above tan(pi/8) the half of pi/4 is taken out, below
// it atan(t)/t is a polynomial in t^2 (Chebyshev fit, error 4e-8 in float32).
float small_angle(float x, float y) {
    bool steep = y > 0.41421356 * x;
    float t = x == 0.0 ? 0.0 : steep ? (y - x) / (y + x) : y / x;
    float u = t * t;
    float series = 0.99999998126 + u * (-0.33332785772 + u * (0.19974082415 + u * (-0.13848490211 + u * 0.07976291803)));
    return (steep ? 0.25 * PI : 0.0) + t * series;
}

// atan2, the angle in [-pi, pi] from the x axis.
float angle_of(float x, float y) {
    float a = abs(x), b = abs(y);
    float angle = b > a ? 0.5 * PI - small_angle(b, a) : small_angle(a, b);
    if (x < 0.0) angle = PI - angle;
    return y < 0.0 ? -angle : angle;
}

// Row and column of a direction, at texel centres where they are whole.
vec2 map_position(vec3 direction) {
    float theta = angle_of(direction.z, length(direction.xy));
    float phi = angle_of(direction.x, direction.y);
    float width = float(textureSize(radiance_map, 0).x);
    return vec2(theta * row_scale_offset.x + row_scale_offset.y, (0.5 - phi / (2.0 * PI)) * width - 0.5);
}

// Columns go round; beyond a pole comes the same row half way round. Returns the row and column to read.
int wrapped_row(int row, inout float column) {
    ivec2 size = textureSize(radiance_map, 0);
    if (row >= 0 && row < size.y) return row;
    column += 0.5 * float(size.x);
    int pole_row = rows_on_poles ? 0 : 1;
    return clamp(row < 0 ? -row - pole_row : 2 * (size.y - 1) - row + pole_row, 0, size.y - 1);
}

vec3 texel_at(int row, int column) {
    int width = textureSize(radiance_map, 0).x;
    return texelFetch(radiance_map, ivec2((column + 2 * width) % width, row), 0).rgb;  // % of a negative is undefined
}

vec3 row_radiance(int row, float column) {
    row = wrapped_row(row, column);
    int left = int(floor(column));
    return mix(texel_at(row, left), texel_at(row, left + 1), column - floor(column));
}

vec3 map_radiance(vec3 direction) {
    vec2 position = map_position(direction);
    int top = int(floor(position.x));
    return mix(row_radiance(top, position.y), row_radiance(top + 1, position.y), position.x - floor(position.x));
}

// Catmull-Rom weights of the texels at -1, 0, 1, 2 for a position t in [0, 1] between the middle two.
vec4 cubic_weights(float t) {
    return 0.5 * vec4(t * (t * (2.0 - t) - 1.0), t * t * (3.0 * t - 5.0) + 2.0, t * (t * (4.0 - 3.0 * t) + 1.0), t * t * (t - 1.0));
}

vec3 smooth_row_radiance(int row, float column) {
    row = wrapped_row(row, column);
    int left = int(floor(column));
    vec4 weight = cubic_weights(column - floor(column));
    return weight.x * texel_at(row, left - 1) + weight.y * texel_at(row, left) + weight.z * texel_at(row, left + 1)
         + weight.w * texel_at(row, left + 2);
}

vec3 smooth_map_radiance(vec3 direction) {
    vec2 position = map_position(direction);
    int top = int(floor(position.x));
    vec4 weight = cubic_weights(position.x - floor(position.x));
    return weight.x * smooth_row_radiance(top - 1, position.y) + weight.y * smooth_row_radiance(top, position.y)
         + weight.z * smooth_row_radiance(top + 1, position.y) + weight.w * smooth_row_radiance(top + 2, position.y);
}
