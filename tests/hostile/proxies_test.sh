#!/usr/bin/env bash
# The hostile requests through a proxy with its configuration of docker/scale/, which here also
# refuses /hidden. Whoever is answered with that mesh has smuggled a request past the proxy:
# proxies_test.sh PMESH MAKE_SAMPLE WRITE_REQUESTS haproxy|varnish|nginx
pmesh=$1 make_sample=$2 write_requests=$3 proxy=$4
# shellcheck source=tests/scale/lib.sh
. "$(dirname "$0")/../scale/lib.sh"
here=$(cd "$(dirname "$0")" && pwd)

start_haproxy() {
  fill "$scale/haproxy.cfg" "$work/haproxy.cfg" "bind :8080" "bind 127.0.0.1:$port
  http-request deny if { path_beg /hidden }" \
    pmesh-a:8080 "$http" pmesh-b:8080 "$http" pmesh-c:8080 "$http" "maxconn 20000" "maxconn 2000"
  start_daemon "$port" haproxy -db -f "$work/haproxy.cfg"
}

start_varnish() {
  fill "$scale/varnish.vcl" "$work/varnish.vcl" '"pmesh"' "\"${http%:*}\"" \
    '.port = "8080"' ".port = \"${http##*:}\"" "sub vcl_recv {" \
    'sub vcl_recv { if (req.url ~ "^/hidden") { return (synth(403)); }'
  start_daemon "$port" varnishd -F -j none -n "$work/varnish" -a "127.0.0.1:$port" \
    -f "$work/varnish.vcl" -s default,128m
}

start_nginx_cache() {
  fill "$scale/nginx-cache.conf" "$work/cache.conf" "listen 80;" "listen 127.0.0.1:$port;
  location /hidden { return 403; }" "server pmesh:8080" "server $http" \
    /var/cache/nginx/pmesh "$work/cache"
  start_nginx "$port" "$work/cache.conf"
}

status_of() { curl -s -o /dev/null -w '%{http_code}' "http://$1"; }

need curl python3
case $proxy in
  haproxy) need haproxy ;;
  varnish) need varnishd ;;
  nginx) need nginx ;;
esac
mkdir -p "$work/meshes" "$work/beside"
"$write_requests" files "$work/meshes" "$work/beside"
start_replica
port=$(free_port)
case $proxy in
  haproxy) start_haproxy ;;
  varnish) start_varnish ;;
  nginx) start_nginx_cache ;;
esac

# Behind the proxy there is something to be had that it refuses.
[ "$(status_of "$http/hidden")" = 200 ] || fail "the server has no /hidden"
[ "$(status_of "127.0.0.1:$port/hidden")" = 403 ] || fail "$proxy does not refuse /hidden"

# Of all that is asked for, only the description of a mesh has its base_faces.
"$write_requests" smuggling | python3 "$here/probe.py" "$port" base_faces
"$write_requests" traversal | python3 "$here/probe.py" "$port" "the secret beside" '"id":"secret'
[ "$(status_of "127.0.0.1:$port/mesh")" = 200 ] || fail "the server does not answer any more"
