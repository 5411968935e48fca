# Speed against accuracy: every method and setting, one panel a regime, mu0 = 0.6.
# Right of the thick line lies what something else does both faster and better.
csv = ARG1
png = ARG2
load "style.gp"

mu0 = 0.6
panels = 4
albedo_of(k)    = real(word("0.9 0.95 0.95 0.999", k))
g_of(k)         = real(word("0.5 0 0.8 0.5", k))
thickness_of(k) = real(word("0.1 10 10 50", k))
name_of(k) = word("thin thick forward-peaked near-conservative", k)
least = 1e-12

# The methods in the order of the file; their curves, one for each thing to turn.
methods = ""
curves = ""
listed(list, x) = strstrt(" ".list." ", " ".x." ") ? list : list." ".x
curve(m, s) = m."|".(s eq "-" ? s : s[1:strstrt(s, "=")])
note(m, s) = (methods = listed(methods, m), curves = listed(curves, curve(m, s)), 1)
stats csv using (column("rms_rel") >= 0 ? \
    note(stringcolumn("method"), stringcolumn("setting")) : 1) nooutput
method_of(c) = c[1:(strstrt(c, "|") - 1)]

in_panel(k) = near("albedo", albedo_of(k)) && near("g", g_of(k)) \
    && near("thickness", thickness_of(k)) && near("mu0", mu0)
error(k) = in_panel(k) && column("rms_rel") >= 0 \
    ? (column("rms_rel") > least ? column("rms_rel") : least) : NaN
of(k, c) = curve(stringcolumn("method"), stringcolumn("setting")) eq c ? error(k) : NaN

# The front of a panel: the points that no other beats in both. Times within a quarter
# are one time, clocks are no better; of equals the first counts; `auto` is others.
array took[1000]
array wrong[1000]
array title_of[1000]
remember(k) = error(k) > 0 && stringcolumn("method") ne "auto" ? (n = n + 1, took[n] = column("seconds"), \
    wrong[n] = error(k), title_of[n] = short(stringcolumn("method"), \
    stringcolumn("setting")), 1) : 1
short(m, s) = s eq "-" ? m : strstrt(s, "streams=") ? m . " " . s[9:*] \
    : m . " " . s
beats(i, j) = took[i] <= 1.25 * took[j] && wrong[i] <= 1.01 * wrong[j] \
    && (took[i] < took[j] / 1.25 || wrong[i] < wrong[j] / 1.01 || i < j)
on_front(j) = j <= n && (sum [i = 1:n] beats(i, j)) == 0
front_y(j) = on_front(j) ? wrong[j] : NaN

@canvas 1500,1150
set output png
set multiplot
set logscale xy
set grid linestyle 100
set xrange [5e-7:30]
set yrange [least/5:20]
set xtics ("1 µs" 1e-6, "10 µs" 1e-5, "100 µs" 1e-4, "1 ms" 1e-3, "10 ms" 1e-2, "100 ms" 0.1, \
    "1 s" 1, "10 s" 10)
named = 'set ytics ("100 %%" 1, "10 %%" 0.1, "1 %%" 1e-2, "10^{-4}" 1e-4, "10^{-6}" 1e-6, "10^{-8}" 1e-8, "10^{-10}" 1e-10, "10^{-12}" 1e-12)'
plain = 'set ytics ("" 1, "" 0.1, "" 1e-2, "" 1e-4, "" 1e-6, "" 1e-8, "" 1e-10, "" 1e-12)'
unset key

left = 0.06; right = 0.01; top = 0.085; bottom = 0.125
w = (1.0 - left - right) / 2
h = (1.0 - top - bottom) / 2
set label 1 at screen 0.5,0.975 center font ",16" \
    "What to use: error against time, one more evaluation of 6688 radiances   (μ_0 = 0.6)"
set label 2 at screen 0.5,0.948 center \
    "lower left is better; ringed and named: nothing else is both faster and more accurate (exact 16: 16 streams)"

do for [k = 1:panels] {
    row = (k - 1) / 2
    col = (k - 1) % 2
    set lmargin at screen left+col*w+0.012
    set rmargin at screen left+(col+1)*w-0.012
    set tmargin at screen 1-top-row*h-0.03
    set bmargin at screen 1-top-(row+1)*h+0.025
    set title sprintf("%s: albedo %g, g = %g, thickness %g", name_of(k), albedo_of(k), \
        g_of(k), thickness_of(k)) offset 0,-0.5 font ",13"
    set xlabel (row == 1 ? "time of one more evaluation" : "")
    set ylabel (col == 0 ? "rms error / mean radiance" : "") offset 1,0
    if (col == 0) { @named } else { @plain }
    n = 1 # the first of an array is lost as its heading
    took[1] = wrong[1] = 1e9
    stats csv using (remember(k)) nooutput
    plot for [c in curves] csv using "seconds":(of(k, c)) with linespoints \
            pointtype symbol(method_of(c)) pointsize 1.3 linewidth 1.2 \
            linecolor rgb colour(method_of(c)), \
        took using (on_front($1) ? took[$1] : NaN):(front_y($1)) smooth unique \
            with fsteps linewidth 3 linecolor rgb "#60808080", \
        took using (on_front($1) ? took[$1] : NaN):(front_y($1)) with points \
            pointtype 6 pointsize 2.4 linewidth 2 linecolor rgb "#404040", \
        took using (on_front($1) ? took[$1]/1.25 : NaN):(front_y($1)/1.6): \
            (on_front($1) ? title_of[$1] : "") \
            with labels right font ",11" textcolor rgb "#202020"
    unset label 1
    unset label 2
}

@legend_below
plot for [m in methods] NaN with linespoints pointtype symbol(m) pointsize 1.3 linewidth 2 \
    linecolor rgb colour(m) title m
unset multiplot
