#!/usr/bin/env bash
# layout.sh SOURCE_DIR: the rooms as docs/architecture.md tells them. Which module may include which; each
# third-party library in one module (those for options, records and logs in the programs'), in headers that no other
# module includes (Imath's vectors and fmt are everyone's); no file over 500 lines, no
# room over 30 files, no main over 40; no test that CTest cannot run.
set -euo pipefail
cd "$1"
failures=0
complain() { echo "$1"; failures=$((failures + 1)); }

declare -A allowed=(
  [base]="base" [scene]="base scene" [spd]="base scene spd" [parser]="base scene parser" [trace]="base scene trace"
  [image]="base image" [pipeline]="base pipeline" [layers]="base image pipeline layers"
  [parallel]="base image pipeline parallel" [live]="base image scene live" [cli]="base scene spd parser image cli"
  [render]="base scene spd parser trace image pipeline layers live parallel cli render"
  [convert]="base scene spd parser image cli convert" [compare]="base image cli compare"
  [study]="base scene spd parser trace image pipeline layers parallel cli convert study")
# Single headers of other rooms.
declare -A besides=([render]="convert/model_scene.h convert/default_view.h" [study]="render/trace/balance_trace.h render/records/frame_summary.h")
# Rooms within a module, and which others of it each may include: only such as stand above it here, so that there is no
# circle. Files beside the rooms may include them all.
declare -A within
for line in \
  "base/system:" \
  "parser/text:" \
  "parser/anim: parser/text" \
  "trace/geometry:" \
  "trace/textures: trace/geometry" \
  "trace/survey: trace/geometry" \
  "pipeline/core:" \
  "pipeline/silhouettes: pipeline/core" \
  "pipeline/casting: pipeline/core" \
  "pipeline/sampling: pipeline/core pipeline/casting" \
  "pipeline/visibility: pipeline/core pipeline/silhouettes" \
  "pipeline/mesh: pipeline/core pipeline/silhouettes pipeline/casting pipeline/sampling" \
  "pipeline/lattice: pipeline/core pipeline/silhouettes pipeline/visibility pipeline/casting pipeline/sampling" \
  "parallel/network:" \
  "parallel/settings: parallel/network" \
  "parallel/protocol: parallel/network" \
  "parallel/clock: parallel/settings parallel/protocol" \
  "parallel/balance: parallel/settings parallel/protocol" \
  "parallel/exchange: parallel/settings parallel/balance" \
  "parallel/rank: parallel/network parallel/settings parallel/protocol parallel/clock parallel/balance parallel/exchange" \
  "parallel/master: parallel/network parallel/settings parallel/protocol parallel/clock parallel/balance parallel/exchange" \
  "scene/movement:" \
  "scene/description: scene/movement" \
  "scene/animation: scene/description scene/movement" \
  "scene/polygons:" \
  "scene/bytes: scene/description scene/movement" \
  "scene/writers: scene/description scene/animation" \
  "cli/process:" \
  "cli/options: cli/process" \
  "cli/scenes:" \
  "convert/names:" \
  "convert/surfaces:" \
  "convert/pov: convert/names" \
  "convert/model:" \
  "convert/gltf: convert/model" \
  "convert/mesh: convert/names convert/surfaces convert/pov convert/model convert/gltf" \
  "render/records:" \
  "render/options: render/records" \
  "render/plan: render/options" \
  "render/trace: render/records" \
  "render/output: render/records render/plan render/trace" \
  "render/run: render/records render/plan render/output"; do
  within[${line%%:*}]=${line#*:}
  for lower in ${line#*:}; do
    [[ -n ${within[$lower]+known} ]] || complain "layout.sh: $lower does not stand before ${line%%:*}"
  done
done
# The triangulation is known to its exchange, to the layers that draw it and to the study of the paper.
mesh_users='^src/(pipeline/mesh|parallel/exchange|layers|study)/'
declare -A home=(
  [embree3]=trace [embree4]=trace [CGAL]=pipeline [mpi.h]=parallel [tao]=parser [assimp]=convert [tiny_gltf.h]=convert [OpenEXR]=image [png.h]=image [boost]=live
  [CLI]="cli render convert compare study" [nlohmann]="cli live render convert compare study" [spdlog]="cli render")

seen=0
includes=$(grep -roE '^#include ["<][^">]+[">]' src --include='*.h' --include='*.cpp')
while IFS=: read -r file include; do
  module=${file#src/} module=${module%%/*}
  [[ -n ${allowed[$module]:-} ]] || { complain "$file: src/$module is no room"; continue; }
  name=${include#*[\"<]} name=${name%%[\">]*} first=${name%%/*}
  seen=$((seen + 1))
  if [[ $include == *\"* ]]; then
    [[ " ${allowed[$module]} ${besides[$module]:-} " == *" $first "* || " ${besides[$module]:-} " == *" $name "* ]] ||
      complain "$file: $module may not include $name"
    stage=${file#src/} stage=${stage%/*}
    if [[ $first == "$module" && $stage != "$module" && " ${!within[*]} " == *" $module/"* ]]; then
      [[ " $stage ${within[$stage]-} " == *" ${name%/*} "* ]] || complain "$file: $stage may not include $name"
    fi
    [[ $name != pipeline/mesh/* || $file =~ $mesh_users ]] || complain "$file: may not include $name"
  elif [[ -n ${home[$first]:-} ]]; then
    [[ " ${home[$first]} " == *" $module "* ]] || complain "$file: <$name> belongs to ${home[$first]}"
  elif [[ $first != Imath && $first != fmt && $name =~ / && ! $name =~ ^(sys|net|netinet|arpa)/ ]]; then
    complain "$file: <$name> belongs to no room"
  fi
  if [[ $include == *'<'* && $file == *.h ]] && [[ -n ${home[$first]:-} || $first == fmt ]]; then
    # shellcheck disable=SC2086 # one word a module
    inside=$(printf '^src/%s/|' ${home[$first]:-$module})
    outside=$(grep -F ":#include \"${file#src/}\"" <<<"$includes" | cut -d: -f1 | grep -vE "${inside%|}" || true)
    [[ -z $outside ]] || complain "$file: shows <$name> to $outside"
  fi
done <<<"$includes"
[[ $seen -gt 100 ]] || complain "only $seen includes were found in $PWD/src"

while read -r lines file; do
  [[ $file == total || $lines -le 500 ]] || complain "$file: has $lines lines, more than 500"
done < <(find src tests bench -name '*.h' -o -name '*.cpp' | xargs wc -l)
while read -r room; do
  files=$(find "$room" -maxdepth 1 -type f -not -name CMakeLists.txt | wc -l)
  [[ $files -le 30 ]] || complain "$room: has $files files, more than 30"
done < <(find src -type d)
for file in src/*/*_main.cpp; do
  lines=$(awk '/^int main/ { inside = 1 } inside { ++n } inside && /^}/ { exit } END { print n }' "$file")
  [[ $lines -le 40 ]] || complain "$file: main has $lines lines, more than 40"
done
# CTest takes a name with ';' for two, and names between '[' and ']' for one; Catch2 2 has no such tests, and calls that a
# success. A name that begins with '-' is an option to it.
while read -r name; do complain "$name: a test of such a name is never run"; done \
  < <(grep -rhoPz 'TEST_CASE\(\s*"(-|[^"]*[];[])[^"]*"' tests --include='*.cpp' | tr '\n\0' ' \n')
[[ $failures -eq 0 ]]
