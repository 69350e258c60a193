#!/usr/bin/env bash
# Runs the fuzz targets under ASan and UBSan, with clang:
#   scripts/fuzz.sh MINUTES [TARGET...]   each target for so long, or those named
#   scripts/fuzz.sh mutations COUNT       decodes so many mutated PM files
# Targets are tests/fuzz/fuzz_*.cpp without `fuzz_`. What is found along the way stays in
# build/fuzz/corpus; an input that fails is named and kept in build/fuzz/finds.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C.UTF-8

usage() {
  sed -n '3,4s/^# *//p' "$0" >&2
  exit 2
}
[[ $# -ge 1 ]] || usage

cmake --preset fuzz >/dev/null
cmake --build --preset fuzz
mkdir -p build/fuzz/finds

if [[ $1 = mutations ]]; then
  [[ $# = 2 ]] || usage
  exec build/fuzz/tests/fuzz/mutate_files --count "$2" --last build/fuzz/finds/last tests/golden
fi

[[ $1 =~ ^[0-9]+$ ]] || usage
minutes=$1
shift
targets=("$@")
if [[ $# = 0 ]]; then
  mapfile -t targets < <(cd tests/fuzz && printf '%s\n' fuzz_*.cpp | sed 's/^fuzz_//; s/\.cpp$//')
fi
for target in "${targets[@]}"; do
  mkdir -p "build/fuzz/corpus/$target"
  "build/fuzz/tests/fuzz/fuzz_$target" -max_total_time=$((60 * minutes)) -timeout=5 -max_len=16384 \
    -print_final_stats=1 -artifact_prefix="build/fuzz/finds/$target-" \
    "build/fuzz/corpus/$target" "tests/fuzz/seeds/$target"
done
