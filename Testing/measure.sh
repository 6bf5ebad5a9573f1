#!/usr/bin/env bash
# measure.sh STAGE: builds the simulator (Release, without VTK) and prints the stage's figures, one `name value unit`
# a line. Everything else goes to the standard error. The stage `study` is all of Testing/study.sh.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
stages="$root/Testing/Benchmark/stages"

list_stages()
{
  echo "usage: measure.sh STAGE, with one of the stages"
  local file
  for file in "$stages"/*.cpp; do
    printf '  %-8s %s\n' "$(basename "$file" .cpp)" "$(sed -n '1s|^// *||p' "$file")"
  done
  printf '  %-8s %s\n' study "The phantom study and run time against error, with a report (a quarter of an hour)."
}

stage="${1:-}"
if [[ $stage == study ]]; then
  exec "$root/Testing/study.sh"
fi
if [[ ! $stage =~ ^[a-z]+$ || ! -f "$stages/$stage.cpp" ]]; then
  list_stages >&2
  exit 2
fi

"$root/Testing/build-preset.sh" simulation measure >&2
exec "$root/build-simulation/bin/measure" "$stage"
