# Shared by the MPI tests: a temporary directory, and fail(). Needs pprt-render on the PATH.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
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
