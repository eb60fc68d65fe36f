#!/usr/bin/env bash
# Packages of the program for machines that do not build it: a Debian package that names what it needs, and a tarball
# that runs from wherever it is unpacked, with all libraries but the C library's beside the program. Builds what is
# missing. Usage: examples/package.sh [BUILD_FOLDER [OUT_FOLDER]], build and out/package unless given.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
build=$(realpath -m "${1:-$here/build}")
out=$(realpath -m "${2:-$here/out/package}")
cd "$here"

examples/packages.sh patchelf dpkg-dev file
[ -f "$build/build.ninja" ] || cmake -S . -B "$build" -G Ninja -DTERRAZZO_TESTS=OFF -DTERRAZZO_PYTHON=OFF
targets=(terrazzo_program)
grep -q '^TERRAZZO_PYTHON:BOOL=ON' "$build/CMakeCache.txt" && targets+=(terrazzo_python)
cmake --build "$build" --target "${targets[@]}"

mkdir -p "$out"
rm -f "$out"/terrazzo_*.deb "$out"/terrazzo-*.tar.gz
cpack --config "$build/CPackConfig.cmake" -B "$out"
rm -rf "$out/_CPack_Packages"

version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
name=terrazzo-$version-linux-$(dpkg --print-architecture)
scratch=$(mktemp -d "${TMPDIR:-/tmp}/terrazzo-package.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
tree=$scratch/$name
cmake --install "$build" --prefix "$tree" --strip >/dev/null
rm -rf "$tree/lib/python3"  # it is for the system's Python and libraries: that is the Debian package's

# What the program and its modules load, less the C library and what belongs to it.
own=("$tree/bin/terrazzo" "$tree"/lib/libterrazzo.so.*.* "$tree"/lib/terrazzo/*.so)
belongs_to_system='^(linux-vdso|ld-linux.*|lib(c|m|dl|rt|pthread|resolv|util|anl|nsl))\.so'
LD_LIBRARY_PATH=$tree/lib ldd "${own[@]}" | awk '/=> \// { print $3 }' | sort -u >"$scratch/loaded"
libraries=()
while read -r library; do
  file=$(basename "$library")
  if [[ $library != "$tree"/* && ! $file =~ $belongs_to_system ]]; then libraries+=("$library"); fi
done <"$scratch/loaded"
cp -L "${libraries[@]}" "$tree/lib"
for library in "${libraries[@]}"; do
  file=$tree/lib/$(basename "$library")
  chmod u+w "$file"
  patchelf --set-rpath '$ORIGIN' "$file"
done
# Each keeps its licence. Debian knows a file by the path in its package, with /usr or without.
realpath "${libraries[@]}" | sed 's|^/usr/|/|' | sort -u >"$scratch/paths"
(cat "$scratch/paths"; sed 's|^|/usr|' "$scratch/paths") | xargs dpkg -S 2>/dev/null |
  sed -nE 's|^([^:, ]+)[^/]*: (/usr)?(/.*)$|\3 \1|p' | sort -u >"$scratch/owners" || true
join -a 1 "$scratch/paths" "$scratch/owners" | while read -r path package; do
  [ -f "/usr/share/doc/$package/copyright" ] || { echo "no licence was found for $path" >&2; exit 1; }
  mkdir -p "$tree/share/doc/terrazzo/libraries/$package"
  cp -L "/usr/share/doc/$package/copyright" "$tree/share/doc/terrazzo/libraries/$package"
done
patchelf --set-rpath '$ORIGIN' "$tree"/lib/libterrazzo.so.*.*
patchelf --set-rpath '$ORIGIN/..' "$tree"/lib/terrazzo/*.so

# Nothing may come from elsewhere.
! env -u LD_LIBRARY_PATH ldd "${own[@]}" "$tree"/lib/*.so* | awk '/not found/ { print } /=> \// { print $3 }' |
  grep -v "^$tree/" | grep -vE "/($(sed 's/^\^//' <<<"$belongs_to_system"))" | sort -u | grep . ||
  { echo "these libraries are not beside the program" >&2; exit 1; }

tar -C "$scratch" --sort=name --mtime=@"${SOURCE_DATE_EPOCH:-0}" --owner=0 --group=0 --numeric-owner -czf "$out/$name.tar.gz" "$name"
du -h "$out"/terrazzo_*.deb "$out/$name.tar.gz"
