#!/usr/bin/env bash
# Runs a file of Python tests, or a script, with the first Python that has h5py and matplotlib, in a temporary folder.
# Status 77, with the reason, if there is no such Python or all cases were skipped.
#   run.sh PROGRAM FILE [OPTION...]
set -euo pipefail
CRADLE_PROGRAM=$(realpath "$1")
file=$(realpath "$2")
here=$(dirname "$(realpath "$0")")
export CRADLE_PROGRAM PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$here/../../../tools/python:$here" MPLBACKEND=Agg
unset DISPLAY WAYLAND_DISPLAY
source "$here/../../../tools/setup.sh"
if ! first_python "import h5py, matplotlib"; then
  echo "skipped: no Python with h5py and matplotlib (Debian: python3-h5py python3-matplotlib; or set CRADLE_PYTHON)"
  exit 77
fi
export CRADLE_PYTHON=$python  # which the program then need not look for
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$python" -W error::ResourceWarning -W error::UserWarning "$here/run.py" "$file" "${@:3}"
