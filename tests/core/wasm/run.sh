#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# run.sh BUILD_FOLDER: holds core as WebAssembly to core as it is here, on the tests' round organ.
set -euo pipefail
build=$1
root=$(cd "$(dirname "$0")/../../.." && pwd)
modules=$root/clients/viewer/web/node_modules
[[ -d $modules/h5wasm ]] || { echo "SKIPPED: npm could not fetch the packages that package-lock.json names"; exit 0; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
node "$root/tests/core/wasm/hostile.mjs" "$build/wasm" "$modules" "$scratch"
compare() { # NAME [ARGUMENTS OF write_round_organ]
  local name=$1
  shift
  "$build/tests/write_round_organ" "$scratch/$name.h5" "$@"
  "$build/tests/core_answers" "$scratch/$name.h5" "$scratch/$name"
  node "$root/tests/core/wasm/compare.mjs" "$build/wasm" "$modules" "$scratch/$name.h5" "$scratch/$name"
}
compare displacement
compare force 3 0.3 force
