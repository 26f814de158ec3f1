#!/usr/bin/env bash
# Builds everything and runs the tests through CTest; installs what is missing first. Safe to run again, from any
# folder. CRADLE_WERROR=ON in the environment turns warnings into errors.
#   tools/test.sh           all tests but those that take many seconds each, which have the label slow
#   tools/test.sh --slow    these too, and the benchmarks are built (a tenth of the time)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source tools/setup.sh

case "${1:-}" in
  "") leave_out=(-LE slow) bench=OFF ;;
  --slow) leave_out=() bench=ON ;;
  *) echo "unknown option ($1): give --slow or none" >&2; exit 2 ;;
esac
set_up tests
configure -DCRADLE_TESTS=ON "-DCRADLE_BENCH=$bench" "-DCRADLE_WERROR=${CRADLE_WERROR:-OFF}"
compile --target all
echo "== testing $build"
# Its summary is the last thing seen.
exec ctest --preset "$preset" "${leave_out[@]}" -j "$(processors)" --output-on-failure
