// A plant as a distant light sees it: onto the texels of its opacity map.
#version 330 core

layout(location = 0) in vec3 position;
layout(location = 2) in vec2 texture_place;

uniform vec4 across, up; // clip space: dot(position, .xyz) + .w
uniform vec3 axis;       // the way the light goes

noperspective out float along;
out vec2 place;

void main() {
    gl_Position = vec4(dot(vec4(position, 1), across), dot(vec4(position, 1), up), 0, 1);
    along = position.x * axis.x + position.y * axis.y + position.z * axis.z;
    place = texture_place;
}
