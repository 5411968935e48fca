// The ground under sun and sky, with the plants' shadows on it.
#version 330 core

uniform vec2 extent;          // of the picture, pixels
uniform vec3 eye, right, up, back;
uniform vec3 zenith, horizon;
uniform float ground_height;
uniform vec3 ground_reflectance, to_sun, sun;
uniform int ground_list;
uniform float sky_on;       // 1, or 0 where the light of the sky is switched off
uniform sampler2D openness; // share of the sky's light that the ground gets
uniform vec4 open_frame;    // its low corner and one over its extent

layout(location = 0) out vec4 radiance;

const float PI = 3.14159265358979323846;

void main() {
    vec2 screen = gl_FragCoord.xy / extent * 2 - 1;
    vec3 way = normalize(screen.x * right + screen.y * up - back);
    vec3 point = eye + abs(ground_height - eye.z) / max(abs(way.z), 1e-6) * way;
    vec3 light = sky_on * PI * (horizon + 2 * zenith) / 3 *
                 texture(openness, (point.xy - open_frame.xy) * open_frame.zw).x;
    point.z = ground_height;
    if (to_sun.z > 0 && sun != vec3(0))
        light += to_sun.z * sun * sun_share(ground_list, point, vec3(0));
    radiance = vec4(light * ground_reflectance / PI, 1);
}
