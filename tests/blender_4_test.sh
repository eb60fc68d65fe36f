#!/usr/bin/env bash
# The add-on and exports in the Blender 4 of Debian 13, which has the program from the tarball of examples/package.sh. Takes
# some minutes and the network. Only in the long form of the tests: tests/run.sh -C long. Skips, with exit code 77, if it is
# not run by root, or there is no debootstrap or no Debian to be had.
# Usage: tests/blender_4_test.sh SOURCE_FOLDER BUILD_FOLDER
# TERRAZZO_BLENDER_4: a folder with such a system, from an earlier debootstrap; only its /root is written to.
set -euo pipefail
source=$(realpath "${1:?usage: blender_4_test.sh SOURCE_FOLDER BUILD_FOLDER}")
build=$(realpath "${2:?usage: blender_4_test.sh SOURCE_FOLDER BUILD_FOLDER}")
. "$source/tests/bare_debian.sh"
root=${TERRAZZO_BLENDER_4:-}
need_debian "$root"
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-blender-4.XXXXXX")
trap 'rm -rf "$scratch"' EXIT

if [ -z "$root" ]; then
  root=$scratch/debian
  make_debian trixie "$root"
  { inside "$root" apt-get update && inside "$root" apt-get install -y --no-install-recommends blender python3-numpy; } \
    >"$scratch/log" 2>&1 || skip "Blender cannot be installed: $(tail -1 "$scratch/log")"
fi
"$source/examples/package.sh" "$build" "$scratch/package" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }

work=$(mktemp -d "$root/root/terrazzo.XXXXXX")
trap 'rm -rf "$scratch" "$work"' EXIT
mkdir -p "$work/program" "$work/source/tests"
tar -C "$work/program" --strip-components=1 -xzf "$scratch"/package/terrazzo-*.tar.gz
cp -r "$source"/tests/{addon,readers,blender_test.sh,blender_addon_test.sh} "$work/source/tests"
within=${work#"$root"}

inside "$root" blender --version | head -1
inside "$root" "$within/program/bin/terrazzo" blender-addon -o "$within/addon.zip"
inside "$root" blender --command extension validate "$within/addon.zip" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
failed=0
for test in blender_addon blender; do
  inside "$root" "$within/source/tests/${test}_test.sh" "$within/source" "$within/program/bin/terrazzo" || failed=1
done
exit $failed
