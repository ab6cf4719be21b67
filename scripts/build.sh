#!/usr/bin/env bash
# usage: scripts/build.sh [PRESET [TARGET...]]
# Installs what is missing and builds, by default everything of the preset `release`, in build/PRESET.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
preset=${1:-release}
shift || true

"$root/scripts/setup.sh"
cmake -S "$root" --preset "$preset"
cmake --build "$root/build/$preset" --target "${@:-all}"
