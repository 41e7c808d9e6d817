# Draws 'nonlocal-10-die.svg'; run it in its own folder.
if (!exists("output")) output = 'nonlocal-10-die.svg'
data = 'nonlocal-10-die.dat'

set encoding utf8
set terminal svg enhanced size 643,363 font 'Helvetica,13' background 'white'
set output output
set border 3 lw 0.8
set tics nomirror out scale 0.6
set xtics offset 0, 0.3
set format '%g'
set xlabel offset 0, 0.5
unset key
set multiplot

unset logscale; set format '%g'
set lmargin at screen 0.1294; set rmargin at screen 0.4735
set bmargin at screen 0.5156; set tmargin at screen 0.9375
set xrange [0:0.47]; set xtics 0.1
set yrange [0:0.582872]; set ytics 0.2
set xlabel 'Displacement {/:Italic γ} / 2{/:Italic R}'
set label 1 '(a)' at graph 0.02, 1.06 left
set label 2 'Force {/:Italic P} / (π {/:Italic R}^2 {/:Italic E})' at screen 0.0235, 0.7266 center rotate by 90
set label 3 '' at graph 0.98, 1.06 right
plot data index 'panel 1 series 1.' with lines lc rgb '#56B4E9' lw 1.8 dt (7,4), \
  data index 'panel 1 series 2.' with lines lc rgb '#E69F00' lw 1.8 dt 1, \
  data index 'panel 1 series 3.' with lines lc rgb '#0072B2' lw 1.8 dt 1, \
  data index 'panel 1 series 4.' with lines lc rgb '#D55E00' lw 1.8 dt 1, \
  data index 'panel 1 series 5.' with lines lc rgb '#009E73' lw 1.8 dt 1, \
  data index 'panel 1 series 6.' with lines lc rgb '#E69F00' lw 1.8 dt (7,3,1.5,3), \
  data index 'panel 1 series 7.' with lines lc rgb '#009E73' lw 1.8 dt (7,3,1.5,3), \
  data index 'panel 1 series 8.' with points pt 6 ps 0.5 lw 1 lc rgb '#009E73', \
  data index 'panel 1 series 9.' with points pt 4 ps 0.5 lw 1 lc rgb '#CC79A7', \
  data index 'panel 1 series 10.' with points pt 8 ps 0.5 lw 1 lc rgb '#CC79A7'

unset logscale; set format '%g'
set lmargin at screen 0.6294; set rmargin at screen 0.9735
set bmargin at screen 0.5156; set tmargin at screen 0.9375
set xrange [0:0.47]; set xtics 0.1
set yrange [0:1.0557]; set ytics 0.5
set xlabel 'Displacement {/:Italic γ} / 2{/:Italic R}'
set label 1 '(b)' at graph 0.02, 1.06 left
set label 2 'Contact radius {/:Italic a}'' / {/:Italic R}' at screen 0.5235, 0.7266 center rotate by 90
set label 3 '' at graph 0.98, 1.06 right
plot data index 'panel 2 series 1.' with lines lc rgb '#56B4E9' lw 1.8 dt (7,4), \
  data index 'panel 2 series 2.' with lines lc rgb '#E69F00' lw 1.8 dt 1, \
  data index 'panel 2 series 3.' with lines lc rgb '#0072B2' lw 1.8 dt 1, \
  data index 'panel 2 series 4.' with lines lc rgb '#D55E00' lw 1.8 dt 1, \
  data index 'panel 2 series 5.' with lines lc rgb '#009E73' lw 1.8 dt 1, \
  data index 'panel 2 series 6.' with lines lc rgb '#E69F00' lw 1.8 dt (7,3,1.5,3), \
  data index 'panel 2 series 7.' with lines lc rgb '#009E73' lw 1.8 dt (7,3,1.5,3), \
  data index 'panel 2 series 8.' with points pt 6 ps 0.5 lw 1 lc rgb '#009E73', \
  data index 'panel 2 series 9.' with points pt 4 ps 0.5 lw 1 lc rgb '#CC79A7', \
  data index 'panel 2 series 10.' with points pt 8 ps 0.5 lw 1 lc rgb '#CC79A7'
unset logscale

# The legend: empty plots that show nothing but a key, each in its place; a terminal's own spacing of several
# lines in one key would not be that of the headings.
unset border; unset tics; unset xlabel; unset label
set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 0
set label 1 'Curve' at screen 0.0176, 0.3177 left
set key at screen 0.1176, 0.3438 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#56B4E9' lw 1.8 dt (7,4) title 'Hertz'
unset label 1
set key at screen 0.5471, 0.3438 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#E69F00' lw 1.8 dt 1 title 'one term, uncorrected, axial'
set key at screen 0.1176, 0.2917 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#0072B2' lw 1.8 dt 1 title '2 terms, axial'
set key at screen 0.5471, 0.2917 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#D55E00' lw 1.8 dt 1 title '3 terms, axial'
set key at screen 0.1176, 0.2396 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#009E73' lw 1.8 dt 1 title '4 terms, axial'
set key at screen 0.5471, 0.2396 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#E69F00' lw 1.8 dt (7,3,1.5,3) title 'one term, uncorrected, lateral'
set key at screen 0.1176, 0.1875 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#009E73' lw 1.8 dt (7,3,1.5,3) title '4 terms, lateral'
set label 1 'Points' at screen 0.0176, 0.1094 left
set key at screen 0.1176, 0.1354 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with points pt 6 ps 0.5 lw 1 lc rgb '#009E73' title 'impingement, axial'
unset label 1
set key at screen 0.4800, 0.1354 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with points pt 4 ps 0.5 lw 1 lc rgb '#CC79A7' title 'finite elements, axial'
set key at screen 0.1176, 0.0833 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with points pt 8 ps 0.5 lw 1 lc rgb '#CC79A7' title 'finite elements, lateral'
unset multiplot
unset output
