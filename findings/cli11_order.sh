#!/usr/bin/env bash
# CLI11 lists what an option needs and excludes in the order of memory addresses.
#
# Version:   libcli11-dev 2.1.2+ds-1 (Debian 12)
# Guess:     one program prints the same help whenever it runs, in the order in which options were added or named.
# Behaviour: each option keeps the others in a set of pointers. What is listed after Needs: and Excludes:, and which of
#            several offending options an error names, depends on where malloc put them: on what the program freed before.
# Matters:   help that is compared with a copy (manual pages, completions, documentation, tests) differs now and
#            then where the heap differs, as with threads or another environment, and never while one looks for it.
# Seen on 2026-11-29:
#   help, with a fresh heap: --all Excludes: --a --b --c
#   help, after blocks were freed: --all Excludes: --c --b --a
#   error, with a fresh heap: --all excludes --a
#   error, after blocks were freed: --all excludes --c
. "$(dirname "$0")/common/packages.bash"
debian libcli11-dev=2.1.2+ds-1
command -v g++ >/dev/null || skip "no g++"

cat >tool.cpp <<'END'
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

// As any program that worked before: blocks of many sizes, which malloc gives out again from the highest address down.
static void free_blocks() {
  std::vector<std::unique_ptr<char[]>> blocks;
  for (int i = 0; i < 7; ++i)
    for (int size = 16; size <= 2048; size += 16) blocks.emplace_back(new char[size]);
  std::sort(blocks.begin(), blocks.end());
  for (auto& block : blocks) block.reset();
}

static void tell(bool frees) {
  if (frees) free_blocks();
  CLI::App app;
  auto* const all = app.add_flag("--all");
  auto* const a = app.add_flag("--a");
  auto* const b = app.add_flag("--b");
  auto* const c = app.add_flag("--c");
  all->excludes(a)->excludes(b)->excludes(c);
  const std::string help = app.help();
  const size_t at = help.find("--all Excludes:");
  std::puts(help.substr(at, help.find_last_not_of(" \n", help.find('\n', at)) + 1 - at).c_str());
  try {
    app.parse("--all --a --b --c");
  } catch (const CLI::ParseError& e) {
    std::puts(e.what());
  }
}

int main(int argc, char**) { tell(argc > 1); }
END
g++ -std=c++17 -O0 -I"$dir/root/usr/include" tool.cpp -o tool >build.log 2>&1 ||
  { cat build.log; skip "the tool does not build"; }
mapfile -t fresh < <(./tool)
mapfile -t freed < <(./tool freed)
expect "help, with a fresh heap" "${fresh[0]-}" "--all Excludes: --a --b --c"
expect "help, after blocks were freed" "${freed[0]-}" "--all Excludes: --c --b --a"
expect "error, with a fresh heap" "${fresh[1]-}" "--all excludes --a"
expect "error, after blocks were freed" "${freed[1]-}" "--all excludes --c"
finish
