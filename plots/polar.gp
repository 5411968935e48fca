# Shared by Figures 2 and 3: the radiance in the plane of the beam as polar lobes. A row
# for each case, a column for each depth, in each panel the methods side by side. Light
# that travels down is drawn downwards, light that travels along with the beam (phi = 0)
# to the right. A row has one scale; its ring tells it.
#
# Needs `methods`, `width` (pixels) and `heading`.

g_of(row)      = real(word("0 0 0.5 0.5", row))
theta0_of(row) = real(word("0 45 0 45", row))
depth_of(col)  = real(word("0.5 1 2 4", col))
mu0_of(row)    = cos(theta0_of(row) * pi / 180)
rows = 4
cols = 4
n = words(methods)

wanted(row, phi) = near("g", g_of(row)) && near("mu0", mu0_of(row)) && near("phi", phi)
at(method, col) = stringcolumn("method") eq method && near("depth", depth_of(col))
across(phi) = (phi == 0 ? 1 : -1) * column("radiance") * sqrt(1 - column("mu")**2)
up(phi) = -column("radiance") * column("mu")

# The largest radiance of a row, and a round number below it for the ring.
round_below(x) = (decade = 10**floor(log10(x)), x >= 5 * decade ? 5 * decade : \
                  x >= 2 * decade ? 2 * decade : decade)
array largest[rows]
do for [row = 1:rows] {
    stats csv using ((wanted(row, 0) || wanted(row, 180)) ? column("radiance") : NaN) \
        name "row" nooutput
    largest[row] = row_max
}

# In units of a row's largest radiance r: every lobe has a cell 2.1 wide and 2.95 high.
left = 115.0 / width; right = 8.0 / width
panel_w = (1.0 - left - right) / cols
height = int(110 + rows * panel_w * width * 2.95 / (2.1 * n))
top = 105.0 / height; bottom = 5.0 / height
panel_h = (1.0 - top - bottom) / rows
@canvas width,height
set output png
set multiplot
unset key
unset border
unset tics

set label 1 heading at screen 0.5,1-25.0/height center font ",16"
set label 2 "beam irradiance F_0 = 1; radiance in F_0 per steradian" \
    at screen 0.5,1-55.0/height center font ",12"
do for [col = 1:cols] {
    set label 10+col sprintf("optical depth τ = %g", depth_of(col)) font ",13" \
        at screen left+(col-0.5)*panel_w, screen 1-90.0/height center
}
do for [row = 1:rows] {
    ring = round_below(largest[row])
    set label 20+row sprintf("g = %g\nθ_0 = %g°\n\nring: %g\nF_0 / sr", \
        g_of(row), theta0_of(row), ring) \
        at screen 12.0/width, screen 1-top-(row-0.65)*panel_h left font ",13"
}

do for [row = 1:rows] {
    r = largest[row]
    ring = round_below(r)
    step = 2.1 * r
    centre(i) = (i - (n + 1) / 2.0) * step
    do for [col = 1:cols] {
        set lmargin at screen left+(col-1)*panel_w+0.004
        set rmargin at screen left+col*panel_w-0.004
        set tmargin at screen 1-top-(row-1)*panel_h
        set bmargin at screen 1-top-row*panel_h
        set size ratio -1
        set xrange [-step*n/2.0:step*n/2.0]
        set yrange [-1.4*r:1.55*r]
        unset object
        unset arrow
        do for [i = 1:n] {
            set object i circle at centre(i),0 size ring fillstyle empty \
                border rgb "#b0b0b0" linewidth 0.6
            set arrow 2*i-1 from centre(i)-r,0 to centre(i)+r,0 nohead \
                linecolor rgb "#b0b0b0" linewidth 0.6
            set arrow 2*i from centre(i)-1.5*r*sin(theta0_of(row)*pi/180),1.5*r*mu0_of(row) \
                to centre(i)-1.1*r*sin(theta0_of(row)*pi/180),1.1*r*mu0_of(row) head filled size screen 0.006,20 \
                linecolor rgb "#707070" linewidth 1.0
            set label 100+i word(methods, i) at centre(i),-1.24*r center \
                textcolor rgb colour(word(methods, i)) font ",11"
        }
        plot for [i = 1:n] for [phi in "0 180"] csv \
            using (wanted(row, phi+0) && at(word(methods, i), col) \
                ? centre(i) + across(phi+0) : NaN):(up(phi+0)) \
            with filledcurves closed linecolor rgb colour(word(methods, i)) \
                fillstyle transparent solid 0.25 border
        unset for [k = 1:4] label k
        unset for [k = 10:30] label k
    }
}
unset multiplot
