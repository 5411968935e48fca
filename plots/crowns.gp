# Error against Monte Carlo beside time per cell: every light model, on a sparse crown, a
# dense one and a tree that others made.
csv = ARG1
png = ARG2
load "style.gp"

# The rows in the order of the file; the labels are the same in each.
rows = "|"
labels = "|"
n_rows = 0
n_labels = 0
array row_of[10]
array label_of[50]
note_row(r) = strstrt(rows, "|".r."|") ? 0 : \
    (rows = rows.r."|", n_rows = n_rows + 1, row_of[n_rows] = r, 0)
note_label(l) = strstrt(labels, "|".l."|") ? 0 : \
    (labels = labels.l."|", n_labels = n_labels + 1, label_of[n_labels] = l, 0)
stats csv using (note_row(stringcolumn("row")) + note_label(stringcolumn("column"))) nooutput

# The paper's own in orange, our recommendation in black, others by kind.
paint(l) = l eq "lattice" ? 0x000000 : l eq "self-consistent" ? 0x0072B2 : \
    l eq "march-g" ? 0x56B4E9 : l eq "SS" ? 0xCC79A7 : \
    l[1:3] eq "hem" ? 0x009E73 : strstrt(l, "kappa") ? 0x8C510A : \
    l eq "SPP" ? 0xE69F00 : 0xD55E00
# With a G-factor filled, without open.
shape(l) = l eq "lattice" ? 5 : l eq "self-consistent" ? 15 : l eq "march-g" ? 11 : \
    l eq "SS" ? 3 : l eq "SPPG (printed G)" ? 9 : l eq "SPPG (kappa 1)" ? 13 : strstrt(l, "G") ? 7 : 6
at(k, l) = stringcolumn("row") eq row_of[k] && stringcolumn("column") eq l
name(l) = l eq "SPPG" ? "SPPG (the paper's)" : l

@canvas 1500,640
set output png
set multiplot
set logscale xy
set grid linestyle 100
stats csv using "seconds_per_cell" name "time" nooutput
set xrange [time_min/2:time_max*2]
set yrange [1:110]
set xtics ("100 ns" 1e-7, "1 µs" 1e-6, "10 µs" 1e-5, "100 µs" 1e-4, "1 ms" 1e-3)
unset key

left = 0.06; right = 0.012; top = 0.15; bottom = 0.245
w = (1.0 - left - right) / n_rows
set label 1 at screen 0.5,0.965 center font ",17" \
    "Leaf irradiance: error of every light model beside its cost"
set label 2 at screen 0.5,0.92 center font ",12" \
    "rms over categories of depth and thickness (SPP Eq. 30) against Monte Carlo, albedo 0.95; bars: half the range over three seeds"

do for [k = 1:n_rows] {
    set lmargin at screen left+(k-1)*w+0.006
    set rmargin at screen left+k*w-0.006
    set tmargin at screen 1-top
    set bmargin at screen bottom
    set title row_of[k] noenhanced offset 0,-0.5 font ",13"
    set xlabel "time per cell with leaves, one core"
    set ylabel (k == 1 ? "error" : "")
    if (k > 1) { set xtics add ("" 1e-7) }
    if (k == 1) {
        set ytics ("1 %%" 1, "2 %%" 2, "5 %%" 5, "10 %%" 10, "20 %%" 20, "50 %%" 50, "100 %%" 100)
    } else {
        set ytics ("" 1, "" 2, "" 5, "" 10, "" 20, "" 50, "" 100)
    }
    plot for [i = 1:n_labels] csv using "seconds_per_cell": \
            (at(k, label_of[i]) ? column("ours") : NaN): \
            (column("ours") - column("spread")):(column("ours") + column("spread")) \
            with yerrorbars pointtype 0 linewidth 1 linecolor rgb paint(label_of[i]), \
        for [i = 1:n_labels] csv using "seconds_per_cell": \
            (at(k, label_of[i]) ? column("ours") : NaN) with points \
            pointtype shape(label_of[i]) pointsize 1.7 linewidth 1.6 \
            linecolor rgb paint(label_of[i])
    unset label 1
    unset label 2
}

@legend_below
set tmargin at screen 0.13
set key maxrows 2 font ",12"
plot for [i = 1:n_labels] NaN with points pointtype shape(label_of[i]) pointsize 1.7 \
    linewidth 1.6 linecolor rgb paint(label_of[i]) title name(label_of[i])
unset multiplot
