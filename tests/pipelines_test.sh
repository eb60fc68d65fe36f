#!/usr/bin/env bash
# What examples/guide/materials.md shows: five folders as downloaded, each with every preset, opened by the presets' readers,
# differ from the originals by no more than renderers do. Only in the long form of the tests: tests/run.sh -C long. Skips,
# with exit code 77, where a reader is missing.
# Usage: tests/pipelines_test.sh SOURCE_FOLDER PROGRAM
set -euo pipefail
source=$(realpath "${1:?usage: pipelines_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: pipelines_test.sh SOURCE_FOLDER PROGRAM}")
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-pipelines.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
export TERRAZZO_CACHE=$scratch/cache
TERRAZZO=$program OUT=$scratch PICTURE=$scratch/pipelines.jpg "$source/examples/guide/pipelines.sh"
test -s "$scratch/pipelines.jpg"
