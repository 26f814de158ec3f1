#!/usr/bin/env bash
# Builds everything, benchmarks included, and runs every test through CTest; installs what is missing first. Safe to
# run again, from any folder. CRADLE_WERROR=ON in the environment turns warnings into errors.
#   tools/test.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source tools/setup.sh

set_up tests
configure -DCRADLE_TESTS=ON -DCRADLE_BENCH=ON "-DCRADLE_WERROR=${CRADLE_WERROR:-OFF}"
compile --target all
echo "== testing $build"
exec ctest --preset "$preset" -j "$(processors)" --output-on-failure  # its summary is the last thing seen
