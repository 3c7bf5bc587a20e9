#!/usr/bin/env bash
# Command lines that make no sense.
source "$(dirname "$0")/check.sh"

run pprt-render; expect_code 2; expect_text out ''
expect_text err 'pprt-render needs a scene. To begin with:
  pprt-render spd:tree -s 256x256 -o tree.png
More commands: pprt-render --examples. All options: pprt-render --help all'
run pprt-render --seed 1; expect_usage "SCENE is required"
run pprt-render --bogus ball.nff; expect_usage "there is no option --bogus"
run pprt-render ball.nff ball.anim third; expect_usage "'third' is one argument too many"
run pprt-render ball.nff --np 0; expect_usage "--np: value 0 is not a whole number from 1 to 4096"
for threads in 0 257 1.5 many; do
  run pprt-render ball.nff --threads $threads
  expect_usage "--threads: value $threads is not a whole number from 1 to 256, nor auto"
done
run pprt-render ball.nff --clock sun; expect_usage "--clock: 'sun' is none of wall, work"
run pprt-render ball.nff --resume --overwrite; expect_usage "--overwrite excludes --resume"
run pprt-render ball.nff --budget 5; expect_usage "--budget counts work: it needs --clock work"
run pprt-render ball.nff --budget 5 --clock work; expect_usage "--budget needs a frame rate (--fps)"
run pprt-render ball.nff --fps 1e-308; expect_usage "--fps 1e-308: want 0, for no rate, or at least 0.001"
run pprt-render ball.nff --fps 4 --samples 10
flips="--time, --samples and a FLIP as --quality end frames without a rate, but the rate is 4 frames/s; --fps 0 turns it off"
expect_usage "$flips"
run pprt-render ball.nff --fps 4 --quality 0.02; expect_usage "$flips"
run pprt-render ball.nff --quality rmse=7
expect_usage "--quality rmse=7: want a FLIP or rmse=E, each from 1e-06 to 1, such as 0.02 or rmse=0.01"
run pprt-render ball.anim --film-time 5 --fps 4
expect_usage "--film-time is the time of all frames: it cannot be used with --fps"
run pprt-render ball.anim --film-time 5 --time 1
expect_usage "--film-time is the time of all frames: it cannot be used with --time, --samples or --quality"
run pprt-render ball.nff --film-time 5
expect_usage "--film-time divides a film's time among its frames, and there is one: --time ends it"
for size in 1e9x1 0x5 16x 99999x2; do
  run pprt-render ball.nff -s $size
  expect_usage "--size $size: want WIDTHxHEIGHT in pixels, each from 1 to 16384, such as 256x256"
done
for address in x 65536 example.org:80 ::1:80; do
  run pprt-render ball.nff --live $address
  expect_usage "--live $address: want PORT or ADDRESS:PORT, as in 8080, 0.0.0.0:8080 or [::1]:8080"
done
run pprt-render ball.nff --live 0 --clock work; expect_usage "--live needs real time, not --clock work"
run pprt-render ball.nff --live 0 --go-on; expect_usage "--live needs all ranks: it cannot be used with --go-on"
for fps in 0 0.5 500; do
  run pprt-render ball.nff --live 0 --fps $fps
  expect_usage "--live needs a rate from 1 to 120 frames/s, not $fps; --fps sets it"
