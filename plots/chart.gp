# Speed against accuracy: every method and setting, one panel a regime, mu0 = 0.6. With
# other programs on the same picture where scripts/bench-peers.sh has measured them.
#
#     gnuplot -c chart.gp chart.csv chart.png [peers/chart.csv]
csv = ARG1
png = ARG2
peers = ARGC > 2 ? ARG3 : ""
load "style.gp"

if (strlen(peers) > 0) {
    if (int(system(sprintf("test -f '%s' && echo 1 || echo 0", peers))) == 0) { peers = "" }
}
files = csv . (strlen(peers) > 0 ? " ".peers : "")

mu0 = 0.6
panels = 4
albedo_of(k)    = real(word("0.9 0.95 0.95 0.999", k))
g_of(k)         = real(word("0.5 0 0.8 0.5", k))
thickness_of(k) = real(word("0.1 10 10 50", k))
name_of(k) = word("thin thick forward-peaked near-conservative", k)
least = 1e-12

# Of the peers' file the peers; `exact` is in the other one.
wanted(f, m) = f eq csv || m ne "exact"

# What other programs are called without their mark.
plain_name(m) = m[1:5] eq "peer:" ? m[6:*] : m
method(f) = plain_name(stringcolumn("method"))

# The methods in the order of the files; the least of their times; their curves, one for each thing to turn.
methods = ""
curves = ""
listed(list, x) = strstrt(" ".list." ", " ".x." ") ? list : list." ".x
curve(f, m, s) = (f eq csv ? "1" : "2").m."|".(s eq "-" ? s : s[1:strstrt(s, "=")])
fastest = 1e9
note(f, m, s) = (methods = listed(methods, m), curves = listed(curves, curve(f, m, s)), \
    fastest = column("seconds") < fastest ? column("seconds") : fastest, 1)
do for [f in files] {
    stats f using (column("rms_rel") >= 0 && wanted(f, method(f)) ? \
        note(f, method(f), stringcolumn("setting")) : 1) nooutput
}
method_of(c) = c[2:(strstrt(c, "|") - 1)]
file_of(c) = word(files, int(c[1:1]))
line_of(c) = c[1:1] eq "1" ? 1 : 3

in_panel(k) = near("albedo", albedo_of(k)) && near("g", g_of(k)) \
    && near("thickness", thickness_of(k)) && near("mu0", mu0)
error(k) = in_panel(k) && column("rms_rel") >= 0 \
    ? (column("rms_rel") > least ? column("rms_rel") : least) : NaN
of(k, c) = curve(file_of(c), method(c), stringcolumn("setting")) eq c \
    ? error(k) : NaN

# The front of a panel: the points that no other beats in both. Times within a quarter
# are one time, clocks are no better; of equals the first counts; `auto` is others; what is
# wrong by more than the radiance itself is of no use, nor are the two that are there to be
# seen failing.
array took[1000]
array wrong[1000]
array title_of[1000]
array paint_of[1000]
not_meant(m) = m eq "auto" || m eq "spp-printed" || m eq "spp-literal"
remember(f, k, m, s) = error(k) < 1 && !not_meant(m) && wanted(f, m) \
    ? (n = n + 1, took[n] = column("seconds"), wrong[n] = error(k), \
       title_of[n] = short(m, s), paint_of[n] = colour(m), 1) : 1
short(m, s) = s eq "-" ? m : strstrt(s, "streams=") ? m." ".s[9:*] : \
    strstrt(s, "tol=1e-0") ? m." to 10^{-".s[9:*]."}" : \
    strstrt(s, "tol=") ? m." to ".s[5:*] : m." ".s
beats(i, j) = took[i] <= 1.25 * took[j] && wrong[i] <= 1.01 * wrong[j] \
    && (took[i] < took[j] / 1.25 || wrong[i] < wrong[j] / 1.01 || i < j)
on_front(j) = j > 1 && j <= n && (sum [i = 1:n] beats(i, j)) == 0

# The front in order of time, and names to the left of it, where nothing else can be.
array front[100]
array place[100]
swap(i) = (held = front[i], front[i] = front[i + 1], front[i + 1] = held)
sort_front = 'do for [i = 1:points] { do for [j = 1:points-1] { if (took[front[j]] > took[front[j+1]]) { held = swap(j) } } }'
apart = 0.62 # decades from name to name

@canvas 1500,1150
set output png
set multiplot
set logscale xy
set grid linestyle 100
set xrange [fastest/100:30] # room for a name to the left of the fastest
set yrange [least/5:20]
set xtics ("1 µs" 1e-6, "10 µs" 1e-5, "100 µs" 1e-4, "1 ms" 1e-3, "10 ms" 1e-2, "100 ms" 0.1, \
    "1 s" 1, "10 s" 10)
named = 'set ytics ("100 %%" 1, "10 %%" 0.1, "1 %%" 1e-2, "10^{-4}" 1e-4, "10^{-6}" 1e-6, "10^{-8}" 1e-8, "10^{-10}" 1e-10, "10^{-12}" 1e-12)'
plain = 'set ytics ("" 1, "" 0.1, "" 1e-2, "" 1e-4, "" 1e-6, "" 1e-8, "" 1e-10, "" 1e-12)'
unset key

left = 0.06; right = 0.01; top = 0.085; bottom = 0.125
w = (1.0 - left - right) / 2
h = (1.0 - top - bottom) / 2
set label 1 at screen 0.5,0.975 center font ",18" \
    "What to use: the fastest method for each accuracy"
set label 2 at screen 0.5,0.948 center font ",13" \
    "Named along the line: nothing else is both faster and more accurate. exact 16: sixteen streams.   (6688 radiances, μ_0 = 0.6)"

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
    do for [f in files] {
        stats f using (remember(f, k, method(f), stringcolumn("setting"))) \
            nooutput
    }
    points = 0
    do for [i = 2:n] {
        if (on_front(i)) { points = points + 1; front[points] = i }
    }
    @sort_front
    level = 2
    do for [i = 1:points] {
        j = front[i]
        level = level - apart < log10(wrong[j]) ? level - apart : log10(wrong[j])
        at_x = took[j] / 1.9
        at_y = 10**level
        set arrow 100+i from at_x*1.06,at_y to took[j],wrong[j] nohead linewidth 0.8 \
            linecolor rgb "#a0a0a0"
        set label 100+i title_of[j] at at_x,at_y right front font ",12" \
            textcolor rgb paint_of[j]
    }
    plot took using (on_front($1) ? took[$1] : NaN): \
            (on_front($1) ? wrong[$1] : NaN) smooth unique \
            with steps linewidth 6 linecolor rgb "#c8d8e8", \
        for [c in curves] file_of(c) using "seconds":(of(k, c)) \
            with linespoints pointtype symbol(method_of(c)) pointsize 1.2 \
            linewidth 1.2 dashtype line_of(c) linecolor rgb colour(method_of(c)), \
        took using (on_front($1) ? took[$1] : NaN): \
            (on_front($1) ? wrong[$1] : NaN) with points \
            pointtype 6 pointsize 2.4 linewidth 2 linecolor rgb "#404040"
    unset label 1
    unset label 2
    do for [i = 1:points] { unset label 100+i; unset arrow 100+i }
}

@legend_below
set tmargin at screen 0.075
set key maxrows 3 font ",12"
plot for [m in methods] NaN with linespoints pointtype symbol(m) pointsize 1.3 linewidth 2 \
    linecolor rgb colour(m) title m
unset multiplot
