// Irradiance of both faces of a leaf at a point: from its cell, the sky's parts and the
// sun's maps. The sums of pps_system_shade_point.

uniform vec3 to_sun, sun;              // irradiance, 0 where it is switched off
uniform vec3 sun_scattered;            // the same for what it has scattered, by points
uniform usamplerBuffer cell_of;        // of a leaf of the scene
uniform samplerBuffer scattered;       // of a cell: (flux, diffuse) of three bands; (G, ...)
uniform samplerBuffer sky_shares;      // of a cell: of light of each direction
uniform samplerBuffer leaf_light;      // of a leaf: irradiance of front and back
uniform bool per_leaf;                 // light is that of leaf_light alone
uniform int n_directions;
uniform vec3 direction[24], part[24];  // of the sky: irradiance of a face turned there

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

// The sun straight, and what of it is scattered, by the depths at the point itself.
void sun_light(int instance, int cell, vec3 point, vec3 n, vec3 lit, inout vec3 even,
               inout vec3 odd, out vec3 front, out vec3 back) {
    front = back = vec3(0);
    if (sun + sun_scattered == vec3(0))
        return;
    vec2 met = sun_met(instance, point, n);
    float cosine = dot(lit, to_sun), share = cosine * sun_share(met);
    front = max(share, 0) * sun;
    back = max(-share, 0) * sun;
    if (sun_scattered != vec3(0)) {
        vec3 sum, net, e = sun_scattered * texelFetch(scattered, 4 * cell + 3).x;
        slab_light(met.x, met.x + met.y, sum, net);
        even += e * sum / 4;
        odd += e * net / 4 * cosine;
    }
}

// n: of the leaf, which is not in its own shade; lit: the normal that light falls on.
void leaf_irradiance(int leaf, int instance, vec3 point, vec3 n, vec3 lit, out vec3 front,
                     out vec3 back) {
    if (per_leaf) {
        front = texelFetch(leaf_light, 2 * leaf).rgb;
        back = texelFetch(leaf_light, 2 * leaf + 1).rgb;
        return;
    }
    int cell = int(texelFetch(cell_of, leaf).x);
    vec3 even, odd;
    for (int b = 0; b < 3; b++) {
        vec4 light = texelFetch(scattered, 4 * cell + b);
        even[b] = light.w / 4;
        odd[b] = dot(lit, light.xyz) / 2;
    }
    sun_light(instance, cell, point, n, lit, even, odd, front, back);
    front += max(even + odd, 0);
    back += max(even - odd, 0);
    sky_light(cell, lit, front, back);
}
