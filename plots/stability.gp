# Where methods hold and where they fail, a column a method. Above: albedo by thickness at
# g = 0.5. Below: beams on and beside five special mu0, by thickness.
csv = ARG1
png = ARG2
load "style.gp"

# The methods in the order of the file.
methods = ""
listed(list, x) = strstrt(" ".list." ", " ".x." ") ? list : list." ".x
stats csv using (methods = listed(methods, stringcolumn("method")), 1) nooutput
banks = (words(methods) + 7) / 8
columns = (words(methods) + banks - 1) / banks

# Green is right, and paler where the digits are those of an approximation; then yellow to
# red with the error; violet for what no answer may be; grey says that it refused.
paint(status, error) = status eq "refused" ? 0xC8C8C8 : status eq "ok" \
    ? (error > 1e-3 ? 0xA6D96A : 0x1A9641) : status eq "negative" ? 0x7B3294 : \
    status eq "not_finite" ? 0x000000 : status eq "too_slow" ? 0x4575B4 : \
    error < 1e-3 ? 0xFFE066 : error < 1 ? 0xFDAE61 : 0xD7191C
shade = 'paint(stringcolumn("status"), column("error"))'
of(m) = stringcolumn("method") eq m

# Places on the axes: powers of ten, and room beyond for the limits 0, 1 and inf.
log_thickness(w) = w > 1e300 ? 10.4 : log10(w)
log_lost(albedo) = albedo >= 1 ? 16.4 : -log10(1 - albedo)
in_map(m) = of(m) && near("g", 0.5) && near("mu0", 0.6)

# Beams: a band a special mu0, which is known by its albedo and is its first row.
albedos = "0.7 0.8 0.85 0.4 0.5"
names = "'Gauss node' 'resonance of 16' 'resonance of 32' 'of Eddington' 'of hemispheric'"
thicknesses = "0.000001 0.001 0.1 1 10 1000"
place(albedo) = sum [i = 1:words(albedos)] \
    (abs(real(word(albedos, i)) - albedo) < 1e-9 ? i : 0)
array middle[5]
do for [i = 1:5] { middle[i] = 0 }
is_beam = 'place(column("albedo")) > 0 && column("mu0") != 0.6'
keep(i) = middle[i] == 0 ? (middle[i] = column("mu0"), 1) : 1
stats csv using (@is_beam ? keep(place(column("albedo"))) : 1) nooutput
offset(i) = abs(column("mu0") / middle[i] - 1)
log_offset(i) = offset(i) < 3e-15 ? -16.5 : floor(log10(offset(i)) + 0.5)
rank(w) = w > 1e300 ? 7 : sum [i = 1:words(thicknesses)] \
    (real(word(thicknesses, i)) <= w * (1 + 1e-9) ? 1 : 0)
band(i) = 8.5 * (words(albedos) - i)

wide = 172; edge = 150; map = 230; beams = 330; gap = 44; head = 108; foot = 12
high_bank = map + beams + 3 * gap

# A long name on two lines.
broken(name) = strlen(name) < 18 ? name : \
    name[1:strstrt(name, "-")]."\n".name[strstrt(name, "-")+1:*]
w = edge + columns * wide + 10
h = head + banks * high_bank + foot
set terminal pngcairo enhanced font "DejaVu Sans,11" linewidth 1.2 background rgb "white" \
    size w,h
set output png
set multiplot
unset key
set tics scale 0.4
set style fill solid 1.0 noborder
set label 1 at screen 0.5,1-18.0/h center font ",16" \
    "Where methods hold and where they fail"
set label 2 at screen 0.5,1-42.0/h center \
    "Above: albedo and thickness, g = 0.5, μ_0 = 0.6.   Below: beams on and beside special μ_0; in each band thickness 10^{-6} (bottom), 10^{-3}, 0.1, 1, 10, 10^3, ∞ (top)."

# Edges of a panel, in pixels from the top left.
panel = 'set lmargin at screen (edge+x*wide+3.0)/w; set rmargin at screen (edge+(x+1)*wide-3.0)/w; set tmargin at screen 1-y/(1.0*h); set bmargin at screen 1-(y+high)/(1.0*h)'

do for [m = 1:words(methods)] {
    name = word(methods, m)
    x = (m - 1) % columns
    bank = (m - 1) / columns
    y = head + bank * high_bank + gap
    high = map
    @panel
    set title broken(name) offset 0,-0.7 font (strlen(name) > 28 ? ",9" : ",11")
    set xrange [-9.5:10.9]
    set yrange [-0.5:16.9]
    set xtics ("10^{-6}" -6, "1" 0, "10^6" 6, "∞" 10.4)
    if (x == 0) {
        set ytics ("0" 0, "0.9" 1, "1−10^{-3}" 3, "1−10^{-6}" 6, "1−10^{-9}" 9, \
            "1−10^{-12}" 12, "1−10^{-15}" 15, "1" 16.4)
        set ylabel "albedo" offset -1,0
    } else {
        set ytics ("" 0); set ylabel ""
    }
    set xlabel (x == 0 ? "thickness" : "") offset 0,0.5
    plot csv using (in_map(name) ? log_thickness(column("thickness")) : NaN): \
        (log_lost(column("albedo"))):(0.5):(0.5):(@shade) \
        with boxxyerror linecolor rgb variable
    unset label 1; unset label 2

    y = y + map + gap
    high = beams
    @panel
    set title ""
    set xrange [-17.5:-2.9]
    set yrange [0:8.5*words(albedos)]
    set xtics ("on" -16.5, "10^{-12}" -12, "10^{-8}" -8, "10^{-4}" -4)
    set ytics ("" 0)
    set xlabel (x == 0 ? "distance / μ_0" : "") offset 0,0.5
    set ylabel ""
    do for [i = 1:words(albedos)] {
        if (x == 0) {
            set label 10+i word(names, i) at graph -0.05,first band(i)+4.2 right
        } else {
            unset label 10+i
        }
    }
    plot for [i = 1:words(albedos)] csv using \
        (of(name) && @is_beam && place(column("albedo")) == i ? log_offset(i) : NaN): \
        (band(i) + rank(column("thickness"))):(1):(0.5):(@shade) \
        with boxxyerror linecolor rgb variable
    do for [i = 1:words(albedos)] { unset label 10+i }
}

# The key, between the title and the maps.
@legend_below
set key center center horizontal font ",11" samplen 1 width 0 maxrows 1
set tmargin at screen 1-58.0/h
set bmargin at screen 1-86.0/h
set pointsize 2.2
plot NaN with points pointtype 5 linecolor rgb 0x1A9641 title "right", \
    NaN with points pointtype 5 linecolor rgb 0xA6D96A title "right to 50 %", \
    NaN with points pointtype 5 linecolor rgb 0xFFE066 title "wrong < 10^{-3}", \
    NaN with points pointtype 5 linecolor rgb 0xFDAE61 title "wrong < 1", \
    NaN with points pointtype 5 linecolor rgb 0xD7191C title "wrong > 1", \
    NaN with points pointtype 5 linecolor rgb 0x7B3294 title "negative", \
    NaN with points pointtype 5 linecolor rgb 0x000000 title "not finite", \
    NaN with points pointtype 5 linecolor rgb 0x4575B4 title "over 10 s", \
    NaN with points pointtype 5 linecolor rgb 0xC8C8C8 title "refused"
unset multiplot
