# Draws './cel.svg'. To be run in its own folder, as gnuplot ./NAME.gp
if (!exists("output")) output = './cel.svg'
data = './cel.dat'

set encoding utf8
set minussign
set terminal svg enhanced size 643,465 font 'Helvetica,Arial,sans-serif,13' background 'white'
set output output
set border 3 lw 0.8
set tics nomirror out scale 0.6
set xtics offset 0, 0.3
set format '%g'
set xlabel offset 0, 0.5
unset key
set multiplot

set lmargin at screen 0.1294; set rmargin at screen 0.4735
set bmargin at screen 0.6220; set tmargin at screen 0.9512
set xrange [0:0.4326]; set xtics 0.1
set yrange [0:0.200155]; set ytics 0.05
set xlabel 'Displacement {/:Italic δ}_o / {/:Italic R}_0{/=1   }'
set label 1 '(a)' at graph 0.02, 1.06 left
set label 2 'Force {/:Italic F} / ({/:Italic E R}_0^2){/=1   }' at screen 0.0235, 0.7866 center rotate by 90
unset label 3
unset label 4
plot data index 'run 1 axial loading' using 1:2 with lines lc rgb '#0072B2' lw 2 dt 1, \
  data index 'run 1 axial unloading' using 1:2 with lines lc rgb '#0072B2' lw 2 dt (7,4), \
  data index 'run 1 axial reloading' using 1:2 with lines lc rgb '#0072B2' lw 4.4 dt (0.8,2.6), \
  data index 'run 1 lateral loading' using 1:2 with linespoints lc rgb '#D55E00' lw 2 dt 1 pt 7 ps 0.45 pn 7, \
  data index 'run 1 lateral unloading' using 1:2 with linespoints lc rgb '#D55E00' lw 2 dt (7,4) pt 7 ps 0.45 pn 7, \
  data index 'run 1 lateral reloading' using 1:2 with lines lc rgb '#D55E00' lw 4.4 dt (0.8,2.6), \
  data index 'event yield.' using 1:2 with points pt 6 ps 0.9 lw 1.1 lc rgb '#000000', \
  data index 'event load-reversal.' using 1:2 with points pt 4 ps 0.9 lw 1.1 lc rgb '#000000'

set lmargin at screen 0.6294; set rmargin at screen 0.9735
set bmargin at screen 0.6220; set tmargin at screen 0.9512
set xrange [0:0.4326]; set xtics 0.1
set yrange [0:1.93487]; set ytics 0.5
set xlabel 'Displacement {/:Italic δ}_o / {/:Italic R}_0{/=1   }'
set label 1 '(b)' at graph 0.02, 1.06 left
set label 2 'Mean pressure {/:Italic p} / {/:Italic Y}{/=1   }' at screen 0.5235, 0.7866 center rotate by 90
unset label 3
unset label 4
plot data index 'run 1 axial loading' using 1:3 with lines lc rgb '#0072B2' lw 2 dt 1, \
  data index 'run 1 axial unloading' using 1:3 with lines lc rgb '#0072B2' lw 2 dt (7,4), \
  data index 'run 1 axial reloading' using 1:3 with lines lc rgb '#0072B2' lw 4.4 dt (0.8,2.6), \
  data index 'run 1 lateral loading' using 1:3 with linespoints lc rgb '#D55E00' lw 2 dt 1 pt 7 ps 0.45 pn 7, \
  data index 'run 1 lateral unloading' using 1:3 with linespoints lc rgb '#D55E00' lw 2 dt (7,4) pt 7 ps 0.45 pn 7, \
  data index 'run 1 lateral reloading' using 1:3 with lines lc rgb '#D55E00' lw 4.4 dt (0.8,2.6), \
  data index 'event yield.' using 1:3 with points pt 6 ps 0.9 lw 1.1 lc rgb '#000000', \
  data index 'event load-reversal.' using 1:3 with points pt 4 ps 0.9 lw 1.1 lc rgb '#000000'

set lmargin at screen 0.1294; set rmargin at screen 0.4735
set bmargin at screen 0.1341; set tmargin at screen 0.4634
set xrange [0:0.4326]; set xtics 0.1
set yrange [0:0.805101]; set ytics 0.2
set xlabel 'Displacement {/:Italic δ}_o / {/:Italic R}_0{/=1   }'
set label 1 '(c)' at graph 0.02, 1.06 left
set label 2 'Contact area {/:Italic A}_c / (π{/:Italic R}_0^2){/=1   }' at screen 0.0235, 0.2988 center rotate by 90
unset label 3
unset label 4
plot data index 'run 1 axial loading' using 1:4 with lines lc rgb '#0072B2' lw 2 dt 1, \
  data index 'run 1 axial unloading' using 1:4 with lines lc rgb '#0072B2' lw 2 dt (7,4), \
  data index 'run 1 axial reloading' using 1:4 with lines lc rgb '#0072B2' lw 4.4 dt (0.8,2.6), \
  data index 'run 1 lateral loading' using 1:4 with linespoints lc rgb '#D55E00' lw 2 dt 1 pt 7 ps 0.45 pn 7, \
  data index 'run 1 lateral unloading' using 1:4 with linespoints lc rgb '#D55E00' lw 2 dt (7,4) pt 7 ps 0.45 pn 7, \
  data index 'run 1 lateral reloading' using 1:4 with lines lc rgb '#D55E00' lw 4.4 dt (0.8,2.6), \
  data index 'event yield.' using 1:4 with points pt 6 ps 0.9 lw 1.1 lc rgb '#000000', \
  data index 'event load-reversal.' using 1:4 with points pt 4 ps 0.9 lw 1.1 lc rgb '#000000'

# The legend: empty plots that show nothing but a key, each in its place; a terminal's own spacing of several
# lines in one key would not be that of the headings.
unset border; unset tics; unset xlabel; unset label
set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 0
set label 1 'Contact' at screen 0.5176, 0.4431 left
set key at screen 0.6176, 0.4634 left top horizontal Left reverse enhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#0072B2' lw 2 dt 1 title 'axial'
unset label 1
set key at screen 0.7967, 0.4634 left top horizontal Left reverse enhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with linespoints lc rgb '#D55E00' lw 2 dt 1 pt 7 ps 0.45 pn 7 title 'lateral'
set label 1 'Path' at screen 0.5176, 0.4024 left
set key at screen 0.6176, 0.4228 left top horizontal Left reverse enhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#303030' lw 2 dt 1 title 'loading'
unset label 1
set key at screen 0.6176, 0.3821 left top horizontal Left reverse enhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#303030' lw 2 dt (7,4) title 'unloading'
set key at screen 0.6176, 0.3415 left top horizontal Left reverse enhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with lines lc rgb '#303030' lw 4.4 dt (0.8,2.6) title 'reloading'
set label 1 'Events' at screen 0.5176, 0.2805 left
set key at screen 0.6176, 0.3008 left top horizontal Left reverse enhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with points pt 6 ps 0.9 lw 1.1 lc rgb '#000000' title 'yield'
unset label 1
set key at screen 0.6176, 0.2602 left top horizontal Left reverse enhanced spacing 1.2 samplen 2.5 noautotitle
plot [0:1] [0:1] NaN, keyentry with points pt 4 ps 0.9 lw 1.1 lc rgb '#000000' title 'load-reversal'
unset multiplot
unset output
