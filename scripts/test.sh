#!/usr/bin/env bash
# Everything that must hold before a change lands, from a clean clone on Debian 12; at most 30
# minutes on two cores. Any failing stage fails the script. Ends with the summary of the release
# tests. Meshes too large for the repository are used if their archive lies beside the clone.
set -euo pipefail
cd "$(dirname "$0")/.."

export LC_ALL=C.UTF-8
jobs=$(nproc)
summary=()

# stage NAME COMMAND...: runs a command and notes its minutes.
stage() {
  local name=$1 start=$SECONDS
  shift
  printf '\n== %s\n' "$name"
  failing=$name
  "$@"
  summary+=("$(printf '%-34s %5.1f min' "$name" "$(((SECONDS - start) * 10 / 60))e-1")")
}

trap '[ $? = 0 ] || echo "test.sh: failed in stage: ${failing:-start}" >&2' EXIT

unpack_meshes() {
  local unpack=../shared/meshes/unpack.sh
  if [ -n "${PMESH_TEST_MESHES:-}" ]; then return; fi
  if [ ! -e "$unpack" ]; then
    echo "no mesh archive: the tests on real meshes will be skipped"
    return
  fi
  if [ ! -e build/meshes/.complete ]; then
    mkdir -p build/meshes
    "$unpack" build/meshes
    touch build/meshes/.complete
  fi
  export PMESH_TEST_MESHES=$PWD/build/meshes
}

# build PRESET TARGET...
build() {
  cmake --preset "$1" >/dev/null
  cmake --build --preset "$1" --target "${@:2}"
}

# run_tests PRESET LABEL: without the real meshes, which the release tests cover.
run_tests() {
  env -u PMESH_TEST_MESHES ctest --test-dir "build/$1" -L "$2" -j "$jobs" \
    --no-tests=error --output-on-failure --progress
}

# run_one_test PRESET NAME
run_one_test() {
  ctest --test-dir "build/$1" -R "^$2\$" --no-tests=error --output-on-failure
}

stage "packages" scripts/deps.sh build test
stage "meshes" unpack_meshes
stage "format and lint" scripts/lint.sh
stage "release build" build release all
stage "asan build: fast tests" build asan tests_fast
stage "asan run: fast tests" run_tests asan fast
stage "asan build: soak" build asan pmesh soak make_sample
stage "asan run: soak" run_one_test asan soak
stage "tsan build: services tests" build tsan tests_services
stage "tsan run: services tests" run_tests tsan services

printf '\n== stages so far\n'
printf '%s\n' "${summary[@]}"
printf '\n== release tests\n'
exec ctest --test-dir build/release -j "$jobs" --no-tests=error --output-on-failure
