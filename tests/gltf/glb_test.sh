#!/usr/bin/env bash
# The GLB files of a mesh are valid, and both kinds hold the same mesh:
#   glb_test.sh WRITE_GLBS MAKE_SHAPE shape:NAME [OFFSET]   a generated mesh, moved by OFFSET
#   glb_test.sh WRITE_GLBS MAKE_SHAPE real:FILE             FILE of $PMESH_TEST_MESHES; else skipped (77)
# Skipped, too, without Node.js or the npm packages.
set -euo pipefail
write_glbs=$1 make_shape=$2 source=$3 offset=${4:-0}
here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

skip() {
  echo "skipped: $*"
  exit 77
}

command -v node >/dev/null || skip "no Node.js; scripts/deps.sh test installs it"
[ -d "$here/node_modules/gltf-validator" ] ||
  skip "no npm package gltf-validator; scripts/deps.sh test installs it"

case $source in
  shape:*)
    mesh=$work/shape.obj
    "$make_shape" "${source#shape:}" "$mesh"
    ;;
  real:*)
    mesh=${PMESH_TEST_MESHES:-}/${source#real:}
    [ -e "$mesh" ] || skip "PMESH_TEST_MESHES has no ${mesh##*/}"
    ;;
esac

lattice=$("$write_glbs" "$mesh" "$work" "$offset")
node "$here/check_glbs.js" "$work" "$lattice"
