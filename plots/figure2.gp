# SPP Figure 2: the exact field and the simplified model, albedo 0.95.
csv = ARG1
png = ARG2
load "style.gp"
methods = "exact spp"
width   = 1500
heading = "Diffuse radiance in the plane of the beam: exact and SPP   (albedo 0.95, thickness 10)"
load "polar.gp"
