#!/usr/bin/env bash
# How `pmesh serve` is set: flags over environment over file, --check-config and --print-config; that
# a server takes what was printed; and the verbs beside it, sign and health:
# serve_settings_test.sh PMESH
pmesh=$1
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$work"
mkdir meshes
printed() { "$pmesh" serve --config config.json --print-config "$@" >printed.json; }

# Flags go before the environment, that before the file, that before the defaults.
echo '{"directory": "meshes", "threads": 1, "streams": 1, "ranges": 1}' >config.json
PMESH_THREADS=2 PMESH_STREAMS=2 printed --streams 3 --trusted-proxy 10.0.0.0/8 \
  --trusted-proxy ::1/128
check '.ranges == 1 and .threads == 2 and .streams == 3 and ."header-timeout" == 8' printed.json
check '."trusted-proxy" == ["10.0.0.0/8", "::1/128"] and .directory == "meshes"' printed.json

# What is printed can be fed back, and is the same again.
expect 0 "$pmesh" serve --config printed.json --print-config
same stdout printed.json
expect 0 env PMESH_CONFIG=printed.json "$pmesh" serve --check-config

# 2, with where what is wrong
expect 2 "$pmesh" serve --check-config
expect_message directory
expect 2 "$pmesh" serve meshes --threads x --check-config
expect_message '--threads: expected a whole number'
expect 2 env PMESH_THREADS=x "$pmesh" serve meshes --check-config
expect_message 'PMESH_THREADS: expected a whole number'
echo '{"directory": "meshes", "thread": 1}' >wrong.json
expect 2 "$pmesh" serve --config wrong.json --check-config
expect_message 'wrong.json: "thread" is no setting'
expect 2 "$pmesh" serve --config missing.json --check-config
expect_message missing.json
expect 2 "$pmesh" serve meshes --http here --check-config
expect 2 "$pmesh" serve meshes --no-such-flag

# A server with JSON logs; health says whether one is there.
start_json_server() {
  "$pmesh" serve meshes --http 127.0.0.1:0 --tcp 127.0.0.1:0 --log-format json 2>serve.log &
  server=$!
  for _ in $(seq 600); do
    http=$(address_of http)
    if [ -n "$http" ] && curl -fs "http://$http/health" >/dev/null; then return; fi
    sleep 0.1
  done
  fail "the server does not answer: $(cat serve.log)"
}
start_json_server
expect 0 "$pmesh" health "http://$http"
stop_server
expect 1 "$pmesh" health "http://$http"
expect 2 "$pmesh" health nonsense
jq -es 'length > 0 and all(has("time") and has("level") and has("message"))' serve.log >/dev/null ||
  fail "the log is not JSON: $(cat serve.log)"

# A signed URL is what another HMAC-SHA256 says.
printf '0123456789abcdef0123456789abcdef' >key
expect 0 "$pmesh" sign bunny --key key --lifetime 60 --server http://host/
url=$(cat stdout)
expires=${url#http://host/bunny?expires=} expires=${expires%%&*}
((expires > $(date +%s) && expires <= $(date +%s) + 60)) || fail "expires at $expires"
hmac=$(printf 'pmesh signed url\nbunny\n%s' "$expires" |
  openssl dgst -sha256 -hmac "$(cat key)" | sed 's/.* //')
[ "$url" = "http://host/bunny?expires=$expires&signature=$hmac" ] || fail "signed as $url"
expect 2 "$pmesh" sign 'no mesh' --key key
printf short >key
expect 2 "$pmesh" sign bunny --key key
