#!/usr/bin/env bash
# From a fresh Debian machine to the paper's Fig. 2: installs what is missing, builds the program, runs the
# scene fig2 and plots it. Safe to run again, from any folder.
#   tools/quickstart.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source tools/setup.sh

set_up program
# Tests and benchmarks are not built here: if their libraries are missing, leave them out of the build tree.
options=()
{ has header gtest/gtest.h && has header rapidcheck.h; } || options+=(-DCRADLE_TESTS=OFF)
has header benchmark/benchmark.h || options+=(-DCRADLE_BENCH=OFF)
configure "${options[@]}"
compile --target cradle_program

cradle=$build/tools/cradle
mkdir -p out
step "running scene fig2" "see the message above" "$cradle" run fig2 -o out/fig2.h5
step "plotting out/fig2.h5" "see the message above; the result itself is complete" \
  "$cradle" plot out/fig2.h5 -o out/fig2.png

cat <<DONE

Made:
  out/fig2.h5    the result: velocities and profiles at several times, energy, collisions
  $(ls -m out/fig2*.png)
                 pictures of it; compare the first with Fig. 2 of the paper
  $cradle
                 the program

To call it as \`cradle\`, type this (or append it to ~/.profile):
  export PATH=$PWD/$build/tools:\$PATH
Then \`cradle --help\` lists its commands, \`cradle scenes\` the scenes that come with it.
DONE
