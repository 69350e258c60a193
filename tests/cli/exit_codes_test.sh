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

# 2: usage
expect 2 "$pmesh"
expect 2 "$pmesh" polish
expect 2 "$pmesh" precompute sphere.obj
expect 2 "$pmesh" precompute sphere.obj -o out.pmesh --quantization 99
expect 2 "$pmesh" precompute sphere.obj -o out.pmesh --metric beauty
expect 2 "$pmesh" extract sphere.pmesh --faces 10 --ratio 0.5 -o out.ply
expect 2 "$pmesh" extract sphere.pmesh --faces ten -o out.ply
expect 2 "$pmesh" extract sphere.pmesh --faces 10 -o out.xyz

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
expect 3 "$pmesh" info sphere.obj
expect 3 "$pmesh" extract sphere.obj --faces 10 -o out.ply

# 4: files that do not hold what they claim
half=$(($(stat -c %s sphere.pmesh) * 9 / 10))
head -c "$half" sphere.pmesh >cut.pmesh
expect 4 "$pmesh" verify cut.pmesh
head -c "$half" sphere.pmesh >altered.pmesh
printf 'XXXXXXXX' >>altered.pmesh
tail -c +"$((half + 9))" sphere.pmesh >>altered.pmesh
expect 4 "$pmesh" verify altered.pmesh

# no failure left a file behind
for output in out.*; do
  [ ! -e "$output" ] || fail "a failed command left $output"
done
