#!/usr/bin/env bash
# Installs the Debian packages that terrazzo needs to build, as far as they are missing. Arguments are further packages.
set -euo pipefail

packages=(cmake ninja-build g++ pkg-config libopenimageio-dev openimageio-tools libopencolorio-dev nlohmann-json3-dev
  libeigen3-dev libtbb-dev libcli11-dev libxxhash-dev libfmt-dev libzstd-dev libhwy-dev libimath-dev libpng-dev libpugixml-dev
  libarchive-dev libcpp-httplib-dev "$@")

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "installing ${missing[*]}" >&2
as_root=()
if [ "$(id -u)" -ne 0 ]; then as_root=(sudo); fi
"${as_root[@]}" apt-get update -qq
DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
