#!/usr/bin/env bash
# One mesh through every verb: precompute, info, verify, extract, serve and fetch over HTTP and TCP,
# each fetched level of detail equal in bytes to the extracted one:
#   round_trip_test.sh PMESH MESH
#   round_trip_test.sh PMESH shape:NAME MAKE_SHAPE   a generated mesh
#   round_trip_test.sh PMESH real:FILE               FILE of $PMESH_TEST_MESHES; else skipped (77)
pmesh=$1 mesh=$2 make_shape=${3:-}
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

resolve_mesh() {
  case $mesh in
    shape:*)
      "$make_shape" "${mesh#shape:}" "$work/shape.obj"
      mesh=$work/shape.obj
      ;;
    real:*)
      mesh=${PMESH_TEST_MESHES:-}/${mesh#real:}
      [ -e "$mesh" ] || {
        echo "skipped: PMESH_TEST_MESHES has no ${mesh##*/}"
        exit 77
      }
      ;;
  esac
}

precompute() {
  "$pmesh" precompute "$mesh" -o "$file" --json --quiet >"$work/precompute.json"
  check '.faces > 0 and .base_faces > 0 and .base_faces <= .faces' "$work/precompute.json"
  check '.seconds | has("import") and has("clean") and has("decimate") and has("encode")
    and has("measure") and has("write") and has("total")' "$work/precompute.json"
  check '.cleaned | has("degenerate") and has("duplicate") and has("welded") and
    has("opposite_pairs") and has("nonmanifold_edges_cut") and has("winding_edges_cut") and
    has("nonmanifold_vertices_cut")' "$work/precompute.json"
  check '.peak_memory_bytes > 0 and .input_faces > 0 and .vertices > 0' "$work/precompute.json"
}

# The file is what `precompute --json` said, and its chunks are contiguous to its end.
inspect() {
  "$pmesh" info "$file" --json >"$work/info.json"
  check ".file_bytes == $(stat -c %s "$file")" "$work/info.json"
  check '(.hash | test("^[0-9a-f]{32}$")) and .metric == "blended-qem"' "$work/info.json"
  check '.errors_measured and ([.chunks[] | .max_error >= .rms_error and .rms_error >= 0] | all)' \
    "$work/info.json"
  check '[.chunks as $c | range(1; $c | length) | $c[.].offset == $c[. - 1].offset +
    $c[. - 1].bytes] | all' "$work/info.json"
  check '(.chunks | length) == 0 or (.chunks[-1] | .offset + .bytes) == .file_bytes' "$work/info.json"
  jq -s -e '.[0] as $made | .[1] as $read |
    ["faces", "vertices", "base_faces", "file_bytes", "quantization", "step"] |
    all(. as $key | $made[$key] == $read[$key])' "$work/precompute.json" "$work/info.json" \
    >/dev/null || fail "precompute --json and info --json disagree"
}

# At full resolution the file has exactly the triangles of the mesh, cleaned and quantised.
verify() {
  "$pmesh" verify "$file" --source "$mesh"
}

extract_all() {
  local wish
  for wish in "${wishes[@]}"; do
    # shellcheck disable=SC2086  # an option and its value
    "$pmesh" extract "$file" $wish -o "$work/$(name "$wish").ply" 2>/dev/null
  done
}

# A file name for a wish: "--faces 10" gives faces_10.
name() { tr -d '-' <<<"${1// /_}"; }

# fetch_all URL: every wish, then the whole file.
fetch_all() {
  local wish
  for wish in "${wishes[@]}"; do
    # shellcheck disable=SC2086
    "$pmesh" fetch "$1" $wish -o "$work/fetched.ply" --json >"$work/fetch.json" 2>/dev/null
    same "$work/fetched.ply" "$work/$(name "$wish").ply" "$1 $wish"
    rm "$work/fetched.ply"
  done
  "$pmesh" fetch "$1" -o "$work/fetched.pmesh" --json >"$work/fetch.json"
  same "$work/fetched.pmesh" "$file" "$1"
  rm "$work/fetched.pmesh"
}

# fetch_formats URL: a fetched mesh file is the extracted one in every format.
fetch_formats() {
  local ending
  for ending in obj glb drc; do
    "$pmesh" extract "$file" --ratio 0.5 -o "$work/extracted.$ending" 2>/dev/null
    "$pmesh" fetch "$1" --ratio 0.5 -o "$work/fetched.$ending" --quiet 2>/dev/null
    same "$work/fetched.$ending" "$work/extracted.$ending" "$1"
  done
}

# A prefix fetched for a coarse wish is continued, and becomes the file.
continue_prefix() {
  "$pmesh" fetch "http://$http/mesh" --ratio 0.3 -o "$work/grown.pmesh" --json >/dev/null 2>&1
  "$pmesh" fetch "tcp://$tcp/mesh" -o "$work/grown.pmesh" --json >/dev/null
  same "$work/grown.pmesh" "$file" "continued"
}

resolve_mesh
mkdir "$work/assets"
file=$work/assets/mesh.pmesh
wishes=("--ratio 1" "--ratio 0.5" "--ratio 0.05" "--faces 1000" "--faces 1" "--vertices 500"
  "--bytes 20000" "--error 1%" "--error 0")

precompute
inspect
verify
extract_all
fetch_all "$file"
start_server "$work/assets"
fetch_all "http://$http/mesh"
fetch_all "tcp://$tcp/mesh"
fetch_formats "http://$http/mesh"
continue_prefix
stop_server
