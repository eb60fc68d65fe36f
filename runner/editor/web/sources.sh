#!/usr/bin/env bash
# Prints a digest of all that the bundle in dist/ is made from. bundle.sh stamps it into the bundle; a test compares.
set -euo pipefail
cd "$(dirname "$0")"
{
  find src -type f
  echo build.mjs; echo index.html; echo package.json; echo package-lock.json; echo tsconfig.json
  echo ../../report/page/lit_material.ts
} | LC_ALL=C sort | while read -r file; do
  echo "$file $(sha256sum <"$file")"
done | sha256sum | cut -d' ' -f1
