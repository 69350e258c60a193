#!/usr/bin/env bash
# What precompute is asked for in precision is what info shows: precision_test.sh PMESH MAKE_SHAPE
pmesh=$1 make_shape=$2
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$work"

# made OPTION...: the sphere's PM file; leaves what info says as info.json and info.txt.
made() {
  expect 0 "$pmesh" precompute sphere.obj -o sphere.pmesh --force --quiet --no-measure "$@"
  "$pmesh" info sphere.pmesh --json >info.json
  "$pmesh" info sphere.pmesh >info.txt
  expect 0 "$pmesh" verify sphere.pmesh --source sphere.obj
}

"$make_shape" sphere sphere.obj

made
check '.quantization == 11' info.json

made --quantization 16
check '.quantization == 16 and (.step * 65535 - ([.bbox.max, .bbox.min] | transpose |
  map(.[0] - .[1]) | max) | fabs < 1e-9)' info.json
shown=$(printf '%.6g' "$(jq .step info.json)")
grep -qx "quantization  16 bits, step $shown" info.txt || fail "info: $(cat info.txt)"

made --tolerance 0.001
check '.quantization == 11 and .step == 0.002' info.json
grep -qx 'quantization  11 bits, step 0.002' info.txt || fail "info: $(cat info.txt)"

expect 3 "$pmesh" precompute sphere.obj -o out.pmesh --tolerance 1e-12
expect_message 'sphere.obj: a tolerance of 1e-12 takes more than 30 bits a coordinate'
