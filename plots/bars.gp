# Shared by Tables 1 and 2: our errors as bars, the paper's as diamonds; below, the same
# error relative to the exact field. A panel for each group of the table.
#
# Needs `heading`, `width`, `groups`, `methods`, and of a group its title_of(k) and of(k),
# true in its rows.

rows = "0.5 0.7 0.9 0.95 0.99 total"
array place[words(rows)]
x_of(name) = name eq "total" ? 6.3 : \
    sum [i = 1:5] (abs(real(word(rows, i)) - real(name)) < 1e-9 ? i : 0)
n = words(methods)
bar = 0.8 / n
x_bar(i) = x_of(stringcolumn("row")) + (i - (n + 1) / 2.0) * bar
of_bar(k, i) = of(k) && stringcolumn("method") eq word(methods, i)

stats csv using "ours" name "ours" nooutput
stats csv using "paper" name "paper" nooutput
stats csv using "rms_rel" name "rel" nooutput

@canvas width,850
set output png
set multiplot
set label 1 heading at screen 0.5,0.965 center font ",16"
set style fill solid 1.0 noborder
set boxwidth 0.92*bar
set grid y linestyle 100
set xrange [0.4:6.9]
set yrange [0:*]
set xtics ("0.5" 1, "0.7" 2, "0.9" 3, "0.95" 4, "0.99" 5, "all" 6.3) scale 0
set ytics scale 0.5
unset key

left = 90.0 / width; right = 10.0 / width; gap = 8.0 / width
top = 0.115; middle = 0.05; bottom = 0.15
w = (1.0 - left - right) / groups
h = (1.0 - top - middle - bottom) / 2
do for [k = 1:groups] {
    set lmargin at screen left+(k-1)*w+gap
    set rmargin at screen left+k*w-gap
    set format y (k == 1 ? "%g %%" : "")

    set tmargin at screen 1-top
    set bmargin at screen 1-top-h
    set title title_of(k) offset 0,-0.4 font ",13"
    set xlabel ""
    set ylabel (k == 1 ? "rms error, % of F_0 per steradian" : "")
    set yrange [0:1.08*(ours_max > paper_max ? ours_max : paper_max)]
    plot for [i = 1:n] csv using (of_bar(k, i) ? x_bar(i) : NaN):"ours" \
            with boxes linecolor rgb colour(word(methods, i)), \
        for [i = 1:n] csv using (of_bar(k, i) ? x_bar(i) : NaN):"paper" \
            with points pointtype 13 pointsize 2.1 linecolor rgb "white", \
        for [i = 1:n] csv using (of_bar(k, i) ? x_bar(i) : NaN):"paper" \
            with points pointtype 12 pointsize 1.8 linewidth 1.5 linecolor rgb "black"
    unset label 1

    set tmargin at screen bottom+h
    set bmargin at screen bottom
    set title ""
    set xlabel "albedo"
    set ylabel (k == 1 ? "rms error / mean exact radiance" : "")
    set yrange [0:1.08*rel_max]
    plot for [i = 1:n] csv using (of_bar(k, i) ? x_bar(i) : NaN):"rms_rel" \
        with boxes linecolor rgb colour(word(methods, i))
}

@legend_below
plot for [i = 1:n] NaN with lines linewidth 8 linecolor rgb colour(word(methods, i)) \
        title word(methods, i) . " (ours)", \
    NaN with points pointtype 12 pointsize 1.8 linewidth 1.5 linecolor rgb "black" \
        title "the paper's figure"
unset multiplot
