# SPP Figure 3: the exact field, the refined and the simplified model, albedo 0.99.
csv = ARG1
png = ARG2
load "style.gp"
methods = "exact spp-refined spp"
width   = 2000
heading = "Diffuse radiance in the plane of the beam: exact, refined SPP and SPP   (albedo 0.99, thickness 10)"
load "polar.gp"
