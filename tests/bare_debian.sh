# For tests that need a Debian which has nothing but what they put there, in a folder; to be sourced.

# skip REASON: the test cannot be made here.
skip() {
  echo "skipped: $1" >&2
  exit 77
}

# need_debian FOLDER: skips where none can be had; FOLDER: one that is there already, or nothing.
need_debian() {
  [ "$(id -u)" -eq 0 ] || skip "not root"
  command -v debootstrap >/dev/null || [ -n "$1" ] || skip "no debootstrap (apt-get install debootstrap)"
}

# inside ROOT COMMAND...: runs a command there, without a trace of this machine's environment.
inside() {
  local root
  root=$(realpath "$1")
  shift
  # Programs find what lies beside them through /proc.
  env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive unshare --mount --pid --fork \
    --mount-proc="$root/proc" chroot "$root" "$@"
}

# make_debian SUITE ROOT: a minimal system that reaches package servers as this machine does.
make_debian() {
  local log=$2.log
  debootstrap --variant=minbase "$1" "$2" >"$log" 2>&1 || skip "debootstrap failed: $(tail -1 "$log")"
  use_servers "$2"
}

# use_servers ROOT: what this machine needs to reach package servers.
use_servers() {
  cp -L /etc/resolv.conf "$1/etc/" 2>/dev/null || true
  [ ! -d /etc/apt/apt.conf.d ] || grep -l 'Acquire::' /etc/apt/apt.conf.d/* 2>/dev/null | xargs -r cp -t "$1/etc/apt/apt.conf.d"
}
