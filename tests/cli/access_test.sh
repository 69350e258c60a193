#!/usr/bin/env bash
# A guarded server: tokens, signed URLs, and taking them back by SIGHUP; a configuration that went
# wrong changes nothing: access_test.sh PMESH MAKE_SHAPE
pmesh=$1 make_shape=$2
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$work"

"$make_shape" torus torus.obj
mkdir meshes
"$pmesh" precompute torus.obj -o meshes/torus.pmesh --quiet
printf 'first-token-0123456789\n' >tokens
printf '0123456789abcdef0123456789abcdef' >key
export PMESH_TOKEN_FILE=$work/tokens PMESH_URL_KEY_FILE=$work/key
PMESH_ACCESS_LOG=true start_server meshes

# status TARGET CURL_OPTION...
status() {
  local target=$1
  shift
  curl -s -o answer -w '%{http_code}' "$@" "http://$http$target"
}
# answers STATUS TARGET CURL_OPTION...
answers() {
  local wanted=$1 got
  shift
  got=$(status "$@")
  [ "$got" = "$wanted" ] || fail "$got instead of $wanted: $*"
}
# reload WORDS: SIGHUP, until the log has them once more.
reload() {
  local before
  before=$(grep -c "$1" serve.log || true)
  kill -HUP "$server"
  for _ in $(seq 100); do
    if [ "$(grep -c "$1" serve.log)" -gt "$before" ]; then return; fi
    sleep 0.1
  done
  fail "no '$1' in the log: $(cat serve.log)"
}

first='Authorization: Bearer first-token-0123456789'
second='Authorization: Bearer second-token-0123456789'
answers 200 /health
answers 401 /catalog
answers 401 /torus
answers 401 /torus -H "$second"
curl -sI "http://$http/torus" | grep -qi '^www-authenticate: bearer' || fail "no challenge"
answers 200 /catalog -H "$first"
answers 200 /torus -H "$first"
url=$(jq -r .url answer)
curl -sI -H "$first" "http://$http$url" | grep -i '^cache-control:' | grep -q private ||
  fail "a guarded file may not be public to caches"

query=$("$pmesh" sign torus --key key --lifetime 600)
answers 200 "/torus?$query"
answers 200 "$url?faces=100&$query"
answers 200 "$url?$query&faces=100"
answers 403 "/other?$query"
answers 403 "/torus?${query%?}x"
answers 403 "/torus?expires=1&${query#*&}"
answers 400 "/torus?$query&$query"
grep -q "answered.*/torus?expires=[0-9]*&signature=\.\.\." serve.log || fail "no answer in the log"
if grep -q 'signature=[0-9a-f]' serve.log; then fail "a signature in the log"; fi

# Tokens are exchanged, without a dropped server; what is wrong changes nothing.
printf 'second-token-0123456789\n' >tokens
reload reload
answers 401 /torus -H "$first"
answers 200 /torus -H "$second"
: >tokens
reload tokens
answers 200 /torus -H "$second"
answers 401 /torus
stop_server