done
run pprt-render ball.nff --live 0 --quality 0.01
expect_usage "--live has a rate: it takes no --time, --samples or --quality"
run pprt-render ball.nff --live 0 -o x.png
expect_usage "with --live, --output writes the frames of a script, and there is none"
run pprt-render ball.nff --live 0 --stats x
expect_usage "with --live, files beside the frames need the frames: name them by --output"
run pprt-render ball.anim --frames 0-3; expect_usage "--frames 0-3: want FIRST-LAST, counted from 1, such as 1-40"
run pprt-render ball.anim --frames 3-13; expect_usage "--frames 3-13: the last frame is 12"
run pprt-render ball.nff -o x.tif; expect_usage "output 'x.tif': the name must end in .exr or .png"
run pprt-render ball.nff --reference x.tif; expect_usage "--reference 'x.tif': the name must end in .exr or .png"
run pprt-render ball.nff --contact-sheet x.jpg
expect_usage "--contact-sheet x.jpg: want a name that ends in .png or .exr"
run pprt-render ball.nff --effects caustics
expect_usage "unknown effect 'caustics'; there are shadows,highlights,reflection,refraction,smooth-normals,textures,emission,sky, and the words auto, all and none"
# What was probably meant.
run pprt-render ball.nff --frmaes 1-3; expect_usage "there is no option --frmaes; did you mean '--frames'?"
run pprt-render --layer=samples ball.nff; expect_usage "there is no option --layer; did you mean '--layers'?"
run pprt-render --ovrewrite; expect_usage "there is no option --ovrewrite; did you mean '--overwrite'?"
run pprt-render ball.nff --cast verfied; expect_usage "--cast: 'verfied' is none of off, paper, verified, auto; did you mean 'verified'?"
run pprt-render ball.nff --effects shadow
expect_usage "unknown effect 'shadow'; there are shadows,highlights,reflection,refraction,smooth-normals,textures,emission,sky, and the words auto, all and none; did you mean 'shadows'?"
run pprt-render ball.nff --effects foo
expect_usage "unknown effect 'foo'; there are shadows,highlights,reflection,refraction,smooth-normals,textures,emission,sky, and the words auto, all and none"
run pprt-study acuracy -o x; expect_code 2
expect_text err "pprt-study: error: there is no subcommand 'acuracy'; did you mean 'accuracy'?"$'\n'"try 'pprt-study --help'"
run pprt-study paper --qick -o x; expect_code 2
expect_text err "pprt-study: error: there is no option --qick; did you mean '--quick'?"$'\n'"try 'pprt-study --help'"
# Numbers that are none, and limits as a person would write them.
for value in nan -nan inf 0 x; do
  run pprt-convert --chord-error $value ball.nff x.nff; expect_code 2
  expect_text err "pprt-convert: error: --chord-error: value $value is not a number above 0"$'\n'"try 'pprt-convert --help'"
done
run pprt-convert --tessellate -1 ball.nff x.nff; expect_code 2
expect_line err 'pprt-convert: error: --tessellate: value -1 is not a whole number from 1 to 1000'
for option in max-rmse min-psnr max-relative-mse min-ssim max-flip max-error max-p999 max-share max-flicker; do
  run pprt-compare --$option nan a.png b.png; expect_code 2
  expect_text err "pprt-compare: error: --$option: value nan is not a number"$'\n'"try 'pprt-compare --help'"
done
run pprt-compare --threshold nan a.png b.png; expect_code 2
expect_line err 'pprt-compare: error: --threshold: value nan is not a number from 0'
run pprt-study counts --tolerance nan; expect_code 2
expect_line err 'pprt-study: error: --tolerance: value nan is not a number from 0'
run pprt-study accuracy --want-rmse nan; expect_code 2
expect_line err 'pprt-study: error: --want-rmse: value nan is not a number above 0'
run pprt-render ball.nff --fps nan; expect_usage "--fps: value nan is not a number from 0 to 1000"
run pprt-render --config none.ini; expect_usage "none.ini was not readable (missing?)"

run pprt-render --version; expect_code 0; expect_line out 'pprt-render [0-9]*\.[0-9]*\.[0-9]*'; expect_text err ''
run pprt-render --help all; expect_code 0; expect_line out '  --contact-sheet FILE .*'; expect_text err ''
run pprt-render --help; expect_code 0; expect_line out '  --live \[ADDRESS:\]PORT'
[[ $(grep -c '^  -' out) == 12 ]] || complain "'$command': there are not twelve options: $(cat out)"
for program in pprt-convert pprt-compare pprt-study; do
  run "$program"; expect_code 2; expect_line err "try '$program --help'"
  run "$program" --help; expect_code 0; expect_text err ''
  run "$program" --version; expect_code 0; expect_line out "$program [0-9]*\.[0-9]*\.[0-9]*"
done
expect_no_file frame_0001.png

# What cannot be printed is an error. pprt-compare keeps 1 for differences.
to_a_full_device() {
  code=0
  command="$* to a full device"
  "$@" >/dev/full 2>err || code=$?
  expect_code $([[ $1 == pprt-compare ]] && echo 2 || echo 1)
  expect_text err "$1: error: cannot write to standard output: No space left on device"
}
for program in pprt-render pprt-convert pprt-compare pprt-study; do
  for option in --help --version '--completion bash'; do to_a_full_device $program $option; done
