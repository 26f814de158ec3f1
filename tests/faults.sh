#!/usr/bin/env bash
# Injects faults into the program: kills, full disks, folders that cannot be written, damaged files, too little memory,
# clocks that jump. Prints one table: tried, failed. Failed must be 0. (Signals, two writers: tools/run/outputs.txt.)
#
#   tests/faults.sh [PROGRAM] [KILLS]     program: build/release/tools/cradle; 50 kills of runs and of ensembles each
#
# It mounts a small tmpfs for the full disk (in its own user namespace) and uses faketime for the clock; it says if one
# is missing. SEED=n chooses other times.
set -u
program=$(readlink -f "${1:-build/release/tools/cradle}") kills=${2:-50}
RANDOM=${SEED:-1}
cradle() { "$program" "$@"; }
folder=$(mktemp -d) && trap 'chmod -R u+w "$folder"; rm -rf "$folder"' EXIT && cd "$folder" || exit 1
export LC_ALL=C.UTF-8

declare -A tried failed
order=()
counted() { # counted WHAT: the status of the command before says whether it went well
  local status=$? what=$1
  [ -n "${tried[$what]:-}" ] || { order+=("$what"); tried[$what]=0 failed[$what]=0; }
  tried[$what]=$((tried[$what] + 1))
  [ $status -eq 0 ] || { failed[$what]=$((failed[$what] + 1)); echo "FAILED: $what${2:+: $2}"; }
}
left_out() { order+=("$1"); tried[$1]=0 failed[$1]="not tried: $2"; }

