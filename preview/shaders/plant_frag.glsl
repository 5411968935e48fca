// Leaves by the light on both faces; wood by the sun and the mean light about. Radiance,
// linear.
#version 330 core

in vec3 point, facing, from_center;
in vec2 on_texture;
flat in int instance, scene_leaf;

uniform vec3 eye;
uniform sampler2D image;
uniform vec3 image_mean, color;
uniform float alpha_min;
uniform vec3 reflectance[2], transmittance[2]; // of front and back
uniform vec3 around;                           // mean irradiance about wood
uniform int false_color; // 0: light; 1: the sun's share; 2: scattered light
uniform float false_top;

layout(location = 0) out vec4 radiance;

const float PI = 3.14159265358979323846;

// Blue, cyan, green, yellow, red.
vec3 rainbow(float x) {
    x = clamp(x, 0, 1) * 4;
    return clamp(vec3(x - 2, min(x, 4 - x), 2 - x), 0, 1);
}

vec3 wood_radiance(vec3 n, vec3 texel) {
    vec3 light = around;
    float cosine = dot(n, to_sun);
    if (cosine > 0 && sun != vec3(0))
        light += cosine * sun * sun_share(instance, point, n);
    return false_color > 0 ? vec3(0.03) : light * color * texel / PI;
}

// A face shows what it reflects of its own light, and what comes through of the other's.
vec3 leaf_radiance(vec3 n, bool in_front, vec3 texel) {
    vec3 front, back;
    vec3 lit = n;
    if (relief > 0)
        lit = with_relief(n, point, from_center / leaf_size,
                          dot(texel, vec3(1)) / dot(image_mean, vec3(1)));
    leaf_irradiance(scene_leaf, instance, point, n, lit, front, back);
    if (false_color == 1)
        return rainbow(sun_share(instance, point, n));
    if (false_color == 2)
        return rainbow(dot(front + back, vec3(1.0 / 3)) / false_top);
    int face = in_front ? 0 : 1;
    vec3 light = reflectance[face] * (in_front ? front : back) +
                 transmittance[1 - face] * (in_front ? back : front);
    return light / PI * texel / image_mean;
}

void main() {
    vec4 texel = texture(image, on_texture);
    if (alpha_min > 0 && texel.a < alpha_min)
        discard;
    vec3 n = normalize(facing);
    bool in_front = dot(n, eye - point) > 0;
    radiance = vec4(scene_leaf < 0 ? wood_radiance(in_front ? n : -n, texel.rgb)
                                   : leaf_radiance(n, in_front, texel.rgb), 1);
}
