#version 330 core
// Pixels that were drawn before, as they are.

uniform sampler2D layer;

out vec4 colour;

void main() {
    colour = texelFetch(layer, ivec2(gl_FragCoord.xy), 0);
}
