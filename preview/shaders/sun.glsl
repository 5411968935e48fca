// Light of the sun at a point of the scene, by the opacity maps of the plants about.
// Shared by plants and ground; the same sums as tree/system.c. `by_count` is a constant that
// by_count.glsl or by_opacity.glsl has.

uniform sampler2DArray spans;         // (-first, last) of each pose
uniform sampler2DArray near_counts, far_counts; // of layers 0-3, 4-7
uniform samplerBuffer casters;        // translation, 1/scale; cosine, sine, pose, own
uniform samplerBuffer poses;          // across, up (in texels), axis and texel's size
uniform usamplerBuffer shade;         // first of each instance, then the lists
uniform int map_texels;

// Layer k of eight; 0 before the first.
float layer_of(vec4 low, vec4 high, int k) {
    return dot(low, vec4(equal(ivec4(k), ivec4(0, 1, 2, 3)))) +
           dot(high, vec4(equal(ivec4(k), ivec4(4, 5, 6, 7))));
}

// Surfaces before a place in a texel and behind it, without `own` of them.
vec2 counts_about(ivec3 texel, vec2 span, float along, float own) {
    float first = -span.x;
    vec4 low = texelFetch(near_counts, texel, 0), high = texelFetch(far_counts, texel, 0);
    float upto = 0;
    if (along > first && span.y <= first) {
        upto = max(low.x - own, 0);
    } else if (along > first) {
        float layers = (along - first) / (span.y - first) * 8;
        int k = int(min(layers, 7));
        float count = layer_of(low, high, k), before = layer_of(low, high, k - 1);
        upto = before + min(layers - float(k), 1) * max(count - before - own, 0);
    }
    return vec2(upto, max(high.w - own - upto, 0));
}

// Counts before the point and behind it, or (in .x) the share of texels that are hidden, of
// one caster. normal: of the surface of its own that the point is on, which goes on as a
// plane; 0: of none. tree/opacity_map.c.
vec2 look(int caster, vec3 point, vec3 normal) {
    vec4 place = texelFetch(casters, 2 * caster), turn = texelFetch(casters, 2 * caster + 1);
    vec3 off = (point - place.xyz) * place.w;
    vec4 at = vec4(turn.x * off.x + turn.y * off.y, turn.x * off.y - turn.y * off.x, off.z, 1);
    int pose = int(turn.z);
    vec2 texels = vec2(dot(texelFetch(poses, 3 * pose), at),
                       dot(texelFetch(poses, 3 * pose + 1), at));
    bool beside =
        any(lessThan(texels, vec2(-1))) || any(greaterThan(texels, vec2(map_texels)));
    vec4 axis = texelFetch(poses, 3 * pose + 2);
    float middle = dot(axis.xyz, at.xyz), slack = 0;
    vec2 sum = vec2(0);
    vec2 slope = vec2(0);
    bool itself = normal != vec3(0);
    if (itself) {
        vec3 n = vec3(turn.x * normal.x + turn.y * normal.y,
                      turn.x * normal.y - turn.y * normal.x, normal.z);
        vec3 across = texelFetch(poses, 3 * pose).xyz, up = texelFetch(poses, 3 * pose + 1).xyz;
        float cosine = dot(n, axis.xyz);
        cosine = abs(cosine) > 1e-6 ? cosine : 1e-6;
        vec2 size = 1 / vec2(length(across), length(up));
        slope = clamp(-vec2(dot(n, across), dot(n, up)) * size / cosine, -6, 6);
        slack = 0.25 * axis.w * (1 + abs(slope.x) + abs(slope.y));
        slope *= size;
    }
    vec2 low = floor(texels), part = texels - low;
    for (int k = beside ? 4 : 0; k < 4; k++) { // software skips loops, but no branches
        ivec2 corner = ivec2(k & 1, k >> 1), t = ivec2(low) + corner;
        vec2 share = mix(1 - part, part, vec2(corner));
        float along = middle + dot(slope, vec2(corner) - part);
        if (all(greaterThanEqual(t, ivec2(0))) && all(lessThan(t, ivec2(map_texels)))) {
            vec2 span = texelFetch(spans, ivec3(t, pose), 0).xy;
            if (by_count) {
                bool own = itself && along > -span.x - slack && along < span.y + slack;
                sum += share.x * share.y *
                       counts_about(ivec3(t, pose), span, along, own ? 1 : 0);
            } else if (along > -span.x + slack) {
                sum.x += share.x * share.y;
            }
        }
    }
    return sum;
}

// All casters of a list (of an instance; number n_instances, of the ground) about a point on
// a surface of this normal of the instance (0: on none). By counts: their sums before and
// behind; else the share of the light that comes, in .x.
vec2 sun_met(int list, vec3 point, vec3 normal) {
    uint first = texelFetch(shade, list).x, end = texelFetch(shade, list + 1).x;
    float light = 1;
    vec2 count = vec2(0);
    for (uint k = first; k < end && (by_count || light > 0.004); k++) {
        int caster = int(texelFetch(shade, int(k)).x);
        vec2 met = look(caster, point, caster == list ? normal : vec3(0));
        light *= 1 - met.x;
        count += met;
    }
    return by_count ? count : vec2(max(light, 0), 0);
}

float sun_share(vec2 met) { return by_count ? exp(-met.x) : met.x; }

float sun_share(int list, vec3 point, vec3 normal) {
    return sun_share(sun_met(list, point, normal));
}
