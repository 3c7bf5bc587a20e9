# What the golden tests and scripts/approve-goldens share. Needs pprt-render on the PATH.

readonly golden_units=150000000  # of counted work for the whole picture, however many ranks share it
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
