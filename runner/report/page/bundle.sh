#!/usr/bin/env bash
# Makes viewer.min.js from viewer.js, lit_material.ts and three, with three's licence at its head. Needs npm and the network; building
# terrazzo needs neither. Run it after a change of these or of the versions in package.json.
set -euo pipefail
cd "$(dirname "$0")"
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-bundle.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cp package.json package-lock.json viewer.js lit_material.ts "$scratch"
cd "$scratch"
npm ci --no-audit --no-fund --loglevel=error
{
  echo "/* three.js $(node -p 'require("./node_modules/three/package.json").version'), bundled with viewer.js."
  sed 's/^/ * /; s/ *$//' node_modules/three/LICENSE
  echo " */"
  # The ASCII charset and no "</script": the text stands inside an HTML page.
  npx esbuild viewer.js --bundle --minify --format=iife --target=es2022 --charset=ascii --legal-comments=none
} >viewer.min.js
if grep -q '</script' viewer.min.js; then
  echo "the bundle would end its script element" >&2
  exit 1
fi
cd - >/dev/null
mv "$scratch/viewer.min.js" viewer.min.js
ls -l viewer.min.js
