#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# run.sh BUILD_FOLDER: holds core as WebAssembly to core as it is here, on the tests' round organ and a model for small machines.
set -euo pipefail
build=$1
root=$(cd "$(dirname "$0")/../../.." && pwd)
modules=$root/clients/viewer/web/node_modules
[[ -d $modules/h5wasm ]] || { echo "SKIPPED: npm could not fetch the packages that package-lock.json names"; exit 0; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
node "$root/tests/core/wasm/hostile.mjs" "$build/wasm" "$modules" "$scratch"
compare() { # NAME: of a model in scratch
  "$build/tests/core_answers" "$scratch/$1.h5" "$scratch/$1"
  node "$root/tests/core/wasm/compare.mjs" "$build/wasm" "$modules" "$scratch/$1.h5" "$scratch/$1"
}
"$build/tests/write_round_organ" "$scratch/displacement.h5"
compare displacement
"$build/tests/write_round_organ" "$scratch/force.h5" 3 0.3 force
compare force
# In 8 bits, with fewer modes for the higher orders; 83 modes, which are no whole number of vectors.
"$build/bin/palpate-organ" paper-liver -o "$scratch/organ.msh" --element-size 0.02 >/dev/null
"$build/bin/palpate-solve" "$scratch/organ.msh" -o "$scratch/compact.h5" --target handheld --order 2 --element-order 1 --modes 83 >/dev/null 2>&1
compare compact
