#!/usr/bin/env bash
# What pprt-convert writes, pprt-render reads: every scene of the examples and of the tests, in every format in between.
source "$(dirname "$0")/check.sh"

written=0 seen=
for model in "$PPRT_SOURCE"/scenes/*.aff "$PPRT_SOURCE"/examples/*/*.nff "$PPRT_SOURCE"/tests/wild/*.nff spd:{tree,balls,gears,mount,rings,tetra,teapot,jacks,lattice}:1; do
  pprt-render --census "$model" &>/dev/null || continue  # some files of the tests show nothing, or are no scenes
  run pprt-convert "$model" there.aff; expect_code 0
  # Many files of the tests are one scene in other words; from there on all is the same.
  scene=$(sha256sum <there.aff)
  if [[ $seen == *"$scene"* ]]; then continue; fi
  seen+=$scene written=$((written + 1))
  for there in there.{nff,pov,glb,obj,dae}; do
    run pprt-convert "$model" $there; expect_code 0
  done
  run pprt-convert there.glb back.aff; expect_code 0
  for again in there.aff there.nff there.obj there.dae back.aff; do
    run pprt-render --census $again
    [[ $code -eq 0 ]] || complain "$model: '$command' ended with $code: $(cat err)"
  done
done
[[ $written -ge 60 ]] || complain "only $written scenes were converted"

# More transforms in each other than most files have, and an animation of four months.
triangle='{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"buffers":[{"uri":"n.bin","byteLength":68}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8},{"buffer":0,"byteOffset":44,"byteLength":24}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[10000000]},{"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}],'
zero='\0\0\0\0' one='\0\0\200\077' ten_million='\200\226\030\113'
printf "$zero$zero$zero$one$zero$zero$zero$one$zero$zero$ten_million$zero$zero$zero$one$zero$zero" >n.bin
deep=65 nodes='' channels=''
for ((i = 0; i < deep; ++i)); do
  children=''
  ((i + 1 == deep)) || children=",\"children\":[$((i + 1))]"
  nodes+="${nodes:+,}{\"mesh\":0,\"name\":\"n$i\"$children}"
  channels+="${channels:+,}{\"sampler\":0,\"target\":{\"node\":$i,\"path\":\"translation\"}}"
done
echo "$triangle\"nodes\":[$nodes],\"animations\":[{\"channels\":[$channels],\"samplers\":[{\"input\":1,\"output\":2}]}]}" >deep.gltf
run pprt-convert deep.gltf deep.aff; expect_code 0
expect_line err 'deep.gltf: it would have more than 1000000 frames at 24 a second: these are further apart'
run pprt-render --census deep.aff; expect_code 0
finish
