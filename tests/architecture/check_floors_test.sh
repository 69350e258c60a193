#!/usr/bin/env bash
# check_floors.sh finds violations: every one planted in a copy of the tree must be reported.
# check_floors_test.sh ROOT
set -euo pipefail
root=${1:?usage: check_floors_test.sh ROOT}
here=$(cd "$(dirname "$0")" && pwd)
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
(cd "$root" && cp -r --parents core protocol server client cli docs/architecture.md "$copy")

expected=()

# plant FILE LINE REPORT: LINE at the end of FILE must be reported so.
plant() {
  echo "$2" >>"$copy/$1"
  expected+=("$1:$(wc -l <"$copy/$1"): $3")
}

plant core/base/result.h '#include "core/mesh/half_edge_mesh.h"' \
  'floor base may not include "core/mesh/half_edge_mesh.h" of floor mesh'
plant core/mesh/build.cpp '#include "core/io/import.h"' \
  'floor mesh may not include "core/io/import.h" of floor io'
plant core/mesh/build.cpp '#include "half_edge_mesh.h"' \
  '"half_edge_mesh.h" is not a file of any floor (includes start at the root)'
plant core/mesh/edit.cpp '# include <iostream>' \
  'floor mesh may not include <iostream> (console)'
plant core/refine/refinable_mesh.cpp '#include <mutex>' \
  'floor refine may not include <mutex> (threads)'
plant core/refine/refinable_mesh.cpp 'void f() { throw 1; }' \
  'exceptions in the decoder'
plant core/pm/stream_decoder.h '#include <draco/core/decoder_buffer.h>' \
  'floor pm-decode may not include <draco/core/decoder_buffer.h> (draco)'
plant core/pm/stream_decoder.h '#include <chrono>' \
  'floor pm-decode may not include <chrono> (clock)'
plant core/pm/stream_decoder.h '#include "core/pm/encoder.h"' \
  'floor pm-decode may not include "core/pm/encoder.h" of floor pm-encode'
plant protocol/lod_request.h '#include <boost/asio.hpp>' \
  'floor protocol may not include <boost/asio.hpp> (boost)'
plant protocol/lod_request.h '#include "core/pm/stream_decoder.h"' \
  'floor protocol may not include "core/pm/stream_decoder.h" of floor pm-decode'
plant core/io/import.h '#include <sys/socket.h>' \
  'floor io may not include <sys/socket.h> (posix)'
echo >"$copy/core/stray.h"
expected+=('core/stray.h: belongs to no floor of docs/architecture.md')

if output=$("$here/check_floors.sh" "$copy"); then
  echo "the check passes a tree with ${#expected[@]} violations"
  exit 1
fi
failures=0
for line in "${expected[@]}"; do
  grep -qxF "$line" <<<"$output" || {
    echo "not reported: $line"
    failures=1
  }
done
exit "$failures"
