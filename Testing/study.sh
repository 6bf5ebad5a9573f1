#!/usr/bin/env bash
# study.sh [FOLDER] [PART...]: the phantom study, run time against error, stability and what each skip buys, measured
# and gathered in FOLDER/report.html (default: build-simulation/study). Takes under half an hour on two cores that do
# nothing else.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
"$root/Testing/build-preset.sh" simulation study >&2
folder="${1:-$root/build-simulation/study}"
"$root/build-simulation/bin/study" "$folder" "${@:2}"
echo "The report lies at $folder/report.html" >&2
