#!/usr/bin/env bash
# Installs pmesh to a fresh prefix, builds the consumer beside this script against it, and has it
# read a file made by the installed program: install_test.sh CMAKE BUILD_DIR COMPILER MAKE_SHAPE.
set -euo pipefail
cmake=$1 build=$2 compiler=$3 make_shape=$4
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$cmake" --install "$build" --prefix "$work/prefix" >/dev/null
"$cmake" -S "$here/consumer" -B "$work/consumer" -G Ninja \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$compiler" >/dev/null
"$cmake" --build "$work/consumer"

"$make_shape" sphere "$work/sphere.obj"
"$work/prefix/bin/pmesh" precompute "$work/sphere.obj" -o "$work/sphere.pmesh" --quiet
"$work/consumer/consumer" "$work/sphere.pmesh" | tee "$work/output"
grep -q ' faces$' "$work/output"
