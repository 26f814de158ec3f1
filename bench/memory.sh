#!/usr/bin/env bash
# Peak resident memory of the program for two rows of 8000 and of 2e7 particles, run until t = 1000. Rows are streamed,
# so memory depends on the active zone, and the two must be about equal. Prints both and their ratio.
#   bench/memory.sh [PROGRAM]      (default: build/release/tools/cradle)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cradle=${1:-build/release/tools/cradle}
[[ -x $cradle ]] || { echo "no program (looked for $cradle): build it by tools/quickstart.sh" >&2; exit 1; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# peak PARTICLES: the largest resident size of the program in such a run, in kB.
peak() {
  python3 - "$cradle" run fig2 --quiet --set "initial.particles=$1" --set run.until=1000 \
    --set 'output.snapshots=[500, 1000]' --set 'output.profiles.times=[500, 1000]' -o "$scratch/$1.h5" <<'PYTHON'
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=sys.stderr)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
PYTHON
}

small=$(peak 8000)
large=$(peak 2e7)
echo "N = 8000: $small kB    N = 2e7: $large kB    ratio $(python3 -c "print(f'{$large / $small:.3f}')")"
