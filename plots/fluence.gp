# The fluence with depth of SPP and its relatives, and their errors against `exact`.
csv = ARG1
png = ARG2
load "style.gp"

methods = "exact spp spp-printed spp-refined single hemispheric eddington"
closed  = methods[7:*]
cases   = 4
g_of(case)   = real(word("0 0 0.5 0.5", case))
mu0_of(case) = real(word("1 0.5 1 0.5", case))

in_case(method, case) = stringcolumn("method") eq method \
    && near("g", g_of(case)) && near("mu0", mu0_of(case))
fluence(method, case) = in_case(method, case) ? 4 * pi * column("mean_intensity") : NaN

# A method's error needs the exact fluence at the same depth. Every method has the same
# depths in the same order, so the i-th row of the one belongs to the i-th of the other.
array exact[10000]
remember(case) = in_case("exact", case) \
    ? (i = i + 1, exact[i] = fluence("exact", case), 0) : NaN
error(method, case) = in_case(method, case) \
    ? (i = i + 1, 100 * abs(fluence(method, case) / exact[i] - 1)) : NaN

stats csv using "mean_intensity" name "mean" nooutput

@canvas 1700,900
set output png
set multiplot
set grid linestyle 100
set xrange [0:10]

left = 0.055; right = 0.005; top = 0.12; middle = 0.03; bottom = 0.145
w = (1.0 - left - right) / cases
h = (1.0 - top - middle - bottom) / 2

set label 1 at screen 0.5,0.975 center font ",16" \
    "Fluence with depth: SPP and its relatives beside the exact one, and their errors   (albedo 0.95, thickness 10)"
set label 2 at screen 0.5,0.94 center \
    "a dip of an error is where it changes sign; spp and hemispheric are one at μ_0 = 0.5"

do for [case = 1:cases] {
    set lmargin at screen left+(case-1)*w+0.006
    set rmargin at screen left+case*w-0.006

    set xtics 0,2,(case == cases ? 10 : 8)

    set tmargin at screen 1-top
    set bmargin at screen 1-top-h
    set title sprintf("g = %g, μ_0 = %g", g_of(case), mu0_of(case)) offset 0,-0.4 font ",13"
    set format x ""
    set format y (case == 1 ? "%g" : "")
    set xlabel ""
    set ylabel (case == 1 ? "fluence 4πJ  (units of F_0)" : "")
    unset logscale
    set yrange [0:1.05*4*pi*mean_max]
    unset key
    plot for [m in methods] csv using "depth":(fluence(m, case)) with lines \
        linecolor rgb colour(m) dashtype dash(m) linewidth 2
    unset label

    set tmargin at screen bottom+h
    set bmargin at screen bottom
    set title ""
    set format x "%g"
    set format y (case == 1 ? "%g %%" : "")
    set xlabel "optical depth τ"
    set ylabel (case == 1 ? "error, |fluence / exact − 1|" : "")
    set yrange [0.1:500]
    set logscale y
    i = 0
    plot csv using "depth":(remember(case)) with lines notitle, \
        for [m in closed] i = 0 csv using "depth":(error(m, case)) with lines \
        linecolor rgb colour(m) dashtype dash(m) linewidth 2
}

@legend_below
plot for [m in methods] NaN with lines title m \
    linecolor rgb colour(m) dashtype dash(m) linewidth 2
unset multiplot
