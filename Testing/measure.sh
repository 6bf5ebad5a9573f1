#!/usr/bin/env bash
# measure.sh STAGE: builds what the stage needs (Release; the simulator alone where it is C++) and prints its figures, one
# `name value unit` a line. Everything else goes to the standard error. The stage `study` is all of Testing/study.sh, the
# stage `gpu` that of Testing/run-gpu.sh, for a machine that has a GPU.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
stages="$root/Testing/Benchmark/stages"

list_stages()
{
  echo "usage: measure.sh STAGE, with one of the stages"
  local file
  for file in "$stages"/*; do
    local name="${file##*/}"
    printf '  %-10s %s\n' "${name%.*}" "$(sed -n '1s,^\(//\|#\) *,,p' "$file")"
  done
  printf '  %-10s %s\n' gpu "What the stages cost on a GPU; see run-gpu.sh for a machine that only has a driver."
  printf '  %-10s %s\n' study "The phantom study, run time against error, programs of others and growth, with a report (26 minutes)."
}

stage="${1:-}"
if [[ $stage == study ]]; then
  exec "$root/Testing/study.sh"
fi
if [[ $stage == gpu ]]; then
  "$root/Testing/run-gpu.sh" pack >&2
  exec "$root/Testing/run-gpu.sh" benchmark
fi
if [[ $stage =~ ^[a-z]+$ && -f "$stages/$stage.py" ]]; then
  "$root/Testing/build-preset.sh" release SonoVDB vtkSonoFiltersPython vtkSonoWidgetsPython >&2
  export SONOVDB_PLUGIN="$root/build/lib/paraview-5.11/plugins/SonoVDB/SonoVDB.so"
  export PYTHONPATH="$root/build/lib/python3/dist-packages"
  export XDG_CACHE_HOME=/dev/null # what an earlier run has kept is no figure
  exec pvpython "$stages/$stage.py"
fi
if [[ ! $stage =~ ^[a-z]+$ || ! -f "$stages/$stage.cpp" ]]; then
  list_stages >&2
  exit 2
fi

"$root/Testing/build-preset.sh" simulation measure >&2
exec "$root/build-simulation/bin/measure" "$stage"
