#!/usr/bin/env bash
# --film: the frames as a film, by ffmpeg.
source "$(dirname "$0")/check.sh"
work=(--clock work --budget 400000)

run pprt-render ball.nff --film x.avi; expect_usage "--film x.avi: want a name that ends in .mp4, .mkv or .gif"

# Without ffmpeg nothing is begun.
mkdir only
ln -s "$(command -v pprt-render)" only
PATH=$PWD/only run pprt-render ball.anim "${work[@]}" -o f/%d.png --film f.mp4; expect_code 1
expect_text err "pprt-render: error: --film needs ffmpeg, which is not on the PATH (package ffmpeg)"
expect_no_file f

# One that fails is told of; the frames are there, the film is not, nor anything of it.
mkdir broken
printf '#!/bin/sh\ncase "$*" in *-version) exit 0 ;; esac\necho "no room" >&2\nexit 3\n' >broken/ffmpeg
chmod +x broken/ffmpeg
PATH=$PWD/broken:$PATH run pprt-render ball.anim "${work[@]}" --frames 1-2 -o g/%d.png --film g/film.mp4; expect_code 1
expect_line err 'no room'
expect_line err "pprt-render: error: cannot write 'g/film.mp4': ffmpeg ended with code 3"
expect_text <(ls g) "$(printf '%s\n' 1.png 2.png manifest.ndjson)"

# One that ends early and content, or writes nothing, has made no film either.
for early in 'head -c 1000 >/dev/null' 'cat >/dev/null'; do
  printf '#!/bin/sh\ncase "$*" in *-version) exit 0 ;; esac\n%s\n' "$early" >broken/ffmpeg
  for film in film.mp4 film.gif; do
    PATH=$PWD/broken:$PATH run pprt-render ball.anim "${work[@]}" --frames 1-2 -o g/%d.png --film g/$film --resume; expect_code 1
    expect_line err "pprt-render: error: cannot write 'g/$film': ffmpeg \(ended before it had taken all frames\|has written nothing\)"
    expect_text <(ls g) "$(printf '%s\n' 1.png 2.png manifest.ndjson)"
  done
done

# One on the PATH that does not run is not taken for missing.
printf '#!/bin/sh\nexit 9\n' >broken/ffmpeg
PATH=$PWD/broken:$PATH run pprt-render ball.anim "${work[@]}" -o f/%d.png --film f.mp4; expect_code 1
expect_text err "pprt-render: error: --film needs ffmpeg, and that on the PATH does not run: 'ffmpeg -version' ended with code 9"

# Nor is one waited for that does not even tell its version.
printf '#!/bin/sh\nexec sleep 600\n' >broken/ffmpeg
PATH=$PWD/broken:$PATH run pprt-render ball.anim "${work[@]}" -o f/%d.png --film f.mp4; expect_code 1
expect_text err "pprt-render: error: --film needs ffmpeg, and that on the PATH hangs: 'ffmpeg -version' has not ended within 5 s"

# One that hangs and hears no signal is ended when the run is told to end, and at once when it is told twice.
printf '#!/bin/sh\ncase "$*" in *-version) exit 0 ;; esac\ntrap "" TERM\necho $$ >hung\nexec sleep 600\n' >broken/ffmpeg
for signals in 1 2; do
  rm -f hung
  PATH=$PWD/broken:$PATH pprt-render ball.anim "${work[@]}" --frames 1-2 -o g/%d.png --film g/film.mp4 --resume 2>err &
  until [[ -s hung ]]; do sleep 0.1; done
  kill -TERM $!
  until grep -q 'second signal' err; do sleep 0.1; done
  if ((signals == 2)); then kill -TERM $!; fi
  code=0; wait $! || code=$?
  command="ffmpeg hangs, $signals signals"
  if ((signals == 1)); then
    expect_code 1
    expect_line err "pprt-render: error: cannot write 'g/film.mp4': ffmpeg hung, and was ended when the run was to end"
    expect_text <(ls -A g) "$(printf '%s\n' 1.png 2.png manifest.ndjson)"
  fi
  for ((i = 0; i < 300; ++i)); do
    grep -qs $'^State:\t[^Z]' "/proc/$(cat hung)/status" || break  # it has ended, and perhaps nobody has asked how
    sleep 0.1
  done
  if ((i == 300)); then complain 'ffmpeg outlives the run'; kill -KILL "$(cat hung)"; fi
done

# Nothing that lies at a temporary name is written to, and no name is an option or an address.
cp ball.nff precious
mkdir http:
ln -s precious plain.mp4.part
for film in plain.mp4 -y.mp4 a:b.mp4 http://x/y.mp4 concat:z.mp4 %03d.mp4; do
  command -v ffmpeg >/dev/null || break
  run pprt-render ball.anim "${work[@]}" --frames 1-2 -o o/%d.png --overwrite --film="$film"; expect_code 0
  expect_file "./$film"
done
expect_same precious ball.nff

