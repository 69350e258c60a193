#!/usr/bin/env bash
# pmesh compare: its JSON, its text, and its exit statuses: compare_test.sh PMESH MAKE_SHAPE
pmesh=$1 make_shape=$2
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$work"

"$make_shape" sphere sphere.obj
"$pmesh" precompute sphere.obj -o sphere.pmesh --quiet
"$pmesh" extract sphere.pmesh --faces 300 -o coarse.ply

# compare OUTPUT ARGUMENT...: the JSON of a comparison
compare() {
  "$pmesh" compare "${@:2}" --json >"$1" || fail "compare ${*:2}"
}

compare apart.json sphere.obj coarse.ply
check '(.forward, .backward) | has("max") and has("mean") and has("rms")' apart.json
check '.max >= .forward.max and .max >= .backward.max and .rms <= .max and .rms > 0' apart.json
check '(.max_relative * .bbox_diagonal / .max - 1) | fabs < 1e-9' apart.json
check '(.rms_relative * .bbox_diagonal / .rms - 1) | fabs < 1e-9' apart.json
check '.samples == 1000000 and .seed == 0' apart.json

# the same in every run, whatever the threads; both ways are the other way round for B and A
compare again.json sphere.obj coarse.ply --threads 3
same apart.json again.json
compare back.json coarse.ply sphere.obj
check "((.max / $(jq .max apart.json)) - 1) | fabs < 0.01" back.json

# other samples, nearly the same
compare few.json sphere.obj coarse.ply --samples 20000 --seed 7
check '.samples == 20000 and .seed == 7' few.json
check "(.rms / $(jq .rms apart.json) - 1) | fabs < 0.05" few.json

# no distance to itself; a PM file stands for the finest LOD that it holds
compare itself.json sphere.obj sphere.obj
check '.max == 0 and .rms == 0 and .max_relative == 0' itself.json
"$pmesh" extract sphere.pmesh -o finest.ply
compare finest.json finest.ply sphere.pmesh
check '.max_relative < 1e-6' finest.json
expect 0 "$pmesh" compare sphere.obj coarse.ply
grep -q 'A to B' stdout || fail "no table"

# what cannot be compared
expect 2 "$pmesh" compare sphere.obj
expect 2 "$pmesh" compare sphere.obj coarse.ply --samples 0
expect 1 "$pmesh" compare sphere.obj missing.ply
expect_message missing.ply
printf 'v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n' >nan.obj
expect 3 "$pmesh" compare sphere.obj nan.obj
expect_message nan.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\n' >empty.obj
expect 3 "$pmesh" compare empty.obj sphere.obj
expect_message empty.obj
printf 'v -1.7e308 0 0\nv 1.7e308 0 0\nv 0 1 0\nf 1 2 3\n' >huge.obj
expect 3 "$pmesh" compare sphere.obj huge.obj
expect_message huge.obj
head -c 100 sphere.pmesh >short.pmesh
expect 4 "$pmesh" compare sphere.obj short.pmesh
