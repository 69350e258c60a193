#!/usr/bin/env bash
# The usual mistakes: each has its exit status and says on stderr what is wrong, and where:
# exit_codes_test.sh PMESH MAKE_SHAPE
pmesh=$1 make_shape=$2
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$work"

"$make_shape" sphere sphere.obj
expect 0 "$pmesh" precompute sphere.obj -o sphere.pmesh --quiet

# 0: help and version; a wish below the base, said on stderr
expect 0 "$pmesh" --help
expect 0 "$pmesh" --version
expect 0 "$pmesh" extract sphere.pmesh --faces 1 -o base.ply
[ -s stderr ] || fail "a wish that is not reached is not mentioned"

# 1: the world outside; nothing is overwritten without --force
expect 1 "$pmesh" precompute sphere.obj -o sphere.pmesh
expect_message sphere.pmesh
expect 0 "$pmesh" precompute sphere.obj -o sphere.pmesh --force --quiet
expect 1 "$pmesh" precompute missing.ply -o out.pmesh
expect_message missing.ply
expect 1 "$pmesh" info missing.pmesh
expect 1 "$pmesh" precompute sphere.obj -o no/such/folder/out.pmesh
expect 1 "$pmesh" fetch http://127.0.0.1:1/sphere -o out.ply

# 1: what was printed has not arrived
onto_full_disk() { "$@" >/dev/full; }
expect 1 onto_full_disk "$pmesh" info sphere.pmesh --json
expect_message 'standard output'
expect 1 onto_full_disk "$pmesh" verify sphere.pmesh
expect 1 onto_full_disk "$pmesh" --help
expect 1 onto_full_disk "$pmesh" precompute sphere.obj -o printed.pmesh --json
expect 3 onto_full_disk "$pmesh" info sphere.obj

# 2: usage
expect 2 "$pmesh"
expect 2 "$pmesh" polish
expect 2 "$pmesh" precompute sphere.obj
expect 2 "$pmesh" precompute sphere.obj -o out.pmesh --quantization 99
for tolerance in 0 -1 nan inf 1mm; do
  expect 2 "$pmesh" precompute sphere.obj -o out.pmesh "--tolerance=$tolerance"
  expect_message tolerance
done
expect 2 "$pmesh" precompute sphere.obj -o out.pmesh --tolerance 0.1 --quantization 12
expect_message tolerance
expect 2 "$pmesh" precompute sphere.obj -o out.pmesh --metric beauty
expect 2 "$pmesh" extract sphere.pmesh --faces 10 --ratio 0.5 -o out.ply
expect 2 "$pmesh" extract sphere.pmesh --faces ten -o out.ply
expect 2 "$pmesh" extract sphere.pmesh --faces 10 -o out.xyz
for error in -1 nan inf '1%%' 1e999 ''; do
  expect 2 "$pmesh" extract sphere.pmesh "--error=$error" -o out.ply
  expect 2 "$pmesh" fetch sphere.pmesh "--error=$error" -o out.ply
done
expect 2 "$pmesh" fetch 'tcp://127.0.0.1:1?sphere' -o out.ply

# 2: an output that would replace its own input, whatever --force says, or that has another's name
cp sphere.pmesh kept.pmesh
cp sphere.obj kept.obj
cp sphere.pmesh disguised.ply
ln sphere.obj linked.pmesh
expect 2 "$pmesh" precompute sphere.obj -o sphere.obj --force
expect_message sphere.obj
expect 2 "$pmesh" precompute sphere.obj -o linked.pmesh --force
expect 2 "$pmesh" precompute sphere.obj -o out.ply
expect_message .pmesh
expect 2 "$pmesh" fetch sphere.pmesh --faces 300 -o sphere.pmesh --force
expect 2 "$pmesh" extract disguised.ply --faces 300 -o ./disguised.ply
same sphere.obj kept.obj
same sphere.pmesh kept.pmesh
same disguised.ply kept.pmesh

# 3: input that breaks its format
printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n%s\n1 2\n' \
  $'property float z\nend_header' >short.ply
expect 3 "$pmesh" precompute short.ply -o out.pmesh
expect_message short.ply
printf 'v 0 0 0\nv 1 0 0\nf 1 2 9\n' >index.obj
expect 3 "$pmesh" precompute index.obj -o out.pmesh
expect_message 'line 3'
: >empty.stl
expect 3 "$pmesh" precompute empty.stl -o out.pmesh

# 3 and 4: every verb that reads a bad PM file gives the same status
expect_of_all() {
  expect "$1" "$pmesh" verify "$2"
  expect_message "$2"
  expect "$1" "$pmesh" extract "$2" -o out.ply
  expect_message "$2"
  expect "$1" "$pmesh" fetch "$2" --quiet -o out.ply
  expect_message "$2"
}

# altered OFFSET FILE: sphere.pmesh with eight other bytes at OFFSET
altered() {
  cp sphere.pmesh "$2"
  printf 'XXXXXXXX' | dd of="$2" bs=1 seek="$1" conv=notrunc status=none
}

"$pmesh" info sphere.pmesh --json >info.json
base=$(jq .prologue_bytes info.json)
first_chunk=$(jq '.chunks[0].offset' info.json)
last_chunk=$(jq '.chunks[-1].offset' info.json)

# 3: no PM file
expect 3 "$pmesh" info sphere.obj
expect_of_all 3 sphere.obj
altered 0 magic.pmesh
expect_of_all 3 magic.pmesh

# 4: PM files that are damaged or end before their base does; a part is fine for all but verify
head -c "$((first_chunk - 1))" sphere.pmesh >short.pmesh
expect_of_all 4 short.pmesh
for offset in 30 $((base - 8)) "$base" $((base + 50)) "$first_chunk" "$((last_chunk + 20))"; do
  altered "$offset" altered.pmesh
  expect_of_all 4 altered.pmesh
done
head -c "$((last_chunk + 20))" sphere.pmesh >part.pmesh
expect 4 "$pmesh" verify part.pmesh
expect_message bytes
expect 0 "$pmesh" extract part.pmesh --faces 500 -o part.ply

# 5: a limit, here that on the size of files
within_1_kib() { (ulimit -f 1 && "$@"); }
expect 5 within_1_kib "$pmesh" precompute sphere.obj -o out.pmesh --quiet
expect_message out.pmesh
expect 5 within_1_kib "$pmesh" extract sphere.pmesh -o out.ply
expect 5 within_1_kib "$pmesh" fetch sphere.pmesh --quiet -o out.pmesh

# on a terminal too, an error has a line of its own
script -qec "'$pmesh' precompute short.ply -o out.pmesh" /dev/null </dev/null >terminal || true
grep -q '%  import' terminal || fail "no progress on a terminal: $(cat terminal)"
grep -q '^pmesh precompute: short.ply' terminal || fail "errors share a line: $(cat terminal)"

# no failure left a file behind
for output in out.* .*.partial; do
  [ ! -e "$output" ] || fail "a failed command left $output"
done
