// Irradiance from the few numbers that an encoding keeps of it: the formulas of shviewer/harmonics/quantities/decoding.py.
//
// In: normal, unit, in the frame of the light. Out: linear RGB; may be negative, but for Geomerics'.

#if RECONSTRUCTION == RECONSTRUCTION_L2
uniform vec3 stored[9];         // c0 ... c8 of the radiance, each of three channels
#elif RECONSTRUCTION == RECONSTRUCTION_CUBE
uniform vec3 stored[9];         // the faces +x, -x, +y, -y, +z, -z, and the axes x, y and z of the cube
#elif RECONSTRUCTION == RECONSTRUCTION_ZH3 || RECONSTRUCTION == RECONSTRUCTION_ZH3_SHARED
uniform vec3 stored[5];         // c0 ... c3, z
#else
uniform vec3 stored[4];         // c0 ... c3
#endif

const float ROOT_3 = 1.73205080756888;

// Length of a vector whose square may be too large or too small for a float.
float length_of(vec3 v) {
    float largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    return largest > 0.0 ? largest * length(v / largest) : 0.0;
}

// The vector of band 1 of a channel.
vec3 vector_of(int channel) {
    return vec3(-stored[3][channel], -stored[1][channel], stored[2][channel]);
}

// The axis of a channel, or that of the luminance; 0 where there is none.
vec3 axis_of(int channel, bool shared_) {
    vec3 v = vector_of(channel);
    if (shared_) v = vec3(-dot(stored[3], LUMINANCE), -dot(stored[1], LUMINANCE), dot(stored[2], LUMINANCE));
    float size = length_of(v);
    return size > 0.0 ? v / size : vec3(0.0);
}

// part / whole, between 0 and `most`; 0 where the whole is not positive.
float share_of(float part, float whole, float most) {
    if (!(whole > 0.0)) return 0.0;
    return part < most * whole ? part / whole : most;
}

vec3 l1_irradiance(vec3 n) {
    return STORED_MEAN * stored[0] + STORED_LINEAR * (stored[2] * n.z - stored[3] * n.x - stored[1] * n.y);
}

float geomerics_irradiance(vec3 n, int channel) {
    float r = share_of(length_of(vector_of(channel)), ROOT_3 * stored[0][channel], 1.0);
    float p = 1.0 + 2.0 * r, a = (1.0 - r) / (1.0 + r);
    float q = max(0.5 + 0.5 * dot(n, axis_of(channel, false)), 0.0);
    return STORED_MEAN * stored[0][channel] * (a + (1.0 - a) * (p + 1.0) * pow(q, p));
}

// Of a light that is nowhere negative, |v|/c0 is at most sqrt(3); numbers of others may be anything.
float hallucinated_z(int channel, bool shared_) {
    float c0 = stored[0][channel];
    float s = share_of(abs(dot(vector_of(channel), axis_of(channel, shared_))), c0, 1e30);
    return c0 * s * (0.08 + 0.6 * s);
}

float zonal(vec3 n, int channel, bool shared_, float z) {
    vec3 axis = axis_of(channel, shared_);
    float along = dot(n, axis);
    return axis == vec3(0.0) ? 0.0 : STORED_ZONAL * z * (3.0 * along * along - 1.0);
}

vec3 encoded_irradiance(vec3 n) {
#if RECONSTRUCTION == RECONSTRUCTION_L1
    return l1_irradiance(n);
#elif RECONSTRUCTION == RECONSTRUCTION_GEOMERICS
    return vec3(geomerics_irradiance(n, 0), geomerics_irradiance(n, 1), geomerics_irradiance(n, 2));
#elif RECONSTRUCTION == RECONSTRUCTION_CUBE
    vec3 sum = vec3(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        float along = dot(stored[6 + axis], n);
        sum += along * along * stored[2 * axis + (along < 0.0 ? 1 : 0)];
    }
    return sum;
#elif RECONSTRUCTION == RECONSTRUCTION_L2
    vec3 products = stored[4] * n.x * n.y - stored[5] * n.y * n.z - stored[7] * n.x * n.z;
    vec3 others = stored[6] * (3.0 * n.z * n.z - 1.0) + ROOT_3 * stored[8] * (n.x * n.x - n.y * n.y);
    return l1_irradiance(n) + STORED_ZONAL * (2.0 * ROOT_3 * products + others);
#else
    vec3 sum = l1_irradiance(n);
    for (int channel = 0; channel < 3; ++channel)
#if RECONSTRUCTION == RECONSTRUCTION_ZH3
        sum[channel] += zonal(n, channel, false, stored[4][channel]);
#elif RECONSTRUCTION == RECONSTRUCTION_ZH3_SHARED
        sum[channel] += zonal(n, channel, true, stored[4][channel]);
#elif RECONSTRUCTION == RECONSTRUCTION_HALLUCINATED
        sum[channel] += zonal(n, channel, false, hallucinated_z(channel, false));
#else
        sum[channel] += zonal(n, channel, true, hallucinated_z(channel, true));
#endif
    return sum;
#endif
}
