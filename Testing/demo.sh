#!/usr/bin/env bash
# Builds the plugin alone and simulates the apical four-chamber view of the bundled thorax phantom.
# Arguments are passed on to Plugin/examples/simulate.py.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
"$root/Testing/build-preset.sh" demo

plugin="$(find "$root/build" -name SonoVDB.so -print -quit)"
if [[ -z $plugin ]]; then
  echo "demo.sh: the build made no SonoVDB.so under $root/build." >&2
  exit 1
fi

picture="$root/build/a4c.png"
SONOVDB_PLUGIN="$plugin" pvpython "$root/Plugin/examples/simulate.py" --output "$picture" "$@"

# A later --output overrides ours.
while (($# > 0)); do
  case "$1" in
    --output) picture="${2:-}" ;;
    --output=*) picture="${1#--output=}" ;;
  esac
  shift
done
if [[ ! -s $picture ]]; then
  echo "demo.sh: simulate.py left no picture at $picture." >&2
  exit 1
fi
echo "The picture lies at $picture"
