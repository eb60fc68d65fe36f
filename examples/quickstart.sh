#!/usr/bin/env bash
# From a fresh clone to pictures: installs missing packages, builds, generates an exemplar, makes a larger material from
# it, and renders previews of both. A second run is quick, for every stage is cached.
set -euo pipefail
cd "$(dirname "$0")/.."

examples/packages.sh
[ -f build/build.ninja ] || cmake --preset release -DTERRAZZO_TESTS=OFF -DTERRAZZO_PYTHON=OFF
cmake --build build --target terrazzo_program

out=out/quickstart
export TERRAZZO_CACHE=$out/cache
build/terrazzo run graphs/generate-exemplar.json --set type=bricks --set size=512x512 --set "out=$out/exemplar"
build/terrazzo run examples/quickstart.json --set "material=$out/exemplar" --set "out=$out"

echo
echo "The exemplar, 512x512:        $out/exemplar/ (preview.png: lit from four sides)"
echo "The new material, 1024x1024:  $out/material/"
echo "The new material, lit:        $out/preview.png ($out/lights.png: from four sides)"
