#!/usr/bin/env bash
# A server with TLS: all three protocols inside it, what is no TLS, a certificate that is exchanged by
# SIGHUP, and the access log: tls_test.sh PMESH MAKE_SHAPE
pmesh=$1 make_shape=$2
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$work"

# certificate NAME: NAME.pem and NAME.key, signed by itself, good for 127.0.0.1.
certificate() {
  openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj "/CN=$1" \
    -addext subjectAltName=IP:127.0.0.1 -keyout "$1.key" -out "$1.pem" 2>/dev/null
}

# wait_for WORDS: until the log has them.
wait_for() {
  for _ in $(seq 100); do
    if grep -q "$1" serve.log; then return; fi
    sleep 0.1
  done
  fail "no '$1' in the log: $(cat serve.log)"
}

"$make_shape" torus torus.obj
mkdir meshes
"$pmesh" precompute torus.obj -o meshes/torus.pmesh --quiet
certificate first
certificate second
cp first.pem tls.pem
cp first.key tls.key
"$pmesh" serve meshes --http 127.0.0.1:0 --tcp 127.0.0.1:0 --tls-certificate tls.pem --tls-key tls.key \
  --header-timeout 0.5 --access-log true 2>serve.log &
server=$!
wait_for 'TCP on tcps://'
http=$(address_of https) tcp=$(address_of tcps)

for url in "https://$http/torus" "wss://$http/torus" "tcps://$tcp/torus"; do
  "$pmesh" fetch "$url" --ca first.pem -o fetched.pmesh --force --quiet
  same fetched.pmesh meshes/torus.pmesh "$url"
  expect 1 "$pmesh" fetch "$url" --ca second.pem -o other.pmesh --force --quiet
done
curl -fs --cacert first.pem "https://$http/torus/lod.glb?faces=100" | head -c 4 | grep -q glTF ||
  fail "no level of detail inside TLS"

# Many requests on one connection, and one that is no TLS.
curl -fs --cacert first.pem "https://$http/torus?[1-200]" -o /dev/null || fail "keep-alive"
curl -s "http://$http/health" >plain && fail "plain HTTP was answered: $(cat plain)"

# A handshake that does not go on, and a header that does not: both are ended in time.
for sent in '\x16\x03' ''; do
  exec 3<>"/dev/tcp/${http%:*}/${http#*:}"
  printf "$sent" >&3
  timeout 5 cat <&3 >/dev/null || fail "a silent connection is kept"
  exec 3>&-
done
(printf 'GET / HT' && sleep 2) | openssl s_client -quiet -connect "$http" 2>/dev/null |
  grep -q 408 || fail "no 408"
wait_for 'status=408'
wait_for 'status=200'

cp second.pem tls.pem
cp second.key tls.key
kill -HUP "$server"
wait_for reloaded
curl -fs --cacert second.pem "https://$http/health" >/dev/null || fail "the new certificate"
stop_server
