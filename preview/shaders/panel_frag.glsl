// Text on a light panel: a picture of it, in a corner of the frame buffer.
#version 330 core

in vec2 screen;

uniform sampler2D picture;

out vec4 color;

void main() {
    vec2 place = screen * 0.5 + 0.5;
    float ink = 1 - texture(picture, vec2(place.x, 1 - place.y)).x;
    color = vec4(vec3(1 - ink), mix(0.72, 1.0, ink));
}
