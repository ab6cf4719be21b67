#!/usr/bin/env bash
# usage: scripts/render.sh [SCENE... -o OUT.exr [--display OUT.png] ...]
# Installs what is missing, builds, and renders: the arguments are those of `parian render`. Without any it renders a
# scene of the repository to out/cornell-box.exr and out/cornell-box.png.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$root/scripts/build.sh" release parian
if (($# == 0)); then
  mkdir -p "$root/out"
  set -- "$root/scenes/cornell-box/cornell-box.gltf" -o "$root/out/cornell-box.exr" \
    --display "$root/out/cornell-box.png" --size 512x512 --spp 256
  echo "render: $root/out/cornell-box.exr and .png"
fi
exec "$root/build/release/parian" render "$@"
