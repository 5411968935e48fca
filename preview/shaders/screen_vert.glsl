// One triangle over the whole picture.
#version 330 core

out vec2 screen;

void main() {
    screen = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);
    gl_Position = vec4(screen, 1, 1);
}
