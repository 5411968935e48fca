// Second pass: one surface more, in its layer and all behind; the texels add up.
#version 330 core

noperspective in float along;
in vec2 place;

uniform sampler2D image;
uniform float alpha_min;
uniform sampler2DArray spans;
uniform int map;
uniform float weight;

layout(location = 0) out vec4 near_layers;
layout(location = 1) out vec4 far_layers;

void main() {
    if (alpha_min > 0 && texture(image, place).a < alpha_min)
        discard;
    vec2 span = texelFetch(spans, ivec3(ivec2(gl_FragCoord.xy), map), 0).xy;
    float first = -span.x, depth = span.y - first;
    float layer = depth > 0 ? min(floor((along - first) / depth * 8), 7) : 0;
    near_layers = weight * step(layer, vec4(0, 1, 2, 3));
    far_layers = weight * step(layer, vec4(4, 5, 6, 7));
}
