// Leaves lit on both faces from their cells, the sky's parts and the sun's maps; wood by
// the sun and the mean light about. Radiance, linear.
#version 330 core

in vec3 point, facing;
in vec2 on_texture;
flat in int instance, scene_leaf;

uniform vec3 eye, to_sun, sun;         // sun: irradiance, 0 where it is switched off
uniform sampler2D image;
uniform vec3 image_mean, color;
uniform float alpha_min;
uniform vec3 reflectance[2], transmittance[2]; // of front and back
uniform usamplerBuffer cell_of;        // of a leaf of the scene
uniform samplerBuffer scattered;       // of a cell, three bands: flux, diffuse
uniform samplerBuffer sky_shares;      // of a cell: of light of each direction
uniform samplerBuffer leaf_light;      // of a leaf: irradiance of front and back
uniform bool per_leaf;                 // light is that of leaf_light alone
uniform int n_directions;
uniform vec3 direction[24], part[24];  // of the sky: irradiance of a face turned there
uniform vec3 around;                   // mean irradiance about wood
uniform int false_color;               // 0: light; 1: the sun's share; 2: scattered light
uniform float false_top;

layout(location = 0) out vec4 radiance;

const float PI = 3.14159265358979323846;

// Blue, cyan, green, yellow, red.
vec3 rainbow(float x) {
    x = clamp(x, 0, 1) * 4;
    return clamp(vec3(x - 2, min(x, 4 - x), 2 - x), 0, 1);
}

void sky_light(int cell, vec3 n, inout vec3 front, inout vec3 back) {
    int stride = (n_directions + 3) / 4;
    for (int k = 0; k < stride; k++) {
        vec4 share = texelFetch(sky_shares, cell * stride + k);
        for (int i = 0; i < 4; i++) {
            int j = 4 * k + i;
            float through = dot(n, direction[j]) * share[i];
            front += max(through, 0) * part[j];
            back += max(-through, 0) * part[j];
        }
    }
}

// A face's light is what falls on its own side and what comes through from the other.
void leaf_irradiance(vec3 n, out vec3 front, out vec3 back) {
    if (per_leaf) {
        front = texelFetch(leaf_light, 2 * scene_leaf).rgb;
        back = texelFetch(leaf_light, 2 * scene_leaf + 1).rgb;
        return;
    }
    int cell = int(texelFetch(cell_of, scene_leaf).x);
    vec3 even, odd;
    for (int b = 0; b < 3; b++) {
        vec4 light = texelFetch(scattered, 3 * cell + b);
        even[b] = light.w / 4;
        odd[b] = dot(n, light.xyz) / 2;
    }
    front = max(even + odd, 0);
    back = max(even - odd, 0);
    sky_light(cell, n, front, back);
    float cosine = dot(n, to_sun);
    if (sun != vec3(0)) {
        float share = cosine * sun_share(instance, point, n);
        front += max(share, 0) * sun;
        back += max(-share, 0) * sun;
    }
}

void main() {
    vec4 texel = texture(image, on_texture);
    if (alpha_min > 0 && texel.a < alpha_min)
        discard;
    vec3 n = normalize(facing);
    bool in_front = dot(n, eye - point) > 0;
    if (scene_leaf < 0) {
        n = in_front ? n : -n;
        vec3 light = around;
        float cosine = dot(n, to_sun);
        if (cosine > 0 && sun != vec3(0))
            light += cosine * sun * sun_share(instance, point, n);
        radiance = vec4(false_color > 0 ? vec3(0.03) : light * color * texel.rgb / PI, 1);
        return;
    }
    vec3 front, back;
    leaf_irradiance(n, front, back);
    int face = in_front ? 0 : 1;
    vec3 light = reflectance[face] * (in_front ? front : back) +
                 transmittance[1 - face] * (in_front ? back : front);
    radiance = vec4(light / PI * texel.rgb / image_mean, 1);
    if (false_color == 1)
        radiance.rgb = rainbow(sun_share(instance, point, n));
    if (false_color == 2)
        radiance.rgb = rainbow(dot(front + back, vec3(1.0 / 3)) / false_top);
}
