// Depths alone: where surfaces are.
#version 330 core

in vec2 on_texture;

uniform sampler2D image;
uniform float alpha_min;

void main() {
    if (alpha_min > 0 && texture(image, on_texture).a < alpha_min)
        discard;
}
