#!/bin/sh
# Records the golden results anew, with the test program of a build folder (build unless another is given), after a
# node's results have changed and its version has been raised. Look at the difference before you commit it.
#   tests/golden/regenerate.sh [BUILD]
set -eu
source=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$source/build}
TERRAZZO_GOLDEN_RECORD=$source/tests/golden "$build/tests/terrazzo_tests" -tc="golden results:*"
git -C "$source" --no-pager diff --stat -- tests/golden
