# Sourced by every finding. Makes a folder that goes away at the end, enters it, and fetches pinned packages into it.
# `expect` compares; `finish` ends with 0 if all was as stated, 1 if not. 77: the packages cannot be had.

set -uo pipefail
findings=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
dir=$(mktemp -d) || exit 77
trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 77
export HOME=$dir PYTHONPATH=$findings PYTHONDONTWRITEBYTECODE=1 TMPDIR=$dir
changed=0

skip() {
  echo "skipped: $*"
  exit 77
}

# debian NAME=VERSION...: what is not installed in that version is unpacked, with what it needs, beside the system's.
debian() {
  mkdir -p debs/partial root
  local get=(apt-get install --download-only --no-install-recommends --allow-downgrades -y -qq
    -o Debug::NoLocking=1 -o "Dir::Cache::archives=$dir/debs")
  "${get[@]}" "$@" >apt.log 2>&1 || { apt-get update -qq >apt.log 2>&1; "${get[@]}" "$@" >apt.log 2>&1; } ||
    skip "no $* among Debian's packages"
  local deb
  for deb in debs/*.deb; do
    [ ! -e "$deb" ] || dpkg -x "$deb" root || skip "$deb cannot be unpacked"
  done
  local libraries
  libraries=$(find root -name '*.so*' -printf "$dir/%h\n" | sort -u | paste -sd:)
  export PATH=$dir/root/usr/bin:$PATH
  [ -z "$libraries" ] || export LD_LIBRARY_PATH=$libraries
}

# node_packages NAME@VERSION...: scripts of packages are not run.
node_packages() {
  command -v npm >/dev/null || skip "no npm"
  echo '{"private": true, "type": "module"}' >package.json
  npm install --silent --no-audit --no-fund --ignore-scripts "$@" >npm.log 2>&1 || skip "no $* in the npm registry"
}

# expect WHAT GOT STATED
expect() {
  if [ "$2" = "$3" ]; then
    echo "$1: $2"
  else
    echo "$1: CHANGED, \"$3\" became \"$2\""
    changed=1
  fi
}

finish() { exit $changed; }
