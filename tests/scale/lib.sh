# What the tests of scale-out share. Sourced with $pmesh and $make_sample set; builds on the library
# of the command-line tests. Every daemon started is killed at the end.
# shellcheck shell=bash disable=SC2154  # $pmesh, $make_sample, $work, $server
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck disable=SC2034  # for the tests
scale=$here/../../docker/scale
# shellcheck source=tests/cli/lib.sh
. "$here/../cli/lib.sh"
PATH=$PATH:/usr/sbin
daemons=()

# SIGTERM first: nginx and Varnish have processes of their own to end.
end_daemons() {
  local pid
  for pid in "${daemons[@]}"; do kill -TERM "$pid" 2>/dev/null || true; done
  for _ in $(seq 50); do
    if [ -z "$(jobs -rp)" ]; then break; fi
    sleep 0.1
  done
  for pid in "${daemons[@]}"; do kill -9 "$pid" 2>/dev/null || true; done
  clean_up
}
trap end_daemons EXIT

# need PROGRAM...: without one of them the test is skipped.
need() {
  local program
  for program in "$@"; do
    command -v "$program" >/dev/null || {
      echo "skipped: there is no $program"
      exit 77
    }
  done
}

clients() { python3 "$here/clients.py" "$@"; }

free_port() {
  python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

# make_meshes COUNT: $work/meshes with so many PM files.
make_meshes() {
  local i
  mkdir -p "$work/meshes"
  for i in $(seq "$1"); do "$make_sample" "$work/meshes/mesh$i.pmesh" "$i"; done
}

# start_replica: one more server of $work/meshes; sets $http and $replica (process id).
start_replica() {
  rm -f "$work/serve.log"
  PMESH_TRUSTED_PROXY=127.0.0.1/32 start_server "$work/meshes"
  replica=$server server=
  daemons+=("$replica")
}

# fill TEMPLATE FILE OLD NEW...: a copy with every OLD replaced, each of which must be there.
fill() {
  local template=$1 file=$2 text
  text=$(cat "$template")
  shift 2
  while [ $# -gt 0 ]; do
    [[ $text == *"$1"* ]] || fail "${template##*/} has no '$1'"
    text=${text//"$1"/"$2"}
    shift 2
  done
  printf '%s\n' "$text" >"$file"
}

# start_daemon PORT COMMAND...: starts a daemon that stays in the foreground, and waits for it to
# answer HTTP with pmesh behind it.
start_daemon() {
  local port=$1
  shift
  "$@" >"$work/daemon.log" 2>&1 &
  daemon=$!
  daemons+=("$daemon")
  for _ in $(seq 300); do
    if curl -fs -o "$work/answer" "http://127.0.0.1:$port/catalog"; then return; fi
    kill -0 "$daemon" 2>/dev/null || break
    sleep 0.1
  done
  cat "$work/daemon.log" >&2
  fail "$1 does not answer"
}

# start_nginx PORT CONF: nginx with one file for conf.d, as whoever runs the test.
start_nginx() {
  local user=
  if [ "$(id -u)" = 0 ]; then user="user root;"; fi
  cat >"$work/nginx.conf" <<END
$user
daemon off;
master_process on;
worker_processes 2;
pid $work/nginx.pid;
error_log stderr;
events {}
http {
  access_log off;
  client_body_temp_path $work/body;
  proxy_temp_path $work/proxy;
  fastcgi_temp_path $work/fastcgi;
  uwsgi_temp_path $work/uwsgi;
  scgi_temp_path $work/scgi;
  include $2;
}
END
  start_daemon "$1" nginx -p "$work" -e stderr -c "$work/nginx.conf"
}
