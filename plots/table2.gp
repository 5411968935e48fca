# SPP Table 2: the error of refined SPP for several thicknesses, mean over g = 0, 0.5, -0.5.
csv = ARG1
png = ARG2
load "style.gp"
heading = "Table 2: error of refined SPP against the exact field   (mean over g = 0, 0.5, −0.5)"
methods = "spp-refined"
groups  = 4
width   = 1400
w_of(k) = word("inf 16 10 5", k)
title_of(k) = k == 1 ? "half-space" : "thickness " . w_of(k)
of(k)   = stringcolumn("column") eq sprintf("w=%s", w_of(k))
load "bars.gp"
