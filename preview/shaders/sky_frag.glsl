// The sky, behind all.
#version 330 core

in vec2 screen;

uniform vec3 right, up, back; // right and up as long as half the picture at 1 m
uniform vec3 zenith, horizon, below;

layout(location = 0) out vec4 radiance;

void main() {
    float z = normalize(screen.x * right + screen.y * up - back).z;
    radiance = vec4(z >= 0 ? mix(horizon, zenith, z) : below, 1);
}
