// Sky, and the ground as an infinite plane with the plants' shadows on it.
#version 330 core

in vec2 screen;

uniform mat4 to_clip;
uniform vec3 eye, right, up, back; // right and up as long as half the picture at 1 m
uniform vec3 zenith, horizon, below;
uniform bool ground_present;
uniform float ground_height;
uniform vec3 ground_reflectance, to_sun, sun;
uniform int ground_list;
uniform float sky_on;       // 1, or 0 where the light of the sky is switched off
uniform sampler2D openness; // share of the sky's light that the ground gets
uniform vec4 open_frame;    // its low corner and one over its extent

layout(location = 0) out vec4 radiance;

const float PI = 3.14159265358979323846;

void main() {
    vec3 way = normalize(screen.x * right + screen.y * up - back);
    float drop = ground_height - eye.z;
    radiance = vec4(way.z >= 0 ? mix(horizon, zenith, way.z) : below, 1);
    gl_FragDepth = 1;
    if (!ground_present || drop * way.z <= 0)
        return;
    vec3 point = eye + drop / way.z * way;
    vec3 light = sky_on * PI * (horizon + 2 * zenith) / 3 *
                 texture(openness, (point.xy - open_frame.xy) * open_frame.zw).x;
    if (to_sun.z > 0 && sun != vec3(0))
        light += to_sun.z * sun * sun_share(ground_list, point, vec3(0));
    radiance = vec4(light * ground_reflectance / PI, 1);
    vec4 clip = to_clip * vec4(point, 1);
    gl_FragDepth = clamp(clip.z / clip.w * 0.5 + 0.5, 0, 0.9999999);
}
