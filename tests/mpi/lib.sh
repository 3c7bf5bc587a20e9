# What the MPI tests share: a directory of their own, and a way to fail. Needs pprt-render on the PATH.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "mpi: $*" >&2; exit 1; }

# The frames that a pattern's directory must hold, and no others.
expect_frames() {
  local dir=$1 extension=$2 count=$3 found
  found=$(find "$dir" -name "*.$extension" | wc -l)
  [[ $found == "$count" ]] || fail "$dir holds $found frames *.$extension instead of $count"
}

# Mpirun as a person would call it; root needs a word more.
mpirun_by_hand() {
  local root=()
  if [[ $(id -u) == 0 ]]; then root=(--allow-run-as-root); fi
  mpirun --oversubscribe "${root[@]}" "$@"
}
