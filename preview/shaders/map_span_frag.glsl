// First pass: where light first and last meets a surface, by the greatest (-along, along).
#version 330 core

noperspective in float along;
in vec2 place;

uniform sampler2D image;
uniform float alpha_min;

out vec2 span;

void main() {
    if (alpha_min > 0 && texture(image, place).a < alpha_min)
        discard;
    span = vec2(-along, along);
}
