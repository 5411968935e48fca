# SPP Table 1: the error of SPP and of its refinement, thickness 10.
csv = ARG1
png = ARG2
load "style.gp"
heading = "Table 1: error of SPP and of its refinement against the exact field   (thickness 10)"
methods = "spp spp-refined"
groups  = 3
width   = 1400
g_of(k) = word("0.0 0.5 -0.5", k)
title_of(k) = "g = " . word("0 0.5 −0.5", k)
of(k)   = strstrt(stringcolumn("column"), sprintf("g=%s ", g_of(k))) == 1
load "bars.gp"
