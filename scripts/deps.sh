#!/usr/bin/env bash
# Installs the Debian 12 packages that pmesh needs: deps.sh [build] [test] [demo] [fuzz] [run]
# [bench] [peers]; the first three by default; `run` is for a machine that gets a built pmesh,
# `bench` for bench/serve, `peers` for bench/peers, bench/papers and bench/bytes. `test` also
# installs, into the source tree, the npm packages that some tests need. Silent when nothing is
# missing. (Debian starts some of the daemons that tests/scale needs when it installs them.)
set -euo pipefail

build=(cmake g++ ninja-build libboost1.81-dev libcli11-dev libdraco-dev libgtest-dev libspdlog-dev
  libssl-dev nlohmann-json3-dev)
test=(clang-format clang-tidy curl haproxy jq libmeshoptimizer-dev nginx-light nodejs npm
  openssl python3 systemd varnish zstd)
demo=(ca-certificates curl jq nodejs npm)
fuzz=(clang libclang-rt-14-dev)
run=(libdraco7 libspdlog1.10 libssl3)
bench=(iproute2 nginx-light openssl python3 slowhttptest strace wrk)
peers=(draco libgl1-mesa-dri libmeshoptimizer-dev libopenmesh-dev meshlab python3 xauth xvfb)

fail() {
  echo "deps.sh: $*" >&2
  exit 1
}

is_debian_12() {
  [ -r /etc/os-release ] && (. /etc/os-release && [ "$ID" = debian ] && [ "$VERSION_ID" = 12 ])
}

# The packages asked for that are not installed. Node.js from another source brings its own npm,
# which excludes Debian's package.
missing_packages() {
  local package installed
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null || true)
  for package in "$@"; do
    if [ "$package" = npm ] && command -v npm >/dev/null; then continue; fi
    grep -qx "installed $package" <<<"$installed" || echo "$package"
  done
}

as_root() {
  if [ "$(id -u)" = 0 ]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
  elif command -v sudo >/dev/null; then
    sudo env DEBIAN_FRONTEND=noninteractive "$@"
  else
    fail "missing: ${missing[*]}; run this script as root, or install sudo"
  fi
}

# npm checks every download against the lock file.
install_npm_packages() {
  local folder=$1
  if [ "$folder/node_modules/.package-lock.json" -nt "$folder/package-lock.json" ]; then return; fi
  echo "deps.sh: npm packages of $folder" >&2
  (cd "$folder" && npm ci --loglevel=error --no-audit --no-fund >/dev/null)
}

[ $# -gt 0 ] || set -- build test demo
wanted=()
for group in "$@"; do
  case $group in
    build) wanted+=("${build[@]}") ;;
    test) wanted+=("${test[@]}") ;;
    demo) wanted+=("${demo[@]}") ;;
    fuzz) wanted+=("${fuzz[@]}") ;;
    run) wanted+=("${run[@]}") ;;
    bench) wanted+=("${bench[@]}") ;;
    peers) wanted+=("${peers[@]}") ;;
    *) fail "unknown group '$group'; usage: deps.sh [build] [test] [demo] [fuzz] [run] [bench] [peers]" ;;
  esac
done

is_debian_12 || fail "this is not Debian 12; install by hand what corresponds to: ${wanted[*]}"
mapfile -t missing < <(missing_packages "${wanted[@]}")
if [ ${#missing[@]} -gt 0 ]; then
  echo "deps.sh: installing ${missing[*]}" >&2
  as_root apt-get -qq update
  as_root apt-get -qq -y --no-install-recommends install "${missing[@]}" >/dev/null
fi
case " $* " in
  *" test "*)
    for folder in decoder-js gltf openapi; do
      install_npm_packages "$(dirname "$0")/../tests/$folder"
    done
    ;;
esac
