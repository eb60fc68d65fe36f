#!/usr/bin/env bash
# The graph editor in a real browser: tests/editor/ drives headless Chromium through playwright-core. Skips, with exit
# code 77, where there is no Chromium, no npm, or it cannot reach the registry.
# Usage: tests/editor_test.sh SOURCE_FOLDER PROGRAM [PART_OF_A_SCENARIO_S_NAME]
set -euo pipefail
source=$(realpath "${1:?usage: editor_test.sh SOURCE_FOLDER PROGRAM}")
program=$(realpath "${2:?usage: editor_test.sh SOURCE_FOLDER PROGRAM}")
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
[ -n "$browser" ] || { echo "skipped: there is no Chromium (apt-get install chromium)"; exit 77; }
command -v npm >/dev/null || { echo "skipped: there is no npm to get the browser's driver with"; exit 77; }
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-editor.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
cp "$source"/tests/editor/package.json "$source"/tests/editor/package-lock.json .
npm ci --silent --no-audit --no-fund >npm.log 2>&1 || { echo "skipped: npm cannot get the driver: $(tail -1 npm.log)"; exit 77; }
node "$source/tests/editor/run.mjs" "$program" "$source" "$browser" "${3:-}"
