#version 330 core
// Captions, figures, marks: drawn by Pillow pixel for pixel, straight alpha, row 0 on top.

uniform sampler2D layer;
uniform ivec2 corner;           // top left, pixels from the bottom left

out vec4 colour;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 texel = ivec2(pixel.x - corner.x, corner.y - 1 - pixel.y);
    colour = texelFetch(layer, min(texel, textureSize(layer, 0) - 1), 0);  // one texel may stand for all
}
