#!/usr/bin/env bash
# The decoder in JavaScript gives the same meshes as the native one, at every chunk's end:
#   decoder_test.sh PRINT_DIGESTS file:FILE.pmesh
#   decoder_test.sh PRINT_DIGESTS shape:NAME PMESH MAKE_SHAPE [OPTION...]   a generated mesh
#   decoder_test.sh PRINT_DIGESTS real:FILE PMESH MAKE_SHAPE [OPTION...]
#                                        FILE of $PMESH_TEST_MESHES; else skipped (77)
# OPTIONs are of `pmesh precompute`. Skipped, too, without Node.js or its package draco3d.
set -euo pipefail
print_digests=$1 source=$2 pmesh=${3:-} make_shape=${4:-}
options=("${@:5}")
here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

skip() {
  echo "skipped: $*"
  exit 77
}

precompute() {
  "$pmesh" precompute "$1" -o "$work/mesh.pmesh" --no-measure --quiet "${options[@]}"
  file=$work/mesh.pmesh
}

command -v node >/dev/null || skip "no Node.js; scripts/deps.sh test installs it"
[ -d "$here/node_modules/draco3d" ] || skip "no npm package draco3d; scripts/deps.sh test installs it"

case $source in
  file:*) file=${source#file:} ;;
  shape:*)
    "$make_shape" "${source#shape:}" "$work/shape.obj"
    precompute "$work/shape.obj"
    ;;
  real:*)
    mesh=${PMESH_TEST_MESHES:-}/${source#real:}
    [ -e "$mesh" ] || skip "PMESH_TEST_MESHES has no ${mesh##*/}"
    precompute "$mesh"
    ;;
esac

"$print_digests" "$file" >"$work/native"
node "$here/decode.js" "$file" >"$work/javascript"
diff "$work/native" "$work/javascript"
