#!/usr/bin/env bash
# Unpacks Debian's CGAL and the headers it needs below DIR: unpack_cgal.sh DIR. libcgal-dev wants
# Boost 1.74 and cannot be installed beside the Boost 1.81 that pmesh needs. Does nothing if it has
# been done before.
set -euo pipefail
dir=${1:?usage: unpack_cgal.sh DIR}
packages=(libcgal-dev libboost1.74-dev libeigen3-dev)

if [ -e "$dir/unpacked" ]; then exit 0; fi
mkdir -p "$dir/packages"
(cd "$dir/packages" && apt-get -qq -o APT::Sandbox::User=root download "${packages[@]}")
for package in "$dir"/packages/*.deb; do dpkg -x "$package" "$dir"; done
touch "$dir/unpacked"
