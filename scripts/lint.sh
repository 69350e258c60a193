#!/usr/bin/env bash
# Checks the layout of every source file with clang-format, and core/ and protocol/ with clang-tidy.
set -euo pipefail
cd "$(dirname "$0")/.."

mapfile -t sources < <(find core protocol server client cli tests bench -name '*.h' -o -name '*.cpp')
clang-format --dry-run -Werror "${sources[@]}"

cmake --preset release >/dev/null
find core protocol -name '*.cpp' -print0 |
  xargs -0 -n 4 -P "$(nproc)" clang-tidy -p build/release --quiet \
    2> >(grep -v 'warnings generated' >&2)
