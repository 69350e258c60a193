#!/usr/bin/env bash
# A cache of docker/scale/ before pmesh: on the second pass over files, ranges, chunks, wishes and
# names at least 95% are hits, and every byte is the file's: cache_test.sh PMESH MAKE_SAMPLE
# varnish|nginx
pmesh=$1 make_sample=$2 cache=$3
# shellcheck source=tests/scale/lib.sh
. "$(dirname "$0")/lib.sh"

start_varnish() {
  fill "$scale/varnish.vcl" "$work/varnish.vcl" '"pmesh"' "\"${http%:*}\"" \
    '.port = "8080"' ".port = \"${http##*:}\""
  start_daemon "$port" varnishd -F -j none -n "$work/varnish" -a "127.0.0.1:$port" \
    -f "$work/varnish.vcl" -s default,128m
}

start_nginx_cache() {
  fill "$scale/nginx-cache.conf" "$work/cache.conf" "listen 80" "listen 127.0.0.1:$port" \
    "server pmesh:8080" "server $http" /var/cache/nginx/pmesh "$work/cache"
  start_nginx "$port" "$work/cache.conf"
}

case $cache in
  varnish) need varnishd python3 ;;
  nginx) need nginx python3 ;;
esac
make_meshes 3
start_replica
port=$(free_port)
case $cache in
  varnish) start_varnish ;;
  nginx) start_nginx_cache ;;
esac

clients passes "http://127.0.0.1:$port" "http://$http" "$work/meshes" | tee "$work/passes.json"
check '.requests > 100 and .second_hits >= 0.95 * .requests' "$work/passes.json"
check '.first_hits < .second_hits' "$work/passes.json"
