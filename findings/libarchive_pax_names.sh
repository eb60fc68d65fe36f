#!/usr/bin/env bash
# libarchive renames files of pax archives: a decomposed accent becomes a composed one, in UTF-8 locales only.
#
# Version:   libarchive-tools 3.6.2-1+deb12u5 (Debian 12); tar as it is installed
# Guess:     a name in a pax header is bytes of UTF-8, and a file is unpacked under just these bytes in a UTF-8 locale.
# Behaviour: a u and a combining diaeresis (75 cc 88), as macOS writes it, becomes one letter (c3 bc). In locale C the name
#            stays, and so does one without a pax header. What is packed depends on the locale too: bsdtar's default, pax
#            only where needed, gives other bytes for the same folder. GNU tar keeps the name, and its form of tar holds it
#            as it is.
# Matters:   a graph or a scene in an archive names its textures by the bytes of the one who packed them: on Linux they are
#            missing after bsdtar has unpacked them, or a program that calls libarchive after setlocale.
# Seen on 2026-11-27:
#   bsdtar, C.UTF-8: c3bc
#   bsdtar, C: 75cc88
#   bsdtar, C.UTF-8, no pax header: 75cc88
#   tar, C.UTF-8: 75cc88
#   packed in C and in C.UTF-8: other bytes
#   as gnutar: the same bytes
. "$(dirname "$0")/common/packages.bash"
debian libarchive-tools=3.6.2-1+deb12u5 libarchive13=3.6.2-1+deb12u5

python3 - <<'PY' || skip "no Python"
import io, tarfile
name = "u\u0308"
for form in ("PAX", "USTAR"):
    with tarfile.open(f"{form}.tar", "w", format=getattr(tarfile, form + "_FORMAT"), encoding="utf-8") as archive:
        archive.addfile(tarfile.TarInfo(name), io.BytesIO())
PY
bsdtar --version >/dev/null || skip "bsdtar does not start"

# name_after LOCALE TOOL ARCHIVE: the bytes of the name that the file gets.
name_after() {
  rm -rf out && mkdir out
  LC_ALL=$1 "$2" -C out -xf "$3" 2>/dev/null
  python3 -c 'import os; print(os.listdir(b"out")[0].hex())'
}
expect "bsdtar, C.UTF-8" "$(name_after C.UTF-8 bsdtar PAX.tar)" "c3bc"
expect "bsdtar, C" "$(name_after C bsdtar PAX.tar)" "75cc88"
expect "bsdtar, C.UTF-8, no pax header" "$(name_after C.UTF-8 bsdtar USTAR.tar)" "75cc88"
expect "tar, C.UTF-8" "$(name_after C.UTF-8 tar PAX.tar)" "75cc88"

mkdir in && python3 -c 'open(b"in/u\xcc\x88", "w")'
packed() { LC_ALL=$1 bsdtar "${@:2}" -cf - -C in . 2>/dev/null | sha256sum; }
compared() { if [ "$(packed C "$@")" = "$(packed C.UTF-8 "$@")" ]; then echo "the same bytes"; else echo "other bytes"; fi; }
expect "packed in C and in C.UTF-8" "$(compared)" "other bytes"
expect "as gnutar" "$(compared --format gnutar)" "the same bytes"
finish
