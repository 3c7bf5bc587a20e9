# Draws film/ledger.png from film/ledger.ndjson: when frames were ready, their samples, and how fine they are.
figure(name) = "< sed -n 's/.*\"frame\":\\([0-9]*\\),.*\"".name."\":\\([-0-9.e]*\\)[,}].*/\\1 \\2/p' film/ledger.ndjson"
set terminal pngcairo size 800, 700 font "sans,10"
set output "film/ledger.png"
set multiplot layout 3, 1
set grid
unset key
set title "ready, milliseconds before the deadline"
plot figure("late_ms") using 1:(-$2) with impulses linewidth 3, 0 linecolor rgb "red" linewidth 2
set title "samples, new and carried"
set yrange [0:*]
set key bottom right
plot figure("samples_new") with lines linewidth 2 title "new", \
     figure("samples_cast") with lines linewidth 2 title "carried"
set title "mean weight of what is left to refine: smaller is finer"
set xlabel "frame"
unset key
plot figure("mean_weight") with lines linewidth 2
