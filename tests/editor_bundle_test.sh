#!/usr/bin/env bash
# The committed bundle of the graph editor is made from the sources beside it, and small enough.
# Usage: tests/editor_bundle_test.sh SOURCE_FOLDER
set -euo pipefail
web=$(realpath "${1:?usage: editor_bundle_test.sh SOURCE_FOLDER}")/runner/editor/web
digest=$("$web/sources.sh")
head -1 "$web/dist/app.js" | grep -q "Sources: $digest$" ||
  { echo "runner/editor/web/dist is older than its sources: run runner/editor/web/bundle.sh"; exit 1; }
size=$(cat "$web"/dist/* | gzip -9 | wc -c)
[ "$size" -le 409600 ] || { echo "the bundle has $size bytes gzipped, more than 400 KB"; exit 1; }
# The page's policy allows no scripts but its own file.
! grep -Eq 'new Function\(|[^a-zA-Z_.]eval\(' "$web/dist/app.js" || { echo "the bundle makes code from text"; exit 1; }
! grep -q '<script>' "$web/dist/index.html" || { echo "the page has a script of its own"; exit 1; }
echo "$size bytes gzipped"
