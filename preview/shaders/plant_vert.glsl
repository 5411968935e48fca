// Instances of a plant: turned about the vertical, scaled and moved.
#version 330 core

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texture_place;
layout(location = 3) in uint leaf;
layout(location = 4) in vec4 place; // translation, scale
layout(location = 5) in vec2 turn;  // cosine and sine of the yaw
layout(location = 6) in uvec2 own;  // number of the instance, of its first leaf
layout(location = 7) in vec3 center; // of the leaf

uniform mat4 to_clip;
uniform float grow; // of leaves, where others are left out

invariant gl_Position; // drawn twice: depths first

out vec3 point, facing, from_center;
out vec2 on_texture;
flat out int instance, scene_leaf;

vec3 turned(vec3 v) {
    return vec3(turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y, v.z);
}

void main() {
    vec3 own_place = grow == 1 ? position : center + grow * (position - center);
    point = turned(own_place) * place.w + place.xyz;
    facing = turned(normal);
    from_center = turned(position - center);
    on_texture = texture_place;
    instance = int(own.x);
    scene_leaf = leaf == 0xffffffffu ? -1 : int(own.y + leaf);
    gl_Position = to_clip * vec4(point, 1);
}
