#!/usr/bin/env bash
# docs/openapi.json is valid OpenAPI, and what a guarded server answers is what it says:
#   openapi_test.sh PMESH MAKE_SHAPE DOCUMENT
# Skipped (77) without Node.js or the npm packages.
# shellcheck disable=SC2034,SC2154  # $pmesh, $work, $http
pmesh=$1 make_shape=$2 document=$3
here=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/cli/lib.sh
. "$here/../cli/lib.sh"

skip() {
  echo "skipped: $*"
  exit 77
}

command -v node >/dev/null || skip "no Node.js; scripts/deps.sh test installs it"
[ -d "$here/node_modules/ajv" ] || skip "no npm package ajv; scripts/deps.sh test installs it"

mkdir "$work/assets"
"$make_shape" sphere "$work/sphere.obj"
"$pmesh" precompute "$work/sphere.obj" -o "$work/assets/sphere.pmesh" --quiet
token=$(head -c 32 /dev/urandom | sha256sum | cut -c 1-64)
echo "$token" >"$work/tokens"
head -c 32 /dev/urandom | sha256sum | cut -c 1-64 >"$work/key"

PMESH_TOKEN_FILE=$work/tokens PMESH_URL_KEY_FILE=$work/key start_server "$work/assets"
[ "$(curl -fs "http://$http/openapi.json")" = "$(cat "$document")" ] ||
  fail "/openapi.json is not $document"
node "$here/answers.js" "$document" "http://$http" "$token"
stop_server
