#!/usr/bin/env bash
# A minute of the soak on files that decode and on large ones that do not:
# soak_test.sh SOAK PMESH MAKE_SAMPLE MOST_GROWTH CLIENTS
set -euo pipefail
soak=$1 pmesh=$2 make_sample=$3 most_growth=$4 clients=$5

meshes=$(mktemp -d)
trap 'rm -r "$meshes"' EXIT
cp "$(dirname "$0")"/../golden/*.pmesh "$meshes"
"$make_sample" "$meshes/large1.pmesh" 1
"$make_sample" "$meshes/large2.pmesh" 2
"$soak" "$pmesh" "$meshes" --seconds 60 --most-growth "$most_growth" --clients "$clients"
