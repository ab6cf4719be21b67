#!/usr/bin/env bash
# Installs what Parian is built and tested with, on Debian 12 or 13, from a bare system on. Asks apt only for what is
# missing; without anything missing it changes nothing and needs no network and no rights.
set -euo pipefail

packages=(
  # tools
  ca-certificates git cmake ninja-build g++ pkg-config python3 ccache clang-format
  # libraries
  libembree-dev libtbb-dev libopenimageio-dev libopencolorio-dev libtinygltf-dev libimath-dev libfmt-dev
  libcli11-dev nlohmann-json3-dev libdraco-dev libmeshoptimizer-dev
  # tests
  libgtest-dev libbenchmark-dev
  # the editor, and what its tests press its buttons with
  qt6-base-dev xvfb xdotool
)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat '${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  echo "setup: everything is installed"
  exit 0
fi

echo "setup: installing ${missing[*]}"
as_root=(env DEBIAN_FRONTEND=noninteractive)
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "setup: needs root or sudo to install: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo env DEBIAN_FRONTEND=noninteractive)
fi
install() { "${as_root[@]}" apt-get install --yes --quiet --no-install-recommends "${missing[@]}"; }
# The package lists are fetched only where they are absent or out of date.
if ! apt-cache show "${missing[@]}" >/dev/null 2>&1 || ! install; then
  "${as_root[@]}" apt-get update --quiet
  install
fi
