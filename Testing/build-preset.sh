#!/usr/bin/env bash
# build-preset.sh PRESET [TARGET...]: installs what is missing, configures a preset of CMakePresets.json and builds it.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
preset="${1:?usage: build-preset.sh PRESET [TARGET...]}"
shift

if [[ $preset == demo ]]; then
  "$root/Testing/install-dependencies.sh"
else
  "$root/Testing/install-dependencies.sh" tests
fi

launcher=()
if command -v ccache > /dev/null; then
  launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi

# Presets are looked up in the current directory.
cd "$root"
cmake --preset "$preset" "${launcher[@]}"
targets=()
if (($# > 0)); then
  targets=(--target "$@")
fi
cmake --build --preset "$preset" "${targets[@]}"
