# Shared by the MPI tests: a temporary directory, and fail(). Needs pprt-render on the PATH.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
# Not by a process of this shell that is killed before it has become another program.
trap '[[ $BASHPID != $$ ]] || rm -rf "$work"' EXIT
cd "$work"

fail() { echo "mpi: $*" >&2; exit 1; }

# Checks that a pattern's directory holds exactly these frames.
expect_frames() {
  local dir=$1 extension=$2 count=$3 found
  found=$(find "$dir" -name "*.$extension" | wc -l)
  [[ $found == "$count" ]] || fail "$dir holds $found frames *.$extension instead of $count"
}

# Calls mpirun as a person would; root needs one more option.
mpirun_by_hand() {
  local root=()
  if [[ $(id -u) == 0 ]]; then root=(--allow-run-as-root); fi
  mpirun --oversubscribe "${root[@]}" "$@"
}

# children PROCESS: what its main thread has started, without a process of its own: moments pass quickly.
children() {
  local list=()
  read -r -a list 2>/dev/null <"/proc/$1/task/$1/children" || true
  echo "${list[@]}"
}

# family PROCESS: it and all that it has started: the launcher, its mpirun, the guards, the ranks.
family() {
  local child
  echo "$1"
  for child in $(children "$1"); do family "$child"; done
}

# has_rank PROCESS RANK: whether mpirun has given the process this rank.
has_rank() {
  local variables=() variable
  mapfile -d '' -t variables 2>/dev/null <"/proc/$1/environ" || return 1
  for variable in "${variables[@]}"; do
    if [[ $variable == "OMPI_COMM_WORLD_RANK=$2" ]]; then return; fi
  done
  return 1
}

# guard_process RUN RANK: the id of the process beside a rank, waiting until it is there.
guard_process() {
  local process
  for ((i = 0; i < 500; ++i)); do
    for process in $(family "$1"); do
      if has_rank "$process" "$2"; then
        echo "$process"
        return
      fi
    done
    sleep 0.02
  done
  fail "there is no rank $2"
}

# rank_process RUN RANK: the same for the rank itself.
rank_process() {
  local guard process
  guard=$(guard_process "$1" "$2")
  for ((i = 0; i < 500; ++i)); do
    process=$(children "$guard")
    if [[ -n $process ]]; then
      echo "$process"
      return
    fi
    sleep 0.02
  done
  fail "nobody is beside the guard of rank $2"
}

# await_frames DIRECTORY COUNT
await_frames() {
  for ((i = 0; i < 1500; ++i)); do
    if [[ $(find "$1" -name '????.png' 2>/dev/null | wc -l) -ge $2 ]]; then return; fi
    sleep 0.02
  done
  fail "$1 does not come to hold $2 frames"
}

# Checks that every file is a whole picture, and is in the manifest unless the run was killed in between.
expect_whole() {
  local file
  for file in "$1"/????.png; do
    pprt-compare "$file" "$file" >/dev/null || fail "$file is not whole"
  done
}
