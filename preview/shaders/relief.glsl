// What a flat leaf of a few triangles leaves out, for the eye alone: it bulges, and its image
// tells of veins. Only the normal that light falls on turns; where the leaf is stays.

uniform float relief;    // 0: leaves are as flat as the model has them
uniform float leaf_size; // metres

const float BULGE = 0.6, VEINS = 0.08; // slopes: at the rim; of all the image's contrast

// The slope of a height, in metres, that is known at the pixels about (Mikkelsen 2010).
vec3 slope_of(vec3 point, vec3 n, float height) {
    vec3 right = dFdx(point), up = dFdy(point);
    vec3 across = cross(up, n), along = cross(n, right);
    float area = dot(right, across);
    vec3 slope = (dFdx(height) * across + dFdy(height) * along) / (abs(area) + 1e-12);
    return area < 0 ? -slope : slope;
}

// from_center: of the leaf, in leaf sizes; bright: of the image, over its mean.
vec3 with_relief(vec3 n, vec3 point, vec3 from_center, float bright) {
    vec3 slope = slope_of(point, n, VEINS * leaf_size * min(bright, 3));
    slope *= min(1, 1 / max(length(slope), 1e-6)); // a cut-out's edge is no cliff
    return normalize(n + relief * (BULGE * (from_center - dot(from_center, n) * n) - slope));
}
