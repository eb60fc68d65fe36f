#!/usr/bin/env bash
# Makes the pictures of examples/guide. Needs a build (examples/quickstart.sh).
set -euo pipefail
cd "$(dirname "$0")/../.."
out=examples/guide/pictures
made=out/guide-pictures

build/terrazzo run examples/guide/pictures.json --progress none --set "out=$made"
build/terrazzo run examples/guide/uv-picture.json --progress none --set "pictures=$made" --set "out=$made/uv.jpg"
mkdir -p "$out"
cp "$made"/{uv,guidance,lattice,streaks,evenness,heights}.jpg "$out"
ls "$out"
