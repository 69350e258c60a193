#!/usr/bin/env bash
# The decoder's object code neither throws, unwinds nor knows threads or files:
# check_decoder_objects.sh NM LIBRARY. Empty libraries fail.
set -euo pipefail
nm=${1:?usage: check_decoder_objects.sh NM LIBRARY}
library=${2:?usage: check_decoder_objects.sh NM LIBRARY}

symbols=$("$nm" "$library" 2>/dev/null)
grep -q ' T ' <<<"$symbols" || { echo "$library defines nothing"; exit 1; }
unwanted='__cxa_throw|__cxa_begin_catch|__gxx_personality_v0|_ZTI|pthread_|basic_.?fstream|_ZSt4cout'
if found=$(grep -E "$unwanted" <<<"$symbols" | sort -u) && [ -n "$found" ]; then
  echo "$library must not use:"
  echo "$found"
  exit 1
fi
