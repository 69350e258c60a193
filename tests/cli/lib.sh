# What the command-line tests share. Sourced with $pmesh set; gives a folder $work, which is removed
# at the end together with every server started.
# shellcheck shell=bash disable=SC2154  # $pmesh

set -euo pipefail
work=$(mktemp -d)
server=

clean_up() {
  if [ -n "$server" ]; then kill -9 "$server" 2>/dev/null || true; fi
  rm -rf "$work"
}
trap clean_up EXIT

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# expect STATUS COMMAND...: the command must end with STATUS; a failure must say why on stderr, a
# line that begins with "pmesh".
expect() {
  local wanted=$1 status=0
  shift
  "$@" >"$work/stdout" 2>"$work/stderr" || status=$?
  [ "$status" = "$wanted" ] || {
    cat "$work/stderr" >&2
    fail "exit $status instead of $wanted: $*"
  }
}

# expect_message TEXT: what the command run by `expect` must have said on stderr.
expect_message() {
  grep -qF -- "$1" "$work/stderr" || fail "stderr lacks '$1': $(cat "$work/stderr")"
}

# check JQ_CONDITION FILE
check() {
  jq -e "$1" "$2" >/dev/null || fail "$1 does not hold: $(head -c 2000 "$2")"
}

same() {
  cmp "$1" "$2" || fail "$1 and $2 differ${3:+ ($3)}"
}

# start_server DIR: serves DIR on free ports; sets $server (process id), $http and $tcp.
start_server() {
  "$pmesh" serve "$1" --http 127.0.0.1:0 --tcp 127.0.0.1:0 2>"$work/serve.log" &
  server=$!
  for _ in $(seq 600); do
    http=$(address_of http) tcp=$(address_of tcp)
    if [ -n "$tcp" ] && curl -fs "http://$http/health" >/dev/null; then return; fi
    kill -0 "$server" 2>/dev/null || break
    sleep 0.1
  done
  cat "$work/serve.log" >&2
  fail "the server does not answer"
}

# Where the server's log says that it serves a protocol; empty if it does not say yet.
address_of() { grep -o "$1://[0-9.:]*" "$work/serve.log" 2>/dev/null | sed "s|$1://||" || true; }

# stop_server: SIGTERM must end it with status 0.
stop_server() {
  local status=0
  kill -TERM "$server"
  wait "$server" || status=$?
  server=
  [ "$status" = 0 ] || fail "the server ended with $status on SIGTERM"
}
