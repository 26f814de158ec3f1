#!/usr/bin/env bash
# What each measured quantity costs: instructions per collision of the whole program, by callgrind, as the difference
# between a run and one half as long. An elastic gas of 1000 particles in equilibrium on a ring, one thread.
#   bench/quantities.sh [PROGRAM]      (default: build/release/tools/cradle; needs valgrind)
set -euo pipefail
cradle=$(realpath "${1:-$(dirname "${BASH_SOURCE[0]}")/../build/release/tools/cradle}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat >gas.toml <<'TOML'
law = { type = "inelastic", restitution = 1 }
initial = { type = "ring", particles = 1000, perturbation = 0.4 }
run = { until = 400 }
output = { series = { points = 11 } }
TOML

# instructions UNTIL OPTIONS...: of a run, and its collisions
instructions() {
  local until=$1
  shift
  valgrind --tool=callgrind --callgrind-out-file=/dev/null "$cradle" run gas.toml --threads 1 -o run.h5 --force \
    --set "run.until=$until" "$@" >out 2>&1
  sed -n 's/.*Collected : \([0-9]*\).*/\1/p' out
  sed -n 's/.*, \([0-9]*\) collisions, .*/\1/p' out
}
line() {
  local name=$1 short long
  shift
  mapfile -t short < <(instructions 200 "$@")
  mapfile -t long < <(instructions 400 "$@")
  printf '| %s | %.0f |\n' "$name" \
    "$(echo "scale=3; (${long[0]} - ${short[0]})/(${long[1]} - ${short[1]})" | bc)"
}
echo '| quantity | instructions per collision |'
echo '|---|---|'
line 'none'
line 'averages, every 1'            --set 'output.averages={every=1,bins=20}'
for name in free_flight pair_flight closing_speed dissipative_closing_speed collisions_per_particle; do
  line "histogram of $name"         --set "output.histograms=['$name']"
done
line 'histogram of gap, every 1'    --set "output.histograms=['gap']" --set 'output.counting={every=1}'
line 'histogram of cluster, every 1' --set "output.histograms=['cluster']" \
  --set 'output.counting={every=1,cluster_gap=0.1}'
line 'correlations, every 0.25'     --set 'output.correlations={every=0.25,longest=20}'
line 'structure, every 1'           --set 'output.structure={every=1}'
line 'pair distribution, every 1'   --set 'output.pair_distribution={every=1,distance=10}'
line 'events'                       --set output.events=true
