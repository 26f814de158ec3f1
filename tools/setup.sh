# shellcheck shell=bash
# Shared by quickstart.sh, test.sh and tests/tools/python/run.sh, which source it. `set_up program|tests` makes sure
# that everything needed to build the program (and its tests) is installed: it installs what is missing with apt, as
# root or through sudo. If it cannot, it lists the missing Debian packages and stops. If nothing is missing it needs no
# network, root or apt. What is optional (install_optional says what for) is installed if that needs no password, else
# left out. `step` runs a command; if it fails, `step` stops and says what to do. Tested on bare Debian 12 and 13.

preset=release
build=build/$preset

# purpose | what | probe | Debian's package
needs() {
  cat <<'TABLE'
program | C++20 compiler        | compiler                     | g++
program | CMake 3.25 or newer   | cmake 3.25                   | cmake
program | Ninja (or make)       | generator                    | ninja-build
program | Boost headers         | header boost/multiprecision/cpp_bin_float.hpp | libboost-dev
program | oneTBB                | header oneapi/tbb/version.h  | libtbb-dev
program | toml++                | header toml++/toml.h         | libtomlplusplus-dev
program | CLI11                 | header CLI/CLI.hpp           | libcli11-dev
program | fmt                   | header fmt/format.h          | libfmt-dev
program | HDF5                  | header hdf5.h                | libhdf5-dev
program | liblzma               | header lzma.h                | liblzma-dev
program | MPFR                  | header mpfr.h                | libmpfr-dev
program | GMP                   | header gmp.h                 | libgmp-dev
program | Python 3              | command python3              | python3
program | Matplotlib            | python matplotlib            | python3-matplotlib
program | h5py                  | python h5py                  | python3-h5py
tests   | GoogleTest            | header gtest/gtest.h         | libgtest-dev
tests   | rapidcheck            | header rapidcheck.h          | librapidcheck-dev
tests   | Google Benchmark      | header benchmark/benchmark.h | libbenchmark-dev
option  | Highway               | header hwy/highway.h         | libhwy-dev
option  | MPI compiler          | command mpicc                | libopenmpi-dev
option  | MPI launcher          | command mpirun               | openmpi-bin
option  | pybind11              | header pybind11/pybind11.h   | pybind11-dev
option  | Python headers        | python_header                | python3-dev
look    | Chromium              | command chromium             | chromium
look    | pandas                | plotting pandas              | python3-pandas
look    | xarray                | plotting xarray              | python3-xarray
look    | qemu-x86_64           | command qemu-x86_64          | qemu-user
look    | dpkg-shlibdeps        | command dpkg-shlibdeps       | dpkg-dev
look    | file                  | command file                 | file
look    | groff                 | command groff                | groff
look    | pip                   | python pip                   | python3-pip
look    | setuptools            | python setuptools            | python3-setuptools
look    | wheel                 | python wheel                 | python3-wheel
look    | venv                  | python ensurepip             | python3-venv
look    | MkDocs Material       | mkdocs_theme material        | mkdocs-material
look    | mkdocstrings          | python mkdocstrings_handlers.python | mkdocstrings-python-handlers
TABLE
}

# step WHAT WHAT_TO_DO COMMAND...
step() {
  local what=$1 remedy=$2 status=0
  shift 2
  echo "== $what"
  "$@" || status=$?
  ((status == 0)) && return
  echo "${0##*/}: $what failed ($1 ended with status $status): $remedy" >&2
  exit 1
}

has_compiler() {
  "${CXX:-c++}" -std=c++20 -fsyntax-only -x c++ - 2>/dev/null <<'CODE'
#include <bit>
#include <concepts>
static_assert(std::bit_cast<unsigned>(1.0f) != 0 && std::integral<int>);
CODE
}

has_cmake() {
  local found
  found=$(cmake --version 2>/dev/null | sed -n '1s/[^0-9]*//p') && [[ -n $found ]] &&
    [[ $(printf '%s\n' "$1" "$found" | sort -V | head -n 1) == "$1" ]]
}