# A place where no film can be is refused before the first frame.
mkdir full.mp4
ln -s /dev/full device.mp4
for film in full.mp4 device.mp4 precious/film.mp4; do
  run pprt-render ball.anim "${work[@]}" --frames 1-2 -o p/%d.png --film $film --overwrite; expect_code 1
  expect_line err "pprt-render: error: cannot write '$film': .*"
  expect_no_file p
done

command -v ffmpeg ffprobe >/dev/null || { echo 'ffmpeg is not installed: films are not checked'; finish; exit; }
film_facts() {
  ffprobe -v error -count_frames -select_streams v -of csv=p=0 \
    -show_entries stream=codec_name,width,height,r_frame_rate,nb_read_frames "$1"
}
for np in 1 2; do
  run pprt-render ball.anim "${work[@]}" -np $np --frames 1-6 -s 33x24 -o h$np/%d.exr --film films/$np.mp4; expect_code 0
  # An odd width gets a black line.
  expect_text <(film_facts films/$np.mp4) h264,34,24,4/1,6
done
expect_text <(ls films) "$(printf '%s\n' 1.mp4 2.mp4)"
run pprt-render ball.anim "${work[@]}" --frames 1-6 -s 33x24 -o h3/%d.png --film films/3.gif; expect_code 0
expect_text <(film_facts films/3.gif) gif,33,24,4/1,6
# Hundredths of a second, two at least: of 12 frames at 100 a second six are left.
run pprt-render ball.anim "${work[@]}" --fps 100 --frames 1-12 -s 33x24 -o h4/%d.png --film films/4.gif; expect_code 0
expect_text <(film_facts films/4.gif) gif,33,24,50/1,6
expect_text <(ls films) "$(printf '%s\n' 1.mp4 2.mp4 3.gif 4.gif)"

# The disk has no room for the end of the film. A limit on the size of files, whose signal is ignored, is as good.
run pprt-render ball.anim "${work[@]}" -s 96x64 -o i/%d.png; expect_code 0
for film in end.mp4 end.mkv end.gif; do
  code=0
  (trap '' XFSZ; ulimit -f 2; pprt-render ball.anim "${work[@]}" -s 96x64 -o i/%d.png --resume --film i/$film) >out 2>err || code=$?
  command="a run with no room for $film"
  expect_code 1
  expect_line err "pprt-render: error: cannot write 'i/$film': ffmpeg ended with code 1"
  [[ $(ls -A i) == "$(printf '%s\n' {1,10,11,12,2,3,4,5,6,7,8,9}.png manifest.ndjson)" ]] || complain "$film: left $(ls -A i)"
done

# The film shows the frames, in their order.
run pprt-render ball.anim "${work[@]}" -s 96x64 -o k/%d.png --film k.mkv; expect_code 0
ffmpeg -v error -i k.mkv -start_number 1 film_%d.png
for frame in 1 7 12; do
  run pprt-compare film_$frame.png k/$frame.png --max-rmse 0.03; expect_code 0
done
run pprt-compare film_1.png k/7.png --max-rmse 0.03; expect_code 1

# It holds frames of earlier runs too, and is not replaced unasked.
run pprt-render ball.anim "${work[@]}" -s 96x64 --frames 3-3 -o k/%d.png --film k.mkv
expect_usage "k/3.png is there already; --overwrite replaces it, --resume goes on after it"
run pprt-render ball.anim "${work[@]}" --frames 3-3 -o n/%d.png --film k.mkv
expect_usage "k.mkv is there already; --overwrite replaces it, --resume goes on after it"
rm k/5.png
run pprt-render ball.anim "${work[@]}" -s 96x64 -o k/%d.png --film k.mkv --resume; expect_code 0
expect_line err 'done: 1 of 12 frames (11 were there already) .*'
expect_text <(film_facts k.mkv | cut -d, -f1-4) h264,96,64,4/1
[[ $(film_facts k.mkv | cut -d, -f5) -eq 12 ]] || complain "the film has $(film_facts k.mkv) frames, not 12"
# A still has no rate of its own.
run pprt-render ball.nff "${work[@]}" --fps 0 --samples 300 -o s.png --film s.mp4
expect_usage "--budget needs a frame rate (--fps)"
run pprt-render ball.nff --samples 300 -o s.png --film s.mp4; expect_code 0
expect_text <(film_facts s.mp4) h264,16,16,25/1,1
# A film alone keeps no frames; where -o names them they stay.
for words in "-o alone/a.mp4" "--film alone/b.gif"; do
  run pprt-render ball.anim "${work[@]}" --frames 1-3 $words; expect_code 0
  expect_line err 'done: 3 of 3 frames in alone/[ab]\.\(mp4\|gif\); .*'
done
expect_text <(ls -A alone) "$(printf '%s\n' a.mp4 b.gif)"
run pprt-render ball.anim "${work[@]}" --frames 1-2 -o both.mkv -o both/%d.png; expect_code 0
expect_line err 'done: 2 of 2 frames in both/1.png to both/2.png, both.mkv; .*'
expect_file both/2.png; expect_file both.mkv
finish
