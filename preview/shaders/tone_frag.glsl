// Linear radiance to sRGB, after exposure; as pps_picture_write.
#version 330 core

in vec2 screen;

uniform sampler2D picture;
uniform float exposure;
uniform bool plain; // colours are final

out vec4 color;

void main() {
    vec3 c = texture(picture, screen * 0.5 + 0.5).rgb * (plain ? 1 : exposure);
    c = clamp(c, 0, 1);
    color = vec4(mix(12.92 * c, 1.055 * pow(c, vec3(1 / 2.4)) - 0.055,
                     step(0.0031308, c)), 1);
}
