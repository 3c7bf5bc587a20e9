# Shared by the golden tests and scripts/approve-goldens. Needs pprt-render on the PATH.

golden_top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
readonly golden_units=150000000  # work units for the whole picture, shared by the ranks
readonly golden_threshold=0.05   # error above which a pixel counts for the share

# golden_picture SCENE RANKS OUT [OPTION...]: the scene's first frame.
golden_picture() {
  local folder
  folder=$(mktemp -d)
  pprt-render "$1" --frames 1 -np "$2" -s 160x120 --clock work --fps 1 --budget $((golden_units / $2)) --progress none \
    -o "$folder/picture.png" "${@:4}" </dev/null  # which mpirun would read to its end
  mv "$folder/picture.png" "$3"
  rm -r "$folder"
}

# golden_scenes: the lines of scenes.txt.
golden_scenes() { grep '^[a-z]' "$golden_top/tests/golden/scenes.txt"; }

# golden_source SCENE: as pprt-render finds it. Files are named from the top of the sources.
golden_source() { if [[ $1 == spd:* ]]; then echo "$1"; else echo "$golden_top/$1"; fi; }

# golden_name SCENE: "tree" for "spd:tree:6", "dusk" for "scenes/dusk.aff".
golden_name() { local rest=${1#spd:}; rest=${rest%%:*} rest=${rest##*/}; echo "${rest%.*}"; }

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
