#!/usr/bin/env bash
# Updates the pages of tools/manual/: between the lines `<!-- output of: COMMAND -->` and `<!-- end -->` stands what
# COMMAND prints. With --check it changes nothing and prints what differs (status 1).
#   tools/manual.sh [--check] [PROGRAM]      (default: build/release/tools/cradle)
set -euo pipefail
[[ ${1:-} == --check ]] && check=yes && shift || check=no
cradle=$(realpath "${1:-$(dirname "${BASH_SOURCE[0]}")/../build/release/tools/cradle}")
cd "$(dirname "${BASH_SOURCE[0]}")/manual"

updated() {
  local generated=no line
  while IFS= read -r line; do
    [[ $line == '<!-- end -->' ]] && generated=no
    [[ $generated == yes ]] || printf '%s\n' "$line"
    if [[ $line =~ ^'<!-- output of: cradle '(.*)' -->'$ ]]; then
      generated=yes
      read -ra words <<<"${BASH_REMATCH[1]}"
      printf '```text\n%s\n```\n' "$("$cradle" "${words[@]}")"
    fi
  done <"$1"
}

for page in *.md; do
  new=$(updated "$page")
  if [[ $check == no ]]; then
    printf '%s\n' "$new" >"$page"
  elif ! diff "$page" - <<<"$new"; then
    echo "tools/manual/$page is not what the program prints: run tools/manual.sh PROGRAM" >&2
    exit 1
  fi
done