# ---- kills: after every one, `resume` must give the bytes of the uninterrupted command
kill_each() { # kill_each WHAT OPTIONS COMMAND...: in turn, at any time; leaves what they give: run0.h5, run1.h5, ...
  local what=$1 options=$2 commands=("${@:3}") whole=${1#* } file=killed.h5 took=() from k n pid
  for k in "${!commands[@]}"; do
    from=$(date +%s%N)
    cradle ${commands[k]} $options -o $whole$k.h5
    took[k]=$((($(date +%s%N) - from) / 1000000))
  done
  for ((n = 0; n < kills; ++n)); do
    k=$((n % ${#commands[@]}))
    rm -f $file*
    "$program" ${commands[k]} $options -o $file & pid=$!
    sleep "$(awk -v t="${took[k]}" -v r=$RANDOM 'BEGIN { print t / 1000 * r / 32768 }')"
    kill -9 $pid 2>/dev/null; wait $pid 2>/dev/null
    if [ ! -e $file ] && [ ! -e $file.part ]; then cradle ${commands[k]} $options -o $file; fi # before it had begun
    cradle resume $file --quiet >/dev/null && cradle diff $file $whole$k.h5 >/dev/null && cmp -s $file $whole$k.h5 &&
      [ ! -e $file.part ]
    counted "kill -9 of $what, then resume" "${commands[k]}"
  done
}
dry='fig2 --set run.until=6000 --set output.snapshots=[1000,5500]'
none='--set output.profiles.times=[] --set output.snapshots=[]'
often='--quiet --set output.checkpoint.every_seconds=0.1'
kill_each 'a run' "$often" "run $dry" \
  'run fig2 --set initial.particles=2000 --set run.until=1300 --set output.events=true' \
  'run fig6 --set initial.particles=8000 --set run.until=2500 --set output.snapshots=[] --set output.masses=[]' \
  'run cooling --set law.type=inelastic --set law.restitution=0.99 --set law.cutoff=0.01
   --set initial.particles=20000 --set run.until=200' \
  "run fig2 --set initial.particles=1000 --set run.until=700 --set run.precision=mpfr $none" \
  'run fig2 --set run.until=3000 --set run.coordinates=absolute' \
  'run cooling --set initial.particles=200000'
kill_each 'an ensemble' --quiet \
  "ensemble fig2 --replicas 600 --set initial.particles=300 --set run.until=200 $none" \
  'ensemble fig11 --replicas 150 --set initial.particles=2000 --set run.until=1000 --set output.masses=[]' \
  "sweep fig2 --vary law.restitution=0.99:0.999:4 --replicas 150 --set initial.particles=300 --set run.until=200 $none"

# ---- full disk: some kilobytes, so that it is full during the journal, a checkpoint or the result
if unshare --user --map-root-user --mount true 2>/dev/null; then
  for size in 16k 40k 100k 180k 300k 600k 800k 1200k; do
    mkdir -p small elsewhere
    export -f cradle; export program often dry size
    unshare --user --map-root-user --mount bash -c '
      mount -t tmpfs -o size=$size tmpfs small && export TMPDIR=$PWD/elsewhere
      cradle run $dry $often -o small/a.h5 2>small.err; status=$?
      if [ $status = 0 ]; then cmp -s small/a.h5 run0.h5; exit; fi
      [ $status = 4 ] || exit 1
      grep -q "what to do\|space\|room\|resume\|move it" small.err || exit 1
      mount -o remount,size=8m small
      if [ -e small/a.h5.part ]; then cradle resume small/a.h5 --quiet && cmp -s small/a.h5 run0.h5; exit; fi
      found=$(find elsewhere -name a.h5); if [ -n "$found" ]; then cmp -s "$found" run0.h5; exit; fi
      [ ! -e small/a.h5 ]'
    counted 'full disk, then room' "$size: $(head -c 300 small.err)"
    rm -rf elsewhere small
  done
else
  left_out 'full disk, then room' 'no user namespaces here'
fi

# ---- a folder that cannot be written (as another user if this one is root)
mkdir closed && chmod 555 closed
if [ "$(id -u)" = 0 ]; then as() { setpriv --reuid=65534 --clear-groups "$@"; }; else as() { "$@"; }; fi
chmod 755 "$folder"
as "$program" run fig2 --quiet --set run.until=10 -o closed/a.h5 2>closed.err
[ $? = 4 ] && [ -s closed.err ] && [ -z "$(ls closed)" ]
counted 'read-only folder' "$(cat closed.err)"

# ---- truncated and flipped files
# Of a run that was killed; one that was over before is made again, twice as long.
for ((until = 6000; ; until *= 2)); do
  rm -f kept.h5*
  "$program" run $dry --set run.until=$until $often -o kept.h5 2>/dev/null & pid=$!
  until [ -e kept.h5.checkpoint ] || [ -e kept.h5 ]; do :; done
  kill -9 $pid; wait $pid 2>/dev/null
  [ ! -e kept.h5 ] && [ -e kept.h5.part ] && break
done
cradle run $dry --set run.until=$until --quiet -o whole.h5
mkdir kept && mv kept.h5.part kept.h5.checkpoint kept
damage() { # damage FILE: cuts it, or flips a bit
  local size at; size=$(stat -c %s "$1") at=$((RANDOM * 32768 + RANDOM)); at=$((at % size))
  if [ $((RANDOM % 2)) = 0 ]; then truncate -s $at "$1"; else
    printf "$(printf '\\x%02x' $((0x$(xxd -s $at -l 1 -p "$1") ^ (1 << RANDOM % 8))))" |
      dd of="$1" bs=1 seek=$at conv=notrunc status=none
  fi
}
for ((n = 0; n < 100; ++n)); do
  for which in part checkpoint; do
    rm -f kept.h5*; cp kept/kept.h5.* .
    damage kept.h5.$which
    before=$(cat kept.h5.checkpoint kept.h5.part | cksum)
    timeout 300 "$program" resume kept.h5 --quiet >/dev/null 2>damaged.err; status=$?
    case $status in
    0) cmp -s kept.h5 whole.h5 ;; # what was damaged came after the checkpoint
    4) [ -s damaged.err ] && [ ! -e kept.h5 ] && [ "$before" = "$(cat kept.h5.checkpoint kept.h5.part | cksum)" ] ;;
    *) false ;;
    esac
    counted "damaged $which" "status $status: $(head -c 200 damaged.err)"
    timeout 300 "$program" info kept.h5.$which >/dev/null 2>&1; [ $? -le 4 ]
    counted 'info of a damaged file'
  done
done

# ---- too little memory
for megabytes in 60 100 200 400; do
  (ulimit -v $((megabytes * 1024))
    cradle run cooling --quiet --threads 1 --set initial.particles=2e6 --set run.until=0.01 -o memory.h5 2>memory.err)
  status=$?
  [ $status = 0 ] || { [ $status -lt 6 ] && [ -s memory.err ] && [ ! -e memory.h5 ]; }
  counted 'too little memory' "$megabytes MB: status $status, $(head -c 200 memory.err)"
  rm -f memory.h5*
done

# ---- a clock that jumps
library=$(ls /usr/lib/*/faketime/libfaketimeMT.so.1 2>/dev/null | head -1)
if [ -n "$library" ]; then
  for jump in +10d -10d; do
    rm -f clock*; echo '+0' >clock
    # The clock jumps while the run is halted. A run that was over before has seen no jump; it passes, too.
    LD_PRELOAD=$library FAKETIME_TIMESTAMP_FILE=$PWD/clock FAKETIME_NO_CACHE=1 FAKETIME_DONT_FAKE_MONOTONIC=1 \
      "$program" run $dry $often -o clock.h5 & pid=$!
    until [ -e clock.h5.checkpoint ]; do sleep 0.01; done
    kill -STOP $pid; echo $jump >clock; kill -CONT $pid
    wait $pid && cmp -s clock.h5 run0.h5
    counted 'the clock jumps' "$jump"
  done
else
  left_out 'the clock jumps' 'faketime is not installed'
fi

# ---- the table
echo
printf '| what | tried | failed |\n|---|---|---|\n'
all=0
for what in "${order[@]}"; do
  printf '| %s | %s | %s |\n' "$what" "${tried[$what]}" "${failed[$what]}"
  [[ ${failed[$what]} = not* ]] || all=$((all + failed[$what]))
done
[ $all = 0 ]
