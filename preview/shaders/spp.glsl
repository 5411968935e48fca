// Light scattered in a slab, in closed form: tree/slab_light.c in single precision, for
// three bands at once.
//
// There the three exponentials have the factor 1/(1 - lambda), and cancel about lambda = 1.
// Here it is divided out: with D(z) = (e^(-lambda z) - e^(-z))/(1 - lambda),
//   sum = k [P e^(-lambda z) + Q e^(-lambda (w - z)) + D(z)],  k = m^2 (1 - r^2)/(1 + lambda)
//   net = k [r P e^(-lambda z) - r Q e^(-lambda (w - z)) + (D(z) - e^(-lambda z))/m].

uniform float slab_m;      // 1 over the mean cosine of scattered light
uniform float slab_kappa;  // times the scattered light; 0: this is not asked for
uniform vec3 slab_lambda;  // m sqrt(1 - albedo), above 0

// (e^x - 1)/x, where the difference would cancel by its series.
vec3 growth(vec3 x) {
    vec3 series = 1 + x / 2 * (1 + x / 3 * (1 + x / 4 * (1 + x / 5 * (1 + x / 6))));
    return mix((exp(x) - 1) / x, series, lessThan(abs(x), vec3(0.5)));
}

vec3 difference(float z) { return z * exp(-z) * growth((1 - slab_lambda) * z); }

// Fluence and net flux along the light at depth z of w, for unit irradiance.
void slab_light(float z, float w, out vec3 sum, out vec3 net) {
    float m = slab_m;
    vec3 lambda = slab_lambda, r = lambda / m, e = exp(-lambda * w), d = difference(w);
    vec3 det = 4 * r + (1 - r) * (1 - r) * 2 * lambda * w * growth(-2 * lambda * w);
    vec3 p = ((1 + r) / m + (1 - r) * e * ((1 - 1 / m) * d + e / m)) / det;
    vec3 q = -((1 + r) * (1 - 1 / m) * d + 2 * e / m) / det;
    vec3 down = exp(-lambda * z), up = exp(-lambda * (w - z)), k = difference(z);
    vec3 all = slab_kappa * m * m * (1 - r * r) / (1 + lambda);
    sum = all * (p * down + q * up + k);
    net = all * (r * (p * down - q * up) + (k - down) / m);
}
