#!/bin/sh
# Records the golden results anew, with the test program of a build folder (build unless another is given), after a
# node's results have changed and its version has been raised, or to add new cases. Look at the difference before you
# commit it. GROUP: only the tests whose names hold this text, such as sources, analysis, synthesis, lattices, sinks or
# stock: quicker, and nothing else is recorded.
#   tests/golden/regenerate.sh [BUILD [GROUP]]
set -eu
source=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$source/build}
TERRAZZO_GOLDEN_RECORD=$source/tests/golden "$build/tests/terrazzo_tests" -tc="golden results:*${2:-}*"
git -C "$source" --no-pager diff --stat -- tests/golden
