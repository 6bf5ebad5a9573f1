#!/usr/bin/env bash
# Builds everything and runs the fast tests; exits with ctest's status.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
"$root/Testing/build-preset.sh" release
exec ctest --test-dir "$root/build" --label-regex '^fast$' --output-on-failure --no-tests=error --parallel "$(nproc)"
