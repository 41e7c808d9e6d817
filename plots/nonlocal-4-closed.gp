# Draws 'nonlocal-4-closed.svg'; run it in its own folder.
if (!exists("output")) output = 'nonlocal-4-closed.svg'
data = 'nonlocal-4-closed.dat'

set encoding utf8
set terminal svg enhanced size 643,465 font 'Helvetica,13' background 'white'
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
set bmargin at screen 0.6220; set tmargin at screen 0.9512
set xrange [0:180]; set xtics 50
set yrange [-0.15:0.1]; set ytics 0.05
set xlabel 'Angle {/:Italic θ} (degrees)'
set label 1 '(a)' at graph 0.02, 1.06 left
set label 2 '{/:Italic E R / m}^{NL}' at screen 0.0235, 0.7866 center rotate by 90
set label 3 'ν = 0.15' at graph 0.98, 1.06 right
plot data index 'panel 1 series 1.' with lines lc rgb '#0072B2' lw 1.8 dt 1, \
  data index 'panel 1 series 2.' with lines lc rgb '#0072B2' lw 1.8 dt (2,4), \
  data index 'panel 1 series 3.' with lines lc rgb '#0072B2' lw 1.8 dt (7,4), \
  data index 'panel 1 series 4.' with lines lc rgb '#D55E00' lw 1.8 dt 1, \
  data index 'panel 1 series 5.' with lines lc rgb '#D55E00' lw 1.8 dt (2,4), \
  data index 'panel 1 series 6.' with lines lc rgb '#D55E00' lw 1.8 dt (7,4), \
  data index 'panel 1 series 7.' with lines lc rgb '#009E73' lw 1.8 dt 1, \
  data index 'panel 1 series 8.' with lines lc rgb '#009E73' lw 1.8 dt (2,4), \
  data index 'panel 1 series 9.' with lines lc rgb '#009E73' lw 1.8 dt (7,4)

unset logscale; set format '%g'
set lmargin at screen 0.6294; set rmargin at screen 0.9735
set bmargin at screen 0.6220; set tmargin at screen 0.9512
set xrange [0:180]; set xtics 50
set yrange [-0.15:0.1]; set ytics 0.05
set xlabel 'Angle {/:Italic θ} (degrees)'
set label 1 '(b)' at graph 0.02, 1.06 left
set label 2 '{/:Italic E R / m}^{NL}' at screen 0.5235, 0.7866 center rotate by 90
set label 3 'ν = 0.3' at graph 0.98, 1.06 right
plot data index 'panel 2 series 1.' with lines lc rgb '#0072B2' lw 1.8 dt 1, \
  data index 'panel 2 series 2.' with lines lc rgb '#0072B2' lw 1.8 dt (2,4), \
  data index 'panel 2 series 3.' with lines lc rgb '#0072B2' lw 1.8 dt (7,4), \
  data index 'panel 2 series 4.' with lines lc rgb '#D55E00' lw 1.8 dt 1, \
  data index 'panel 2 series 5.' with lines lc rgb '#D55E00' lw 1.8 dt (2,4), \
  data index 'panel 2 series 6.' with lines lc rgb '#D55E00' lw 1.8 dt (7,4), \
  data index 'panel 2 series 7.' with lines lc rgb '#009E73' lw 1.8 dt 1, \
  data index 'panel 2 series 8.' with lines lc rgb '#009E73' lw 1.8 dt (2,4), \
  data index 'panel 2 series 9.' with lines lc rgb '#009E73' lw 1.8 dt (7,4)

unset logscale; set format '%g'
set lmargin at screen 0.1294; set rmargin at screen 0.4735
set bmargin at screen 0.1341; set tmargin at screen 0.4634
set xrange [0:180]; set xtics 50
set yrange [-0.15:0.1]; set ytics 0.05
set xlabel 'Angle {/:Italic θ} (degrees)'
set label 1 '(c)' at graph 0.02, 1.06 left
set label 2 '{/:Italic E R / m}^{NL}' at screen 0.0235, 0.2988 center rotate by 90
set label 3 'ν = 0.45' at graph 0.98, 1.06 right
plot data index 'panel 3 series 1.' with lines lc rgb '#0072B2' lw 1.8 dt 1, \
  data index 'panel 3 series 2.' with lines lc rgb '#0072B2' lw 1.8 dt (2,4), \
  data index 'panel 3 series 3.' with lines lc rgb '#0072B2' lw 1.8 dt (7,4), \
  data index 'panel 3 series 4.' with lines lc rgb '#D55E00' lw 1.8 dt 1, \
  data index 'panel 3 series 5.' with lines lc rgb '#D55E00' lw 1.8 dt (2,4), \
  data index 'panel 3 series 6.' with lines lc rgb '#D55E00' lw 1.8 dt (7,4), \
  data index 'panel 3 series 7.' with lines lc rgb '#009E73' lw 1.8 dt 1, \
  data index 'panel 3 series 8.' with lines lc rgb '#009E73' lw 1.8 dt (2,4), \
  data index 'panel 3 series 9.' with lines lc rgb '#009E73' lw 1.8 dt (7,4)
unset logscale

# The legend: empty plots that show nothing but a key, each in its place; a terminal's own spacing of several
# lines in one key would not be that of the headings.
unset border; unset tics; unset xlabel; unset label
set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 0
set label 1 'Curve' at screen 0.5176, 0.4431 left
set key at screen 0.6176, 0.4634 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#0072B2' lw 1.8 dt 1 title 'eq. 14, a/R = 0.25'
unset label 1
set key at screen 0.6176, 0.4228 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#0072B2' lw 1.8 dt (2,4) title 'eq. 8, a/R = 0.25'
set key at screen 0.6176, 0.3821 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#0072B2' lw 1.8 dt (7,4) title 'projected, a/R = 0.25'
set key at screen 0.6176, 0.3415 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#D55E00' lw 1.8 dt 1 title 'eq. 14, a/R = 0.5'
set key at screen 0.6176, 0.3008 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#D55E00' lw 1.8 dt (2,4) title 'eq. 8, a/R = 0.5'
set key at screen 0.6176, 0.2602 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#D55E00' lw 1.8 dt (7,4) title 'projected, a/R = 0.5'
set key at screen 0.6176, 0.2195 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#009E73' lw 1.8 dt 1 title 'eq. 14, a/R = 0.75'
set key at screen 0.6176, 0.1789 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#009E73' lw 1.8 dt (2,4) title 'eq. 8, a/R = 0.75'
set key at screen 0.6176, 0.1382 left top horizontal Left reverse noenhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#009E73' lw 1.8 dt (7,4) title 'projected, a/R = 0.75'
unset multiplot
unset output
