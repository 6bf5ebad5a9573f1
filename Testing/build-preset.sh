#!/usr/bin/env bash
# build-preset.sh PRESET [TARGET...]: installs what is missing, configures a preset of CMakePresets.json and builds it.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
preset="${1:?usage: build-preset.sh PRESET [TARGET...]}"
shift
targets=()
if (($# > 0)); then
  targets=(--target "$@")
fi
packages=(tests)
if [[ $preset == demo ]]; then
  packages=()
fi

# To be called when it is installed: a build that goes on with another launcher compiles everything anew.
use_compiler_cache()
{
  if command -v ccache > /dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache CMAKE_CUDA_COMPILER_LAUNCHER=ccache
    # Depend: or it would preprocess each file once more. The others let it serve every clone.
    export CCACHE_DEPEND=1 CCACHE_BASEDIR="$root" CCACHE_NOHASHDIR=1
  fi
}

# Most packages are ParaView's, and one core alone unpacks them: the others compile the simulator meanwhile, which needs none
# of them, nor of the tests'.
compile_ahead()
{
  Testing/install-dependencies.sh simulation
  use_compiler_cache
  local log
  log="$(mktemp)"
  echo "Installs ParaView, and compiles the simulator meanwhile; what apt says goes to $log"
  Testing/install-dependencies.sh "${packages[@]}" > "$log" 2>&1 &
  local apt=$!
  # Started so, it does not hear Ctrl-C. It is waited for, since it holds apt's lock.
  trap 'echo "Waits until apt is done." >&2; wait' EXIT
  cmake --preset "$preset" -DSONOVDB_BUILD_PLUGIN=OFF -DSONOVDB_BUILD_TESTING=OFF
  cmake --build --preset "$preset" --target Simulation
  local status=0
  wait "$apt" || status=$?
  trap - EXIT
  if ((status != 0)); then
    cat "$log" >&2
    exit "$status"
  fi
  rm "$log"
}

cd "$root" # where presets are looked up
if command -v pvpython > /dev/null; then
  Testing/install-dependencies.sh "${packages[@]}"
  use_compiler_cache
else
  compile_ahead
fi
cmake --preset "$preset"
cmake --build --preset "$preset" "${targets[@]}"
