#!/usr/bin/env bash
# The packages that examples/package.sh makes, each in a Debian 12 that has nothing else: unpacked or installed, from a
# photo to glTF in one command, and stock graphs by name; the same bytes as here. Takes some minutes and the network.
# Exit code 77: not root, no debootstrap, or no Debian to be had.
# Usage: tests/package_test.sh SOURCE_FOLDER BUILD_FOLDER
# TERRAZZO_BARE_DEBIAN: a folder with such a system, from an earlier debootstrap; it stays as it is.
set -euo pipefail
source=$(realpath "${1:?usage: package_test.sh SOURCE_FOLDER BUILD_FOLDER}")
build=$(realpath "${2:?usage: package_test.sh SOURCE_FOLDER BUILD_FOLDER}")
. "$source/tests/bare_debian.sh"
need_debian "${TERRAZZO_BARE_DEBIAN:-}"
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-packages.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
failed=0

complain() {
  echo "$1" >&2
  failed=1
}

bare=${TERRAZZO_BARE_DEBIAN:-$scratch/bare}
[ -d "$bare" ] || make_debian bookworm "$bare"
inside "$bare" true || skip "no chroot"

# The commands of the guide, in a tree where they find what they name.
mkdir guide && cp -r "$source/examples" "$source/graphs" guide && ln -s "$build" guide/build
awk '/^```/ { open = ($0 == "```package"); next } open' "$source/examples/guide/programs.md" >commands
grep -q package.sh commands || complain "the guide does not say how packages are made"
(cd guide && bash -euo pipefail ../commands) >said 2>&1 || { complain "a command of programs.md failed: $(tail -5 said)"; exit 1; }
grep -q 'delight: Takes the light' said || complain "the unpacked program does not run here: $(tail -5 said)"
ln -s guide/out/package packages
if command -v lintian >/dev/null; then
  lintian --fail-on error packages/*.deb >said 2>&1 || complain "lintian: $(grep '^E' said)"
fi

# A photo, and what this machine makes of it.
export TERRAZZO_CACHE=$scratch/cache
cat >photo.json <<'GRAPH'
{"terrazzo": 1, "parameters": {"out": {"type": "path"}}, "nodes": {
  "wall": {"type": "pattern", "kind": "bricks", "size": 128, "tileable": false},
  "lit": {"type": "preview", "material": "@wall", "size": 128},
  "file": {"type": "export", "material": "@lit", "path": "$out/photo.jpg"}}}
GRAPH
"$build/terrazzo" run photo.json --set out="$scratch" --progress none 2>said || complain "no photo: $(cat said)"
# makes TERRAZZO PHOTO OUT: in one command each.
makes=(
  'TERRAZZO synth PHOTO -o OUT/gltf --engine gltf --size 160x96 --quality draft'
  'TERRAZZO synth PHOTO -o OUT/exr --format exr --size 96x96 --quality draft'
  'TERRAZZO run stock:texture --set image=PHOTO --set out=OUT/stock --set size=96x96 --set quality=draft --set format=tif')

# runs_in ROOT PROGRAM: all commands within ROOT.
runs_in() {
  local root=$1 program=$2 command
  cp photo.jpg "$root"
  for command in "${makes[@]}"; do
    command=${command//TERRAZZO/$program}
    command=${command//PHOTO//photo.jpg}
    command=${command//OUT//made}
    inside "$root" timeout 120 $command --progress none >said 2>&1 || complain "$root: $command: $(tail -3 said)"
  done
}
for command in "${makes[@]}"; do
  command=${command//TERRAZZO/$build/terrazzo}
  command=${command//PHOTO/$scratch/photo.jpg}
  ${command//OUT/$scratch/made} --progress none 2>said || complain "$command: $(cat said)"
done
compgen -G 'made/gltf/*.gltf' >/dev/null || complain "no glTF was made here: $(find made)"
pictures() {
  (cd "$1" && find . -name '*.png' -o -name '*.gltf' -o -name '*.tif' | sort | xargs sha256sum)
}
pictures made >expected
[ "$(wc -l <expected)" -ge 3 ] || complain "too little was made: $(cat expected)"

cp -a "$bare" with_tarball
tar -C with_tarball/opt -xzf packages/terrazzo-*.tar.gz
mkdir "with_tarball/some where"
mv with_tarball/opt/terrazzo-* "with_tarball/some where/else"
ln -s "some where/else/bin/terrazzo" with_tarball/terrazzo
runs_in with_tarball /terrazzo
pictures with_tarball/made | diff expected - || complain "the tarball's program made other files"
test -s with_tarball/made/exr/base_color.exr || complain "the tarball's program wrote no EXR"

cp -a "$bare" with_package
cp packages/*.deb with_package/terrazzo.deb
use_servers with_package
if inside with_package apt-get update >said 2>&1; then
  inside with_package apt-get install -y --no-install-recommends /terrazzo.deb >said 2>&1 ||
    complain "the package does not install: $(tail -5 said)"
  runs_in with_package terrazzo
  if grep -q '^TERRAZZO_PYTHON:BOOL=ON' "$build/CMakeCache.txt"; then
    inside with_package python3 -B -c 'import terrazzo; terrazzo.Graph.stock("texture")' >said 2>&1 ||
      complain "in Python: $(tail -3 said)"
  fi
  pictures with_package/made | diff expected - || complain "the package's program made other files"
  inside with_package apt-get remove -y terrazzo >said 2>&1 || complain "the package cannot be removed: $(tail -3 said)"
  [ -z "$(find with_package/usr -path '*terrazzo*' -not -name terrazzo.deb)" ] || complain "files stay after removal"
else
  [ $failed = 0 ] || exit 1
  skip "no package server: $(tail -1 said); the tarball is sound, but the Debian package"
fi
exit $failed
