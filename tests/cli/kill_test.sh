#!/usr/bin/env bash
# precompute, killed at any moment, leaves no output file or a complete one; over an existing file,
# the old or the new one: kill_test.sh PMESH MAKE_SHAPE [KILLS]
pmesh=$1 make_shape=$2 kills=${3:-120}
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$work"

# Runs precompute to out.pmesh and kills it after $1 milliseconds.
run_and_kill() {
  "$pmesh" precompute torus.obj -o out.pmesh --force --quiet 2>/dev/null &
  local child=$!
  sleep "$(printf '%d.%03d' $(($1 / 1000)) $(($1 % 1000)))"
  kill -9 "$child" 2>/dev/null || finished=$((finished + 1))
  wait "$child" 2>/dev/null || true
}

"$make_shape" torus torus.obj
start=$(date +%s%N)
"$pmesh" precompute torus.obj -o whole.pmesh --quiet
span=$((($(date +%s%N) - start) / 1000000 + 2))  # milliseconds of a whole run

"$pmesh" precompute torus.obj -o old.pmesh --base-faces 1000 --quiet

finished=0
absent=0
for ((i = 0; i < kills; ++i)); do
  rm -f out.pmesh
  if ((i % 2 == 1)); then cp old.pmesh out.pmesh; fi
  run_and_kill $((span * i / kills))
  if [ -e out.pmesh ]; then
    cmp -s out.pmesh whole.pmesh || { ((i % 2 == 1)) && cmp -s out.pmesh old.pmesh; } ||
      fail "kill $i left a file that is neither the old nor the new one"
  else
    ((i % 2 == 0)) || fail "the old file is gone after kill $i"
    absent=$((absent + 1))
  fi
done
((absent > 0)) || fail "no kill came before the end: nothing was tested"
echo "$kills kills within $span ms: $absent left no file, $finished came after the end"

# leftovers of the killed runs do not disturb the next one
"$pmesh" precompute torus.obj -o out.pmesh --force --quiet
"$pmesh" verify out.pmesh
