#!/usr/bin/env bash
# What a proof costs: each scene run on one thread, and certified. Processor seconds, least of three; collisions proved,
# digits of the proof, and how well the energy is known at the end.
#   bench/certify.sh [PROGRAM]      (default: build/release/tools/cradle)
set -euo pipefail
cradle=$(realpath "${1:-$(dirname "${BASH_SOURCE[0]}")/../build/release/tools/cradle}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
few="--set output.snapshots=[] --set output.series.points=20"
TIMEFORMAT=%U

# seconds REPEATS COMMAND...: what it prints last is in the file `last`.
seconds() {
  local repeats=$1 k
  shift
  for ((k = 0; k < repeats; ++k)); do
    { time { "$@" >last 2>&1 || true; }; } 2>&1
  done | sort -g | head -1
}
# line NAME REPEATS SCENE-AND-OPTIONS -- OPTIONS OF CERTIFY
line() {
  local name=$1 repeats=$2 run proof
  shift 2
  local scene=() digits=()
  while (($#)) && [[ $1 != -- ]]; do scene+=("$1"); shift; done
  (($#)) && shift && digits=("$@")
  run=$(seconds "$repeats" "$cradle" run "${scene[@]}" --threads 1 -o run.h5 --force)
  proof=$(seconds "$repeats" "$cradle" certify "${scene[@]}" "${digits[@]}" -o proof.h5 --force)
  local verdict collisions balls energy until
  verdict=$(grep -m 1 -oE '^(proved|undecided)' last) || { echo "$name: no verdict" >&2; cat last >&2; exit 1; }
  collisions=$(grep -oE '[0-9]+ collisions' last | head -1)
  until=$(sed -nE 's/^(proved: .*up to|undecided at) t = ([^ ,]*).*/\2/p' last | head -1)
  balls=$(sed -nE 's/^  run in +(.*), proved in balls around (.*); .*/\1 | \2/p' last)
  energy=$(sed -nE 's/.*energy .*known to ([^)]*)\).*/\1/p' last)
  printf '| %s | %s | %s until %s | %s | %s | %.1f | %s | %s |\n' \
    "$name" "${collisions% *}" "$verdict" "${until:0:9}" "$run" "$proof" \
    "$(echo "$proof $run" | awk '{print $1 / ($2 > 0 ? $2 : .01)}')" "$balls" "${energy:--}"
}

echo '| scene | collisions | verdict | run, s | proof, s | ratio | run in | proved in | energy known to |'
echo '|---|---|---|---|---|---|---|---|---|'
dry="fig2 $few --set output.profiles.times=[]"
line "Fig. 2 to t = 2000" 3 $dry --set run.until=2000
line "Fig. 2 to t = 2000, 50 digits" 1 $dry --set run.until=2000 -- --digits 50
line "Fig. 2 to t = 2000, 200 digits" 1 $dry --set run.until=2000 -- --digits 200
line "Fig. 2 to t = 6500" 3 $dry
line "Fig. 2 to t = 6550" 1 $dry --set run.until=6550
line "collapse of three particles to a gap of 1e-290" 1 collapse3
cooling="cooling $few --set output.masses=[]"
line "ring of 1000, dry, to t = 100" 3 $cooling --set initial.particles=1000 --set run.until=100
line "ring of 1e5, sticky, to t = 1000" 1 $cooling --set law.type=sticky --set law.restitution= --set law.cutoff= \
  --set initial.particles=100000
sticky="fig1 --set output.snapshots=[] --set output.series.points=5 --set output.profiles.times=[]"
line "rows of 1e6, sticky, to the end" 1 $sticky \
  --set initial.left.particles=500000 --set initial.right.particles=500000 \
  --set initial.perturbation=0.05 --set initial.centre= --set run.until=1000000
wet="fig6 $few --set output.profiles.times=[] --set output.masses=[]"
wet+=" --set initial.particles=20000 --set run.until=19500"
line "wet rows of 2e4, E = .05, to t = 19500" 1 $wet --set law.loss=0.05
for digits in 50 100 200 400 800; do
  line "wet rows of 2e4, E = .01, $digits digits" 1 $wet --set law.loss=0.01 --set run.precision=mpfr \
    --set run.digits=$digits -- --digits "$digits"
done
# Particles of unequal masses: a heavy one between two rows. Here radii grow with the collisions of a particle.
cat >heavy.toml <<'END'
law = {type = "inelastic", restitution = 0.95, cutoff = 1e-4}
[initial]
type = "rows"
perturbation = 0.05
seed = 1
left = {particles = 500, speed = 0.5, density = 1}
right = {particles = 500, speed = -0.5, density = 1}
centre = {mass = 5}
run.until = 300
output.series.points = 11
END
for digits in 31 50 100 200; do
  line "rows with a heavy particle between them, $digits digits" 1 heavy.toml -- --digits "$digits"
done
