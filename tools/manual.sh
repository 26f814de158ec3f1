#!/usr/bin/env bash
# Brings tools/README.md up to date: between the lines `<!-- output of: COMMAND -->` and `<!-- end -->` stands what
# COMMAND prints. With --check it changes nothing and says what differs (status 1).
#   tools/manual.sh [--check] [PROGRAM]      (default: build/release/tools/cradle)
set -euo pipefail
[[ ${1:-} == --check ]] && check=yes && shift || check=no
cradle=$(realpath "${1:-$(dirname "${BASH_SOURCE[0]}")/../build/release/tools/cradle}")
cd "$(dirname "${BASH_SOURCE[0]}")"

page() {
  local generated=no line
  while IFS= read -r line; do
    [[ $line == '<!-- end -->' ]] && generated=no
    [[ $generated == yes ]] || printf '%s\n' "$line"
    if [[ $line =~ ^'<!-- output of: cradle '(.*)' -->'$ ]]; then
      generated=yes
      read -ra words <<<"${BASH_REMATCH[1]}"
      printf '```text\n%s\n```\n' "$("$cradle" "${words[@]}")"
    fi
  done <README.md
}

new=$(page)
if [[ $check == yes ]]; then
  diff README.md - <<<"$new" || { echo "tools/README.md is not what the program prints: run tools/manual.sh PROGRAM" >&2; exit 1; }
else
  printf '%s\n' "$new" >README.md
fi
