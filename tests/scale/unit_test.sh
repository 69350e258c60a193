#!/usr/bin/env bash
# docker/pmesh.service is a unit that systemd takes, with PMESH as its program: unit_test.sh PMESH
set -euo pipefail
pmesh=$1
command -v systemd-analyze >/dev/null || {
  echo "skipped: there is no systemd-analyze"
  exit 77
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sed "s|/usr/local/bin/pmesh|$pmesh|" "$(dirname "$0")/../../docker/pmesh.service" \
  >"$work/pmesh.service"
grep -q "^ExecStart=$pmesh serve" "$work/pmesh.service"
# Whatever it says is a fault, also where its status is 0.
systemd-analyze verify --man=no "$work/pmesh.service" >"$work/faults" 2>&1 || echo failed >>"$work/faults"
[ ! -s "$work/faults" ] || {
  cat "$work/faults" >&2
  exit 1
}