# Finds a header in the folders of the compiler, the environment or Debian.
has_header() {
  local folder folders prefix prefixes
  IFS=: read -ra folders <<<"${CPATH:-}:${CPLUS_INCLUDE_PATH:-}"
  IFS=':;' read -ra prefixes <<<"${CMAKE_PREFIX_PATH:-}:${HDF5_ROOT:-}:${BOOST_ROOT:-}:${TBBROOT:-}"
  for prefix in "${prefixes[@]}" /usr/local /usr; do folders+=("${prefix:+$prefix/include}"); done
  for folder in "${folders[@]}" /usr/include/*-linux-gnu /usr/include/hdf5/serial; do
    if [[ -n $folder && -f $folder/$1 ]]; then return 0; fi
  done
  return 1
}

# first_python CODE: sets `python` to the first of these interpreters that runs it without an error.
first_python() {
  for python in "${CRADLE_PYTHON:-}" python3 /usr/bin/python3; do
    if [[ -n $python ]] && "$python" -c "$1" >/dev/null 2>&1; then return 0; fi
  done
  return 1
}

# plotting_python CODE: whether the interpreter for plotting, which is the first that has what it needs, runs it.
plotting_python() { first_python "import h5py, matplotlib" && "$python" -c "$1" >/dev/null 2>&1; }

has_command() { command -v "$1" >/dev/null; }
has_generator() { has_command ninja || has_command make; }
has_python() { first_python "import $1"; }
has_plotting() { plotting_python "import $1"; }

# For the module for live simulations.
has_python_header() {
  plotting_python "import os, sysconfig, sys
sys.exit(not os.path.isfile(os.path.join(sysconfig.get_path('include'), 'Python.h')))"
}

# The theme of the manual's site; MkDocs finds it by its name.
has_mkdocs_theme() {
  has_command mkdocs && first_python "import sys; from mkdocs.utils import get_theme_names
sys.exit('$1' not in get_theme_names())"
}

# has PROBE [ARGUMENT]: of the table.
has() {
  local python
  "has_$1" "${@:2}"
}

# Fills the arrays missing and debian with what the program (or also the tests) needs, and optional with what it could
# use.
search_for() {
  local group what probe package
  missing=() debian=() optional=()
  while IFS='|' read -r group what probe package; do
    if [[ $1 == program && ${group// /} =~ ^(tests|look)$ ]]; then continue; fi
    # shellcheck disable=SC2086  # a probe is a word and its argument
    if has $probe; then continue; fi
    if [[ ${group// /} =~ ^(option|look)$ ]]; then
      optional+=("${package// /}")
      continue
    fi
    read -r what <<<"$what"
    missing+=("$what")
    debian+=("${package// /}")
  done < <(needs)
}

list_missing_and_stop() {
  local i
  {
    echo "${0##*/}: $1."
    echo "Missing:"
    for i in "${!missing[@]}"; do printf '  %-22s (Debian: %s)\n' "${missing[i]}" "${debian[i]}"; done
    echo "On Debian 12 or 13, as root:  apt-get install ${debian[*]}"
    echo "Elsewhere install the same under the names it has there. Then run this again. If it is there, in a place not"
    echo "checked: export CMAKE_PREFIX_PATH=/that/place (CXX for the compiler)."
  } >&2
  exit 1
}

# apt_get WORD...: as root or through sudo, which requires a password only at a terminal.
apt_get() {
  local sudo=(sudo -n)
  if [[ -t 0 ]]; then sudo=(sudo); fi
  if ((EUID == 0)); then sudo=(); fi
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get -qq -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 -o Dpkg::Use-Pty=0 "$@"
}

# Missing optional packages never stop the build.
install_optional() {
  ((${#optional[@]})) || return 0
  if command -v apt-get >/dev/null && { ((EUID == 0)) || sudo -n true 2>/dev/null; }; then
    echo "== installing with apt: ${optional[*]}"
    apt_get update && apt_get install -y --no-install-recommends "${optional[@]}" && return
  fi
  echo "== not found, left out: ${optional[*]} (Debian's names; without Highway runs
take longer, without MPI ensembles run in one process, without pybind11-dev and python3-dev Python has no
cradle.Simulation, without Chromium tests do not inspect reports, without qemu-user they do not check older processors,
without MkDocs they do not build the manual's site)"
}

# set_up program|tests
set_up() {
  local missing debian optional
  search_for "$1"
  install_optional
  ((${#missing[@]})) || return 0
  command -v apt-get >/dev/null || list_missing_and_stop "something is missing and there is no apt to install it with"
  ((EUID == 0)) || command -v sudo >/dev/null ||
    list_missing_and_stop "something is missing and only root can install it (no sudo found)"
  echo "== installing with apt: ${debian[*]}"
  apt_get update || list_missing_and_stop "apt-get update failed (status $?, see above)"
  apt_get install -y --no-install-recommends "${debian[@]}" ||
    list_missing_and_stop "apt-get install failed (status $?, see above)"
  search_for "$1"
  ((${#missing[@]} == 0)) ||
    list_missing_and_stop "apt has installed its packages, but this is missing still or too old"
}

# configure OPTIONS...: configures the preset's build tree, with its present generator or else with an installed one.
configure() {
  local cached
  if cached=$(sed -n 's/^CMAKE_GENERATOR:INTERNAL=//p' "$build/CMakeCache.txt" 2>/dev/null) && [[ -n $cached ]]; then
    set -- -G "$cached" "$@"
  elif ! command -v ninja >/dev/null; then
    set -- -G "Unix Makefiles" "$@"
  fi
  step "configuring $build" "see CMake's message above; if the compiler, a library or the folder has moved since the \
last time, remove $build and run this again" \
    cmake --preset "$preset" "$@"
}

processors() { nproc 2>/dev/null || getconf _NPROCESSORS_ONLN; }

compile() {
  step "building $build on $(processors) processors" "see the first error above; if memory ran out, build with fewer \
processes: cmake --build --preset $preset -j1" \
    cmake --build --preset "$preset" -j "$(processors)" "$@"
}