done
to_a_full_device pprt-study counts --help
for options in --census --write-config '--samples 50 -o full.png --census' '--samples 50 -o full.png --stats -'; do
  to_a_full_device pprt-render ball.nff $options
  expect_no_file full.png
done

# Of closed streams none is taken by a file, which would get the text. An empty standard input ends at once.
for np in 1 2; do
  code=0 command="$np ranks without standard streams"
  pprt-render ball.nff --samples 50 -np $np -o closed$np/%d.png --stats closed$np.ndjson <&- >&- 2>&- || code=$?
  expect_code 0
  for file in closed$np/manifest.ndjson closed$np.ndjson; do
    [[ $(grep -vc '^{"record":.*}$' $file) -eq 0 ]] || complain "$command: $file has other text: $(cat $file)"
  done
  run timeout 60 pprt-render - -np $np --samples 50 -o none.png <&-; expect_code 3
  expect_text err '<stdin>: error: the file is empty'
done
for program in pprt-render pprt-convert pprt-compare pprt-study; do
  code=0 command="$program --version >&-"
  $program --version >&- 2>err || code=$?
  expect_code $([[ $program == pprt-compare ]] && echo 2 || echo 1)
  expect_text err "$program: error: cannot write to standard output: Bad file descriptor"
done

# More ranks than mpirun may open files for are refused; a soft limit is raised.
code=0 command='16 ranks with 64 open files'
(ulimit -n 64; pprt-render ball.nff -np 16 --samples 50 -o many.png) >out 2>err || code=$?
expect_code 1; expect_no_file many.png
expect_text err "pprt-render: error: 16 ranks are too many: mpirun would open 128 files, and 'ulimit -Hn' allows 64; --hostfile adds hosts"
code=0 command='16 ranks with 64 open files, which may be more'
(ulimit -Sn 64; timeout --signal=KILL 120 pprt-render ball.nff -np 16 --samples 50 -o many.png) >out 2>err || code=$?
expect_code 0; expect_file many.png
# A variable that merely has the name of a launcher's does not make this process a rank.
for variable in OMPI_COMM_WORLD_RANK=3 'OMPI_COMM_WORLD_RANK=3 OMPI_COMM_WORLD_SIZE=4' PMIX_RANK=3 PMI_RANK=3; do
  rm -f lone.png
  # shellcheck disable=SC2086 # two variables
  run env $variable pprt-render ball.nff --samples 300 -o lone.png
  expect_code 0
  expect_file lone.png
  # shellcheck disable=SC2086
  run env $variable pprt-render ball.nff --no-such-option
  expect_code 2
done
# One that takes part in a run of another MPI says so.
run env PMI_RANK=3 PMI_SIZE=4 pprt-render ball.nff --samples 300 -o lonely.png
expect_code 1
expect_line err 'pprt-render: error: the environment says that this is rank 3 of an MPI run (PMIX_RANK or PMI_RANK), but for MPI it is rank 0; .*'
expect_no_file lonely.png

# A hostfile is checked before mpirun reads it.
printf 'localhost slots=2\r\n' >hosts
run pprt-render ball.nff --samples 300 -np 2 --hostfile hosts -o hosts.png
expect_code 0
expect_file hosts.png
printf 'localhost\nlocalhost slot=2\n' >hosts
run pprt-render ball.nff --samples 300 -np 2 --hostfile hosts -o none.png
expect_code 3
expect_text err "hosts:2:11: error: 'slot' is no word of a hostfile; did you mean 'slots'?
    localhost slot=2
              ^"
printf 'no-such-host.invalid slots=2\n' >hosts
run pprt-render ball.nff --samples 300 -np 2 --hostfile hosts -o none.png
expect_code 3
expect_text err "hosts:1:1: error: no address is known for the host 'no-such-host.invalid'
    no-such-host.invalid slots=2
    ^"
run pprt-render ball.nff --samples 300 -np 2 --hostfile no-hosts -o none.png
expect_code 3
expect_line err ".*cannot read '.*no-hosts': No such file or directory"

finish
