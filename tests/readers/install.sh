#!/usr/bin/env bash
# Gets the readers of the pages in this folder from the npm registry into the working folder; exit code 77 if it cannot.
# MaterialX' library comes in a package that needs parts of three.js which the newest has no more.
set -euo pipefail
npm install --silent --no-audit --no-fund three@0.187.0 three-older@npm:three@0.180.0 @needle-tools/materialx@1.4.6 >npm.log 2>&1 ||
  { echo "skipped: npm cannot get the readers: $(tail -1 npm.log)"; exit 77; }
