#version 330 core
// Captions and figures, drawn by Pillow at the size of the frame: straight alpha, row 0 on top.

uniform sampler2D overlay;

out vec4 colour;

void main() {
    ivec2 size = textureSize(overlay, 0);
    colour = texelFetch(overlay, ivec2(gl_FragCoord.x, size.y - 1 - int(gl_FragCoord.y)), 0);
}
