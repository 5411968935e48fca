# Error against Monte Carlo beside cost: every light model of both papers and Monte Carlo
# itself, on a sparse crown, a dense one and a tree that others made. Above by categories,
# beside the time per cell; below leaf by leaf, beside the time per leaf.
#
#     gnuplot -c crowns.gp crowns.csv crowns.png
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

# The SPP paper's own in orange, the other paper's in violet, our recommendation in black.
mc(l) = l[1:2] eq "mc"
paint(l) = l eq "lattice" || l eq "radiosity" ? 0x000000 : l eq "self-consistent" ? 0x0072B2 : \
    l eq "march-g" ? 0x56B4E9 : l eq "SS" ? 0xCC79A7 : \
    l[1:3] eq "hem" ? 0x009E73 : strstrt(l, "kappa") ? 0x8C510A : \
    l eq "SPP" ? 0xE69F00 : mc(l) ? 0xCC0000 : l[1:5] eq "leaf-" ? 0x332288 : \
    l[1:4] eq "leaf" ? 0xAA4499 : 0xD55E00
# With a G-factor, or the unbiased mean of the sun, filled; without, open.
shape(l) = l eq "lattice" ? 5 : l eq "radiosity" ? 13 : l eq "self-consistent" ? 15 : l eq "march-g" ? 11 : \
    l eq "SS" ? 3 : l eq "SPPG (printed G)" ? 9 : l eq "SPPG (kappa 1)" ? 13 : mc(l) ? 1 : \
    l eq "leaf" ? 8 : l eq "leaf unbiased" ? 9 : l eq "leaf-lattice" ? 4 : \
    l eq "leaf-lattice unbiased" ? 5 : strstrt(l, "G") ? 7 : 6
at(k, l) = stringcolumn("row") eq row_of[k] && stringcolumn("column") eq l
# One entry in the legend for all counts of rays.
name(l) = l eq "SPPG" ? "SPPG (the paper's)" : \
    mc(l) ? (l eq "mc 18K rays" ? "mc, 18K to 1.8M rays" : "") : l

@canvas 1500,1150
set output png
set multiplot
set logscale xy
set grid linestyle 100
unset key

# The two rows of panels: what is drawn, over what, and its words.
error_of(i) = i == 1 ? "ours" : "rms_leaf"
time_of(i) = i == 1 ? "seconds_per_cell" : "seconds_per_leaf"
time_words(i) = i == 1 ? "time per cell with leaves, one core" : "time per leaf, one core"
error_words(i) = i == 1 ? "error of categories" : "error of a leaf"
bar(i) = i == 1 ? column("spread") : 0

left = 0.06; right = 0.012; top = 0.09; bottom = 0.165; middle = 0.075
w = (1.0 - left - right) / n_rows
h = (1.0 - top - bottom - middle) / 2
set label 1 at screen 0.5,0.978 center font ",17" \
    "Leaf irradiance: error of every light model beside its cost"
set label 2 at screen 0.5,0.953 center font ",11.5" \
    "Against Monte Carlo, sun alone, albedo 0.95. Above: rms over categories (SPP Eq. 30), bars: half the range of three seeds. Below: rms over leaves, without the reference's noise."
set xtics ("100 ns" 1e-7, "1 µs" 1e-6, "10 µs" 1e-5, "100 µs" 1e-4, "1 ms" 1e-3, "10 ms" 1e-2)
percents = '("0.5 %%" 0.5, "1 %%" 1, "2 %%" 2, "5 %%" 5, "10 %%" 10, "20 %%" 20, "50 %%" 50, "100 %%" 100)'
no_words = '("" 0.5, "" 1, "" 2, "" 5, "" 10, "" 20, "" 50, "" 100)'

do for [i = 1:2] {
    set autoscale
    stats csv using (column(time_of(i))) name "time" nooutput
    set xrange [time_min*0.7:time_max*2]
    least = i == 1 ? 0.4 : 2
    set yrange [least:130]
    do for [k = 1:n_rows] {
        set lmargin at screen left+(k-1)*w+0.006
        set rmargin at screen left+k*w-0.006
        set tmargin at screen 1-top-(i-1)*(h+middle)
        set bmargin at screen 1-top-(i-1)*(h+middle)-h
        set title (i == 1 ? row_of[k] : "") noenhanced offset 0,-0.5 font ",13"
        set xlabel time_words(i)
        set ylabel (k == 1 ? error_words(i) : "")
        if (k == 1) { set ytics @percents } else { set ytics @no_words }
        plot csv using (column(time_of(i))):(stringcolumn("row") eq row_of[k] && mc(stringcolumn("column")) \
                ? column(error_of(i)) : NaN) smooth unique with lines linewidth 1.2 \
                dashtype 3 linecolor rgb 0xCC0000, \
            for [j = 1:n_labels] csv using (column(time_of(i))): \
                (at(k, label_of[j]) ? column(error_of(i)) : NaN): \
                (column(error_of(i)) - bar(i)):(column(error_of(i)) + bar(i)) \
                with yerrorbars pointtype shape(label_of[j]) pointsize 1.5 linewidth 1.4 \
                linecolor rgb paint(label_of[j])
        unset label 1
        unset label 2
    }
}

@legend_below
set tmargin at screen 0.1
set key maxrows 3 font ",12"
plot for [i = 1:n_labels] NaN with points pointtype shape(label_of[i]) pointsize 1.7 \
    linewidth 1.6 linecolor rgb paint(label_of[i]) title name(label_of[i])
unset multiplot
