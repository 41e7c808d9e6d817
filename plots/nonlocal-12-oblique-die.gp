# Draws 'nonlocal-12-oblique-die.svg'; run it in its own folder.
if (!exists("output")) output = 'nonlocal-12-oblique-die.svg'
data = 'nonlocal-12-oblique-die.dat'

set encoding utf8
set terminal svg enhanced size 643,476 font 'Helvetica,13' background 'white'
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
set bmargin at screen 0.6310; set tmargin at screen 0.9524
set xrange [0:0.46]; set xtics 0.1
set yrange [0:0.446925]; set ytics 0.1
set xlabel 'Displacement {/:Italic γ} / 2{/:Italic R}'
set label 1 '(a)' at graph 0.02, 1.06 left
set label 2 'Force {/:Italic P} / (π {/:Italic R}^2 {/:Italic E})' at screen 0.0235, 0.7917 center rotate by 90
set label 3 '' at graph 0.98, 1.06 right
plot data index 'panel 1 series 1.' with lines lc rgb '#56B4E9' lw 1.8 dt (7,4), \
  data index 'panel 1 series 2.' with lines lc rgb '#E69F00' lw 1.8 dt 1, \
  data index 'panel 1 series 3.' with lines lc rgb '#0072B2' lw 1.8 dt 1, \
  data index 'panel 1 series 4.' with lines lc rgb '#D55E00' lw 1.8 dt 1, \
  data index 'panel 1 series 5.' with lines lc rgb '#009E73' lw 1.8 dt 1, \
  data index 'panel 1 series 6.' with lines lc rgb '#E69F00' lw 1.8 dt (7,3,1.5,3), \
  data index 'panel 1 series 7.' with lines lc rgb '#009E73' lw 1.8 dt (7,3,1.5,3), \
  data index 'panel 1 series 8.' with lines lc rgb '#E69F00' lw 1.8 dt (7,4), \
  data index 'panel 1 series 9.' with lines lc rgb '#009E73' lw 1.8 dt (7,4), \
  data index 'panel 1 series 10.' with lines lc rgb '#E69F00' lw 1.8 dt (2,4), \
  data index 'panel 1 series 11.' with lines lc rgb '#009E73' lw 1.8 dt (2,4), \
  data index 'panel 1 series 12.' with points pt 6 ps 0.5 lw 1 lc rgb '#009E73', \
  data index 'panel 1 series 13.' with points pt 4 ps 0.5 lw 1 lc rgb '#009E73'

unset logscale; set format '%g'
set lmargin at screen 0.6294; set rmargin at screen 0.9735
set bmargin at screen 0.6310; set tmargin at screen 0.9524
set xrange [0:0.46]; set xtics 0.1
set yrange [0:1.03457]; set ytics 0.5
set xlabel 'Displacement {/:Italic γ} / 2{/:Italic R}'
set label 1 '(b)' at graph 0.02, 1.06 left
set label 2 'Contact radius {/:Italic a}'' / {/:Italic R}' at screen 0.5235, 0.7917 center rotate by 90
set label 3 '' at graph 0.98, 1.06 right
plot data index 'panel 2 series 1.' with lines lc rgb '#56B4E9' lw 1.8 dt (7,4), \
  data index 'panel 2 series 2.' with lines lc rgb '#E69F00' lw 1.8 dt 1, \
  data index 'panel 2 series 3.' with lines lc rgb '#0072B2' lw 1.8 dt 1, \
  data index 'panel 2 series 4.' with lines lc rgb '#D55E00' lw 1.8 dt 1, \
  data index 'panel 2 series 5.' with lines lc rgb '#009E73' lw 1.8 dt 1, \
  data index 'panel 2 series 6.' with lines lc rgb '#E69F00' lw 1.8 dt (7,3,1.5,3), \
  data index 'panel 2 series 7.' with lines lc rgb '#009E73' lw 1.8 dt (7,3,1.5,3), \
  data index 'panel 2 series 8.' with lines lc rgb '#E69F00' lw 1.8 dt (7,4), \
  data index 'panel 2 series 9.' with lines lc rgb '#009E73' lw 1.8 dt (7,4), \
  data index 'panel 2 series 10.' with lines lc rgb '#E69F00' lw 1.8 dt (2,4), \
  data index 'panel 2 series 11.' with lines lc rgb '#009E73' lw 1.8 dt (2,4), \
  data index 'panel 2 series 12.' with points pt 6 ps 0.5 lw 1 lc rgb '#009E73', \
  data index 'panel 2 series 13.' with points pt 4 ps 0.5 lw 1 lc rgb '#009E73'
unset logscale

# The legend: empty plots that show nothing but a key, each in its place; a terminal's own spacing of several
# lines in one key would not be that of the headings.
unset border; unset tics; unset xlabel; unset label
set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 0
set label 1 'Curve' at screen 0.0176, 0.4802 left
set key at screen 0.1176, 0.5000 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#56B4E9' lw 1.8 dt (7,4) title 'Hertz'
unset label 1
set key at screen 0.1176, 0.4603 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#E69F00' lw 1.8 dt 1 title 'one term, uncorrected, axial'
set key at screen 0.1176, 0.4206 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#0072B2' lw 1.8 dt 1 title '2 terms, axial'
set key at screen 0.1176, 0.3810 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#D55E00' lw 1.8 dt 1 title '3 terms, axial'
set key at screen 0.1176, 0.3413 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#009E73' lw 1.8 dt 1 title '4 terms, axial'
set key at screen 0.1176, 0.3016 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#E69F00' lw 1.8 dt (7,3,1.5,3) title 'one term, uncorrected, lateral-x'
set key at screen 0.1176, 0.2619 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#009E73' lw 1.8 dt (7,3,1.5,3) title '4 terms, lateral-x'
set key at screen 0.1176, 0.2222 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#E69F00' lw 1.8 dt (7,4) title 'one term, uncorrected, lateral-y'
set key at screen 0.1176, 0.1825 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#009E73' lw 1.8 dt (7,4) title '4 terms, lateral-y'
set key at screen 0.1176, 0.1429 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#E69F00' lw 1.8 dt (2,4) title 'one term, uncorrected, oblique'
set key at screen 0.1176, 0.1032 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#009E73' lw 1.8 dt (2,4) title '4 terms, oblique'
set label 1 'Points' at screen 0.0176, 0.0437 left
set key at screen 0.1176, 0.0635 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with points pt 6 ps 0.5 lw 1 lc rgb '#009E73' title 'impingement, axial'
unset label 1
set key at screen 0.4576, 0.0635 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with points pt 4 ps 0.5 lw 1 lc rgb '#009E73' title 'impingement, lateral-y'
unset multiplot
unset output
