#!/usr/bin/env bash
# Makes dist/ from the page's sources and its packages, with their licences at its head. Needs npm and the network;
# building terrazzo needs neither. Run it after a change of the sources or of the versions in package.json.
# With --check it also checks the types.
set -euo pipefail
cd "$(dirname "$0")"
here=$PWD
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-bundle.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
web=$scratch/editor/web
mkdir -p "$web" "$scratch/report/page" dist
cp -r package.json package-lock.json tsconfig.json build.mjs index.html src "$web"
cp ../../report/page/lit_material.ts "$scratch/report/page"
cd "$web"
npm ci --no-audit --no-fund --loglevel=error
[ "${1:-}" != --check ] || npm run --silent check
node build.mjs out
digest=$("$here/sources.sh")
{
  echo "/* The graph editor of terrazzo. Sources: $digest"
  echo " * Bundled with it:"
  for package in svelte @xyflow/svelte @xyflow/system @svelte-put/shortcut three d3-color d3-dispatch d3-drag d3-ease \
                 d3-interpolate d3-selection d3-timer d3-transition d3-zoom; do
    echo " *"
    echo " * $package $(node -p "require('./node_modules/$package/package.json').version"):"
    sed 's/^/ *   /; s/[[:space:]]*$//; s/\*\//* \//' node_modules/"$package"/LICENSE*
  done
  echo " */"
  cat out/app.js
} >"$here/dist/app.js"
cp out/app.css "$here/dist/app.css"
cp index.html "$here/dist/index.html"
cd "$here"
size=$(cat dist/* | gzip -9 | wc -c)
echo "$size bytes gzipped"
[ "$size" -le 409600 ] || { echo "the bundle is larger than 400 KB" >&2; exit 1; }
