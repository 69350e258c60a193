#!/usr/bin/env bash
# What `pmesh export` writes, on a plain nginx with docker/scale/nginx-static.conf: the URLs and bytes
# of the server, and every level of detail fetched from it equal to the extracted one:
# static_test.sh PMESH MAKE_SAMPLE MAKE_SHAPE
pmesh=$1 make_sample=$2 make_shape=$3
# shellcheck source=tests/scale/lib.sh
. "$(dirname "$0")/lib.sh"
need nginx

"$make_shape" sphere "$work/sphere.obj"
mkdir "$work/meshes"
"$pmesh" precompute "$work/sphere.obj" -o "$work/meshes/sphere.pmesh" --quiet
"$make_sample" "$work/meshes/large.pmesh" 1
echo "no PM file" >"$work/meshes/text.pmesh"
"$pmesh" export "$work/meshes" "$work/out" --static --json >"$work/export.json"
check '(.meshes | length) == 2 and (.skipped | length) == 1' "$work/export.json"

port=$(free_port)
fill "$scale/nginx-static.conf" "$work/static.conf" "listen 80" "listen 127.0.0.1:$port" \
  /srv/pmesh "$work/out"
start_nginx "$port" "$work/static.conf"
start_replica
host=http://127.0.0.1:$port

# same_answer TARGET: the plain host and the server give the same status and body.
same_answer() {
  curl -s -w '%{http_code}' "$host$1" >"$work/plain"
  curl -s -w '%{http_code}' "http://$http$1" >"$work/served"
  same "$work/plain" "$work/served" "$1"
}

same_answer /catalog
for id in sphere large; do
  url=$(curl -fs "$host/$id" | jq -r .url)
  same_answer "/$id"
  same_answer "$url"
  for chunk in 0 1 2; do same_answer "${url%.pmesh}/c/$chunk"; done
  curl -fs -r 100-199 "$host$url" >"$work/range"
  cmp "$work/range" <(tail -c +101 "$work/meshes/$id.pmesh" | head -c 100) || fail "range of $url"
done
curl -s -o /dev/null -w '%{http_code}' "$host/none" | grep -q 404 || fail "/none is there"
curl -fsI "$host$url" | grep -qi '^cache-control:.*immutable' || fail "$url is not immutable"
curl -fsI "$host/sphere" | grep -qi '^cache-control: no-cache' || fail "/sphere is not no-cache"
curl -fsI -X OPTIONS "$host$url" | grep -qi '^access-control-allow-headers:.*range' ||
  fail "no preflight"

url=$(curl -fs "$host/sphere" | jq -r .url)
for wish in "--faces 1000" "--ratio 0.5" "--bytes 10000" "--error 1%" "--ratio 1"; do
  # shellcheck disable=SC2086  # an option and its value
  "$pmesh" extract "$work/meshes/sphere.pmesh" $wish -o "$work/extracted.ply" 2>/dev/null
  for mesh in "$host/sphere" "$host$url"; do
    # shellcheck disable=SC2086
    "$pmesh" fetch "$mesh" $wish -o "$work/fetched.ply" --quiet
    same "$work/fetched.ply" "$work/extracted.ply" "$mesh $wish"
    rm "$work/fetched.ply"
  done
done
