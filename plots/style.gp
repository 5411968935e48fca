# What every figure shares: the terminal, the CSV dialect, one colour a method.
#
# A figure is drawn from this folder:  gnuplot -c figure2.gp figure2.csv figure2.png

set encoding utf8
set datafile separator ','
set datafile columnheaders
set datafile missing NaN

# The colours of Okabe and Ito, which people with any colour vision tell apart, and Tol's
# muted ones for the many two-streams; dashes where curves lie on each other.
colour(method) = method eq "exact"       ? 0x000000 : \
                 method eq "spp"         ? 0xD55E00 : \
                 method eq "spp-printed" ? 0xE69F00 : \
                 method eq "spp-refined" ? 0x0072B2 : \
                 method eq "single"      ? 0xCC79A7 : \
                 method eq "hemispheric" ? 0x009E73 : \
                 method eq "eddington"   ? 0x56B4E9 : \
                 method eq "fourstream"  ? 0x882255 : \
                 method eq "spp-literal" ? 0xF0E442 : \
                 method eq "twostream-eddington"              ? 0x88CCEE : \
                 method eq "twostream-eddington-delta"        ? 0x332288 : \
                 method eq "twostream-quadrature"             ? 0xDDCC77 : \
                 method eq "twostream-quadrature-delta"       ? 0x999933 : \
                 method eq "twostream-hemispheric-mean"       ? 0x44AA99 : \
                 method eq "twostream-hemispheric-mean-delta" ? 0x117733 : \
                 method eq "twostream-pifm"                   ? 0xCC6677 : \
                 method eq "twostream-pifm-delta"             ? 0xAA4499 : \
                 method eq "adding"      ? 0x8C510A : \
                 method eq "rk"          ? 0x762A83 : \
                 method eq "rk-shooting" ? 0xB58BC9 : \
                 method eq "mc"          ? 0xCC0000 : \
                 method eq "auto"        ? 0x777777 : \
                 method eq "nanodisort"     ? 0x1F77B4 : \
                 method eq "PythonicDISORT" ? 0xBCBD22 : \
                 method eq "disortpp"       ? 0xFF7F0E : 0x999999
dash(method) = method eq "spp-printed" ? 4 : method eq "single" ? 3 : \
               method eq "hemispheric" ? 2 : method eq "spp-literal" ? 5 : 1

# The shape of a point: discs for closed forms, others for what can be turned finer, open
# for other people's programs.
symbol(method) = method eq "adding"      ? 5 : method eq "mc"   ? 9 : \
                 method eq "rk-shooting" ? 11 : method eq "rk"  ? 13 : \
                 method eq "auto"        ? 15 : \
                 method eq "nanodisort"     ? 4 : \
                 method eq "PythonicDISORT" ? 8 : \
                 method eq "disortpp"       ? 12 : 7

# canvas(width, height) in pixels, as a macro: `@canvas 1200,800`.
canvas = 'set terminal pngcairo enhanced font "DejaVu Sans,12" linewidth 1.4 background rgb "white" size'

set style line 100 linecolor rgb "#d0d0d0" linewidth 0.6
set border linecolor rgb "#606060"
set tics textcolor rgb "#303030"

# Rows of the CSV that belong to a curve; the others become NaN, that is, missing.
near(column_name, x) = abs(column(column_name) - x) <= 1e-9 * (1 + abs(x))

# In a multiplot: a last, empty plot along the lower edge that holds the legend.
legend_below = 'reset; set lmargin at screen 0; set rmargin at screen 1; set bmargin at screen 0; set tmargin at screen 0.07; unset border; unset tics; set xrange [0:1]; set yrange [0:1]; set key center center horizontal font ",13" samplen 3 width 1'
