# Sourced by findings on libraries for web pages, in place of packages.bash.
. "$(dirname "${BASH_SOURCE[0]}")/packages.bash"

# web_packages NAME@VERSION...: npm's packages, and what bundles pages and shows them: the Chromium of Debian 12 without
# its security updates, of which only the last can be had.
web_packages() {
  local version=150.0.7871.100-1~deb12u1
  debian chromium=$version chromium-common=$version
  # Installed already: then nothing was unpacked.
  [ -e root/usr/lib/chromium ] || { mkdir -p root/usr/lib && ln -s /usr/lib/chromium root/usr/lib/chromium; }
  root/usr/lib/chromium/chromium --version >said 2>&1 || skip "chromium does not start: $(tail -n 1 said)"
  node_packages "$@" esbuild@0.28.2 playwright-core@1.65.1
  cp "$findings"/bundle.mjs "$findings"/page.mjs .
}

# bundle LIBRARY...: from LIBRARY.js, which fills the page's <main>.
bundle() { node bundle.mjs "${@/%/.js}" >said 2>&1 || skip "the pages cannot be bundled: $(head -n 3 said)"; }

# look LIBRARY WORD...: runs look.mjs, which imports the page. Says what it said last, or why it failed.
look() { timeout 120 node look.mjs "$@" 2>&1 </dev/null | tail -n 1; }
