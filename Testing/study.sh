#!/usr/bin/env bash
# study.sh [FOLDER] [PART...]: the phantom study, run time against error, programs of others, growth, stability and what each
# skip buys, measured and gathered in FOLDER/report.html (default: build-simulation/study), in 26 minutes on two cores that do
# nothing else. What programs of others are there: install-dependencies.sh tests --peers.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
"$root/Testing/build-preset.sh" simulation study >&2
folder="${1:-$root/build-simulation/study}"
"$root/build-simulation/bin/study" "$folder" "${@:2}"
echo "The report lies at $folder/report.html" >&2
