#!/usr/bin/env bash
# Includes point one way: runner -> graphs -> nodes -> core. Fails and names each include that runs against it.
set -euo pipefail
cd "${1:?usage: check_layers.sh SOURCE_FOLDER}"

wrong=0
forbid() {
  if grep -rnE "#include \"($2)/" --include='*.cpp' --include='*.h' "$1"; then
    echo "^ $1 must not include from $2" >&2
    wrong=1
  fi
}
forbid core 'nodes|graphs|runner|tests'
forbid nodes 'graphs|runner|tests'
forbid graphs 'runner|tests'
forbid runner 'tests'

# Nothing in core knows JSON or the terminal.
if grep -rnE '#include <(nlohmann|CLI)/' --include='*.cpp' --include='*.h' core; then
  echo "^ core must know neither JSON nor the command line" >&2
  wrong=1
fi
exit $wrong
