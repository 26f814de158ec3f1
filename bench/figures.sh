#!/usr/bin/env bash
# Makes every figure: runs its scene, draws its pictures, prints the seconds of the run. Call it from the repository's
# folder, after tools/quickstart.sh:
#   bench/figures.sh [FOLDER]     default: out
#   bench/figures.sh FOLDER fig6  only some
set -euo pipefail
folder=${1:-out}
shift || true
cradle=$(realpath "${CRADLE:-build/release/tools/cradle}")
mkdir -p "$folder"
cd "$folder"
command_of() {
  case $1 in
    fig8 | cooling | scenarios | collapse_times) echo "sweep $1" ;;
    fig4-ensemble) echo "ensemble fig4 --replicas 200" ;;
    *) echo "run $1" ;;
  esac
}
for name in ${*:-fig1 fig2 fig3 fig4 fig5 fig6 fig7 fig8 fig9 fig9b fig10 fig11 cooling}; do
  read -ra words <<<"$(command_of "$name")"
  begin=$(date +%s.%N)
  "$cradle" "${words[@]}" -o "$name.h5" --quiet >/dev/null
  end=$(date +%s.%N)
  printf '%-16s %8.1f s   %s\n' "$name" "$(echo "$end - $begin" | bc)" "cradle ${words[*]}"
  "$cradle" plot "$name.h5" | sed 's/^/    /'
done
