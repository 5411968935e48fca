// The ground, an infinite plane: four triangles from the place under the eye to infinity.
#version 330 core

uniform mat4 to_clip;
uniform vec3 eye;
uniform float ground_height;

void main() {
    int corner = gl_VertexID % 3, way = gl_VertexID / 3 + corner - 1;
    vec4 far = vec4(float(way % 4 == 0) - float(way % 4 == 2),
                    float(way % 4 == 1) - float(way % 4 == 3), 0, 0);
    gl_Position = to_clip * (corner == 0 ? vec4(eye.xy, ground_height, 1) : far);
}
