#!/usr/bin/env bash
# Three replicas behind HAProxy with docker/scale/haproxy.cfg. The busiest is killed by SIGKILL under
# load, and no client sees a failure: haproxy_test.sh PMESH MAKE_SAMPLE
pmesh=$1 make_sample=$2
# shellcheck source=tests/scale/lib.sh
. "$(dirname "$0")/lib.sh"
need haproxy python3

seconds=8
make_meshes 6
declare -A replicas
for name in a b c; do
  start_replica
  replicas[$name]=$replica
  declare "http_$name=$http"
done
port=$(free_port)
# shellcheck disable=SC2154  # http_a
fill "$scale/haproxy.cfg" "$work/haproxy.cfg" "bind :8080" "bind 127.0.0.1:$port" \
  pmesh-a:8080 "$http_a" pmesh-b:8080 "$http_b" pmesh-c:8080 "$http_c" \
  "maxconn 20000" "maxconn 200
  stats socket $work/stats"
start_daemon "$port" haproxy -db -f "$work/haproxy.cfg"

# Dead replicas answer nobody: the first of the three, which answers what is right, lives on.
clients load "http://127.0.0.1:$port" "http://127.0.0.1:$port" "$work/meshes" $seconds \
  >"$work/load.json" 2>"$work/faults" &
load=$!
until grep -q started "$work/faults" || ! kill -0 "$load" 2>/dev/null; do sleep 0.1; done
sleep $((seconds / 2))
victim=$(clients busiest "$work/stats")
kill -9 "${replicas[$victim]}"
echo "killed replica $victim"
wait "$load" || {
  head "$work/faults" >&2
  fail "clients saw failures: $(cat "$work/load.json")"
}
cat "$work/load.json"
check '.requests > 100 and .failures == 0' "$work/load.json"

# The others have it all now, and the proxy knows.
sleep 3
clients passes "http://127.0.0.1:$port" "http://127.0.0.1:$port" "$work/meshes" >"$work/passes.json"
