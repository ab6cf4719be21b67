#!/usr/bin/env bash
# usage: scripts/test.sh [--all] [--preset PRESET] [ctest arguments...]
# Installs what is missing, builds and runs the tests; with --all the long ones (label `nightly`) too.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

preset=dev
filter=(--label-exclude nightly)
while (($#)); do
  case $1 in
    --all) filter=() && shift ;;
    --preset) preset=${2:?--preset needs a name} && shift 2 ;;
    *) break ;;
  esac
done

"$root/scripts/build.sh" "$preset"
ctest --test-dir "$root/build/$preset" --output-on-failure --parallel "$(nproc)" "${filter[@]}" "$@"
