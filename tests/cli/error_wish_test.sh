#!/usr/bin/env bash
# A wish for an error, on every way to a level of detail:
# error_wish_test.sh PMESH MAKE_SHAPE SET_ERRORS
# The errors are made up, so that it is known which chunk fulfils the wish.
pmesh=$1 make_shape=$2 set_errors=$3
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$work"

# fetch_all MESH: from MESH, a path or URL, every wish gives the mesh that `extract` has written.
fetch_all() {
  local wish
  for wish in "${near[@]}" 0; do
    expect 0 "$pmesh" fetch "$1" --error "$wish" -o fetched.ply --json
    same fetched.ply "error_$wish.ply" "$1 --error $wish"
    check ".reached == $([ "$wish" = 0 ] && echo false || echo true)" stdout
  done
}

# refuse VERB MESH: without measured errors the wish is a mistake of the user's, and nothing is written.
refuse() {
  local verb=$1 mesh=$2
  expect 2 "$pmesh" "$verb" "$mesh" --error 1 -o out.ply
  expect_message 'without measured errors'
  [ ! -e out.ply ] || fail "$verb $mesh wrote a mesh"
}

mkdir served
"$make_shape" sphere sphere.obj
"$pmesh" precompute sphere.obj -o made.pmesh --quiet
"$set_errors" made.pmesh served/mesh.pmesh 8 # 8, 4, 2 ...
"$set_errors" made.pmesh served/unmeasured.pmesh

# info tells the errors, or that there are none
"$pmesh" info served/mesh.pmesh --json >info.json
check '.errors_measured and .bbox_diagonal > 0 and .bbox_diagonal < 8' info.json
check '.chunks[0].max_error == 8 and .chunks[1].max_error == 4 and .chunks[1].rms_error == 2' info.json
"$pmesh" info served/mesh.pmesh | grep -q 'max_error *rms_error' || fail 'info shows no errors'
"$pmesh" info served/unmeasured.pmesh --json >unmeasured.json
check '.errors_measured == false and .bbox_diagonal > 0 and .chunks[0].max_error == null' \
  unmeasured.json
"$pmesh" info served/unmeasured.pmesh | grep -q 'errors not measured' || fail 'info hides it'

# extract: the first chunk's end that is near enough, however the wish is spelled
percent=$(jq '4.5 / .bbox_diagonal * 100' info.json)
near=(4 4.5 "$percent%")
"$pmesh" extract served/mesh.pmesh --bytes "$(jq '.chunks[1] | .offset + .bytes' info.json)" \
  -o second_chunk.ply
for wish in "${near[@]}"; do
  expect 0 "$pmesh" extract served/mesh.pmesh --error "$wish" -o "error_$wish.ply"
  same "error_$wish.ply" second_chunk.ply "--error $wish"
done

# extract: out of reach is everything, and said
"$pmesh" extract served/mesh.pmesh -o everything.ply
expect 0 "$pmesh" extract served/mesh.pmesh --error 0 -o error_0.ply
expect_message 'out of reach'
same error_0.ply everything.ply
head -c "$(jq '.chunks[1].offset' info.json)" served/mesh.pmesh >part.pmesh
expect 0 "$pmesh" extract part.pmesh --error 8 -o part.ply
[ ! -s stderr ] || fail "the part holds what was wished: $(cat stderr)"
expect 0 "$pmesh" extract part.pmesh --error 4 -o part.ply
expect_message 'out of reach'

start_server served
for mesh in served/mesh.pmesh "http://$http/mesh" "tcp://$tcp/mesh"; do
  fetch_all "$mesh"
done
refuse extract served/unmeasured.pmesh
for mesh in served/unmeasured.pmesh "http://$http/unmeasured" "tcp://$tcp/unmeasured"; do
  refuse fetch "$mesh"
done
stop_server
