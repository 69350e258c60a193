#!/usr/bin/env bash
# Runs the fuzz targets under ASan and UBSan, with clang:
#   scripts/fuzz.sh TARGET SECONDS      one target for so long; `all`: each of them
#   scripts/fuzz.sh mutations COUNT     decodes so many mutated PM files
# Targets are tests/fuzz/fuzz_*.cpp without `fuzz_`. What is found along the way stays in
# build/fuzz/corpus; an input that fails is named and kept in build/fuzz/finds.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C.UTF-8

usage() {
  sed -n '3,4s/^# *//p' "$0" >&2
  exit 2
}
[[ $# = 2 && $2 =~ ^[0-9]+$ ]] || usage
target=$1
amount=$2
if [[ $target != all && $target != mutations && ! -e tests/fuzz/fuzz_$target.cpp ]]; then usage; fi

# build TARGET...
build() {
  cmake --preset fuzz >/dev/null
  cmake --build --preset fuzz --target "$@"
  mkdir -p build/fuzz/finds
}

# fuzz TARGET SECONDS
fuzz() {
  mkdir -p "build/fuzz/corpus/$1"
  "build/fuzz/tests/fuzz/fuzz_$1" -max_total_time="$2" -timeout=5 -max_len=16384 \
    -print_final_stats=1 -artifact_prefix="build/fuzz/finds/$1-" \
    "build/fuzz/corpus/$1" "tests/fuzz/seeds/$1"
}

case $target in
  mutations)
    build mutate_files
    exec build/fuzz/tests/fuzz/mutate_files --count "$amount" --last build/fuzz/finds/last \
      tests/golden
    ;;
  all)
    build fuzz_targets
    for source in tests/fuzz/fuzz_*.cpp; do
      name=$(basename "$source" .cpp)
      fuzz "${name#fuzz_}" "$amount"
    done
    ;;
  *)
    build "fuzz_$target"
    fuzz "$target" "$amount"
    ;;
esac
