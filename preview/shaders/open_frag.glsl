// How much of the sky's light comes to each place on the ground: one direction of the sky,
// to be added to the others. The maps are those of plants towards that direction.
#version 330 core

in vec2 screen;

uniform vec2 low, extent; // of the ground in the picture
uniform float ground_height, weight;
uniform int ground_list;

out vec4 open;

void main() {
    vec3 point = vec3(low + (screen * 0.5 + 0.5) * extent, ground_height);
    open = vec4(weight * sun_share(ground_list, point, vec3(0)));
}
