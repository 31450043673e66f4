// Radiance from lat-long maps: the look-ups of shviewer/lights/lat_long.py, continuous across seam and poles.
//
// Texels are fetched and weighted here, not by the sampler: its weights have eight bits, and its derivatives jump at
// the seam. Angles are computed here, too, because OpenGL promises no accuracy of atan.

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

// Row and column of a direction, at texel centres where they are whole. Rows lie from pole to pole, or at texel centres.
vec2 map_position(vec3 direction, vec2 size, bool rows_on_poles) {
    float v = angle_of(direction.z, length(direction.xy)) / PI, u = 0.5 - angle_of(direction.x, direction.y) / (2.0 * PI);
    return vec2(rows_on_poles ? v * (size.y - 1.0) : v * size.y - 0.5, u * size.x - 0.5);
}

// A row that may lie beyond a pole, where the same row comes half way round, becomes one of the map's.
float wrapped_row(float row, inout float column, vec2 size, bool rows_on_poles) {
    if (row >= 0.0 && row < size.y) return row;
    float pole_row = rows_on_poles ? 0.0 : 1.0;
    column += 0.5 * size.x;
    return clamp(row < 0.0 ? -row - pole_row : 2.0 * (size.y - 1.0) - row + pole_row, 0.0, size.y - 1.0);
}

// Columns go round. In floats: whole numbers are exact, and % of a negative is undefined.
vec3 texel_at(sampler2D map, float row, float column, float width) {
    return texelFetch(map, ivec2(column - width * floor((column + 0.5) / width), row), 0).rgb;
}

vec3 linear_row(sampler2D map, float row, float column, vec2 size, bool rows_on_poles) {
    row = wrapped_row(row, column, size, rows_on_poles);
    float left = floor(column);
    return mix(texel_at(map, row, left, size.x), texel_at(map, row, left + 1.0, size.x), column - left);
}

vec3 linear_at(sampler2D map, vec2 position, vec2 size, bool rows_on_poles) {
    float top = floor(position.x);
    return mix(linear_row(map, top, position.y, size, rows_on_poles),
               linear_row(map, top + 1.0, position.y, size, rows_on_poles), position.x - top);
}

// A map that is finer than the pixels is looked up SAMPLES times SAMPLES times in each, or what is bright and small would
// flicker. Derivatives: to be called by all pixels.
vec3 linear_map_radiance(sampler2D map, vec3 direction, bool rows_on_poles) {
    vec2 size = vec2(textureSize(map, 0));
    vec2 position = map_position(direction, size, rows_on_poles);
#if SAMPLES == 1
    return linear_at(map, position, size, rows_on_poles);
#else
    vec2 across = dFdx(position), up = dFdy(position);
    across.y -= size.x * floor(across.y / size.x + 0.5);    // over the seam
    up.y -= size.x * floor(up.y / size.x + 0.5);
    vec3 sum = vec3(0.0);
    for (int j = 0; j < SAMPLES; ++j)
        for (int i = 0; i < SAMPLES; ++i) {
            vec2 shift = (vec2(i, j) + 0.5) / float(SAMPLES) - 0.5;
            sum += linear_at(map, position + shift.x * across + shift.y * up, size, rows_on_poles);
        }
    return sum / float(SAMPLES * SAMPLES);
#endif
}

// The quadratic B-splines of the nodes at -1, 0 and 1, at t in [-1/2, 1/2].
vec3 spline_weights(float t) {
    return vec3(0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t));
}

vec3 spline_row(sampler2D map, float row, float column, vec2 size) {
    row = wrapped_row(row, column, size, true);
    float middle = floor(column + 0.5);
    vec3 weight = spline_weights(column - middle);
    return weight.x * texel_at(map, row, middle - 1.0, size.x) + weight.y * texel_at(map, row, middle, size.x)
         + weight.z * texel_at(map, row, middle + 1.0, size.x);
}

// A smooth function from its spline coefficients (Synthesis.spline_map), rows from pole to pole.
vec3 spline_map_radiance(sampler2D map, vec3 direction) {
    vec2 size = vec2(textureSize(map, 0));
    vec2 position = map_position(direction, size, true);
    float middle = floor(position.x + 0.5);
    vec3 weight = spline_weights(position.x - middle);
    return weight.x * spline_row(map, middle - 1.0, position.y, size) + weight.y * spline_row(map, middle, position.y, size)
         + weight.z * spline_row(map, middle + 1.0, position.y, size);
}
