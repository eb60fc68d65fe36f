#!/usr/bin/env bash
# Makes the README's pictures. Needs a build (examples/quickstart.sh).
set -euo pipefail
cd "$(dirname "$0")/.."

for kind in bricks cobbles planks gravel; do
  echo "examples/pictures/$kind-result.jpg"
  build/terrazzo run examples/pictures.json --progress none --set "kind=$kind" --set out=examples/pictures
done
