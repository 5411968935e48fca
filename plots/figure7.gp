# Figure 7 of Boulanger et al. in numbers: the per-leaf model against Monte Carlo as a
# viewer sees it, a panel a component, bars for three crowns from three sides.
#
#     gnuplot -c figure7.gp figure7.csv figure7.png
csv = ARG1
png = ARG2
load "style.gp"

views = "side lit back-lit"
leaves = "1500 4000 9000"
array crown[3] = ["1500 leaves, index 6", "4000 leaves in clumps, index 5", "9000 leaves, index 6"]
array part[3] = ["sky", "sun", "indirect"]
array title_of[3] = ["direct, from the sky", "direct, from the sun", "sun, by way of one leaf"]
other(k) = k == 2 ? "sun unbiased" : part[k] # drawn for the sun alone
array paint[3] = [0x56B4E9, 0x0072B2, 0x332288]
array paper[3] = [5, 7.5, 6]

# A group a view, in it a bar a crown; where the sun is averaged without bias, a mark.
x_of(v, c) = v + (c - 2) * 0.26
of(v, c, p) = stringcolumn("row")[1:4] eq word(leaves, c) \
    && stringcolumn("column") eq word(views, v)." ".p

@canvas 1300,560
set output png
set multiplot
set style fill solid 0.85 noborder
set boxwidth 0.24
set grid y linestyle 100
set xrange [0.45:3.55]
set yrange [0:15]
set xtics ("from the side" 1, "from the sun" 2, "against the sun" 3) scale 0
unset key
set pointintervalbox 0
left = 0.055; right = 0.01; top = 0.17; bottom = 0.2
w = (1.0 - left - right) / 3
set label 1 at screen 0.5,0.965 center font ",16" \
    "The per-leaf model against Monte Carlo of one bounce, as it is seen"
set label 2 at screen 0.5,0.915 center font ",12" \
    "mean |difference| of pixels that show a leaf / 99.9th percentile of the radiance; ticks: half the range over three seeds"
do for [k = 1:3] {
    set lmargin at screen left+(k-1)*w+0.005
    set rmargin at screen left+k*w-0.005
    set tmargin at screen 1-top
    set bmargin at screen bottom
    set title title_of[k] offset 0,-0.4 font ",13"
    set format y (k == 1 ? "%g %%" : "")
    plot for [c = 1:3] for [v = 1:3] csv using \
            (x_of(v, c)):(of(v, c, part[k]) ? column("ours") : NaN) \
            with boxes linecolor rgb paint[c], \
        for [c = 1:3] for [v = 1:3] csv using (x_of(v, c)): \
            (of(v, c, part[k]) ? column("ours") : NaN):"spread" \
            with yerrorbars pointtype 7 pointsize 0 linewidth 1.2 linecolor rgb "black", \
        for [c = 1:3] for [v = 1:3] csv using (x_of(v, c)): \
            (of(v, c, other(k)) ? column("ours") : NaN) \
            with points pointtype 6 pointsize (k == 2 ? 1.4 : 0) linewidth 1.6 linecolor rgb "black", \
        [x=0.55:1.45] paper[k] with lines dashtype 2 linewidth 1.6 linecolor rgb "#D55E00"
    unset label 1
    unset label 2
}

@legend_below
set tmargin at screen 0.12
plot for [c = 1:3] NaN with lines linewidth 9 linecolor rgb paint[c] title crown[c], \
    NaN with points pointtype 6 pointsize 1.4 linewidth 1.6 linecolor rgb "black" \
        title "sun with unbiased mean", \
    NaN with lines dashtype 2 linewidth 1.6 linecolor rgb "#D55E00" title "B, side view"
unset multiplot
