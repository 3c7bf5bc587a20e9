# Draws film/ledger.png from film/ledger.ndjson: when frames were ready and how wrong they are, their samples, and how
# fine they are.
figure(name) = "< sed -n 's/.*\"frame\":\\([0-9]*\\),.*\"".name."\":\\([-0-9.e]*\\)[,}].*/\\1 \\2/p' film/ledger.ndjson"
# Frames up to which too few rays have measured the error have none, and are left out.
error = "< sed -n 's/.*\"frame\":\\([0-9]*\\),.*\"shot\":{\"rmse\":\\([-0-9.e]*\\),\"low\":\\([-0-9.e]*\\),\"high\":\\([-0-9.e]*\\)[,}].*/\\1 \\2 \\3 \\4/p' film/ledger.ndjson"
set terminal pngcairo size 800, 700 font "sans,10"
set output "film/ledger.png"
set multiplot layout 3, 1
set grid
# One scale of frames for all three, with room at the right for the keys.
set lmargin 8
set rmargin 18
set autoscale xfixmax
set key outside right top samplen 2
set title "ready, milliseconds before the deadline; right: measured RMSE of the shot so far, and its 95 % interval"
set ytics nomirror
set y2tics
set y2range [0:*]
set style fill transparent solid 0.25 noborder
plot figure("late_ms") using 1:(-$2) with impulses linewidth 3 title "ready", \
     0 linecolor rgb "red" linewidth 2 notitle, \
     error using 1:3:4 axes x1y2 with filledcurves linecolor rgb "orange" notitle, \
     error using 1:2 axes x1y2 with lines linewidth 2 linecolor rgb "dark-orange" title "RMSE"
unset y2tics
set ytics mirror
unset key
set title "samples, new and carried"
set yrange [0:*]
set key
plot figure("samples_new") with lines linewidth 2 title "new", \
     figure("samples_cast") with lines linewidth 2 title "carried"
set title "mean weight of what is left to refine: smaller is finer"
set xlabel "frame"
unset key
# 0 where a frame came too late for any sample: nothing is known of it.
plot figure("mean_weight") using 1:($2 > 0 ? $2 : NaN) with lines linewidth 2
