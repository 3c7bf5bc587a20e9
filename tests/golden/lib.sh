# Shared by the golden tests and scripts/approve-goldens. Needs pprt-render on the PATH.

readonly golden_units=150000000  # work units for the whole picture, shared by the ranks
readonly golden_threshold=0.05   # error above which a pixel counts for the share

# golden_picture SCENE RANKS OUT
golden_picture() {
  local folder
  folder=$(mktemp -d)
  pprt-render "$1" -np "$2" -s 160x120 --clock work --fps 1 --budget $((golden_units / $2)) --progress none \
    -o "$folder/picture.png"
  mv "$folder/picture.png" "$3"
  rm -r "$folder"
}

# golden_name SCENE: "tree" for "spd:tree:6".
golden_name() { local rest=${1#spd:}; echo "${rest%%:*}"; }

# Layers with approved pictures, each with the largest RMSE and the largest share of pixels with an error above 0.05.
# The tolerances are 1.5 times what another --seed causes.
readonly golden_layer_scene=spd:gears:2
golden_layers() { printf '%s\n' "cost 0.0145 0.0105" "regions 0.0025 0.0005"; }

# golden_layer_picture LAYER RANKS OUT [OPTION...]: renders without balancing, because balancing uses measured times.
golden_layer_picture() {
  local folder
  folder=$(mktemp -d)
  pprt-render "$golden_layer_scene" -np "$2" -s 160x120 --clock work --fps 1 --budget $((golden_units / $2)) \
    --balance none --progress none --layers "$1" -o "$folder/picture.png" "${@:4}" </dev/null  # which mpirun would read to its end
  mv "$folder/picture.$1.png" "$3"
  rm -r "$folder"
}
