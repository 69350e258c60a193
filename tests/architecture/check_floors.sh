#!/usr/bin/env bash
# Checks every #include below ROOT against the floor table of ROOT/docs/architecture.md:
# check_floors.sh ROOT. Prints each violation as file:line and fails if there is one.
set -euo pipefail
root=${1:?usage: check_floors.sh ROOT}
cd "$root"

names=()            # floors, top row first
declare -A files    # floor -> its path patterns
declare -A allowed  # floor -> floors, or path patterns, that it may include
declare -A granted  # floor -> kinds of outside headers
declare -A decoder  # floors of the decoder
violations=0

report() {
  echo "$1: $2"
  violations=$((violations + 1))
}

# The words in backticks of a table cell.
words() { grep -o '`[^`]*`' <<<"$1" | tr -d '`' | tr '\n' ' ' || true; }

read_table() {
  local _ floor patterns includes outside name
  while IFS='|' read -r _ floor patterns includes outside _; do
    name=$(words "$floor")
    name=${name% }
    names+=("$name")
    files[$name]=$(words "$patterns")
    allowed[$name]=$(words "$includes")
    granted[$name]=$(words "$outside")
    if [[ $floor == *†* ]]; then decoder[$name]=1; fi
  done < <(sed -n '/^| floor |/,/^$/p' docs/architecture.md | grep '^| `')
  [ ${#names[@]} -gt 0 ] || { echo "docs/architecture.md: no floor table"; exit 1; }
}

# matches PATH PATTERN...: a pattern that ends in / stands for all below it.
matches() {
  local path=$1 pattern
  shift
  for pattern in "$@"; do
    # shellcheck disable=SC2053  # the right side is a pattern
    if [[ $path == ${pattern/%\//\/*} ]]; then return 0; fi
  done
  return 1
}

# Sets `floor` to that of the file at PATH; empty if it has none.
find_floor() {
  for floor in "${names[@]}"; do
    # shellcheck disable=SC2086  # a list of patterns
    if matches "$1" ${files[$floor]}; then return; fi
  done
  floor=
}

# The kind of outside header that <HEADER> is; empty for the plain standard library.
kind_of_header() {
  case $1 in
    thread | mutex | shared_mutex | condition_variable | future | atomic | semaphore | latch | \
      barrier | stop_token) kind=threads ;;
    chrono | ctime | time.h) kind=clock ;;
    fstream | filesystem | cstdio) kind=files ;;
    iostream) kind=console ;;
    */*) kind=${1%%/*} ;;
    *.h) kind=posix ;;
    *) kind= ;;
  esac
  if [[ $kind == sys || $kind == netinet || $kind == arpa || $kind == linux ]]; then kind=posix; fi
}

check_own_include() {
  local where=$1 from=$2 target=$3
  find_floor "$target"
  if [ -z "$floor" ] || [ ! -e "$target" ]; then
    report "$where" "\"$target\" is not a file of any floor (includes start at the root)"
  elif [[ $floor != "$from" && " ${allowed[$from]} " != *" $floor "* ]]; then
    # shellcheck disable=SC2086
    matches "$target" ${allowed[$from]} ||
      report "$where" "floor $from may not include \"$target\" of floor $floor"
  fi
}

check_outside_include() {
  local where=$1 from=$2 header=$3
  kind_of_header "$header"
  if [[ -n $kind && " ${granted[$from]} " != *" $kind "* ]]; then
    report "$where" "floor $from may not include <$header> ($kind)"
  fi
}

check_includes() {
  local file=$1 from=$2 number line
  while IFS=: read -r number line; do
    if [[ $line =~ \"([^\"]+)\" ]]; then
      check_own_include "$file:$number" "$from" "${BASH_REMATCH[1]}"
    elif [[ $line =~ \<([^\>]+)\> ]]; then
      check_outside_include "$file:$number" "$from" "${BASH_REMATCH[1]}"
    fi
  done < <(grep -n '^[[:space:]]*#[[:space:]]*include' "$file" || true)
}

# Line comments and strings aside, `throw` and `try` are no words of the decoder.
check_no_exceptions() {
  local number line
  while IFS=: read -r number line; do
    report "$1:$number" "exceptions in the decoder"
  done < <(sed -E 's://.*$::; s/"([^"\\]|\\.)*"/""/g' "$1" | grep -nwE 'throw|try|catch' || true)
}

read_table
while IFS= read -r file; do
  find_floor "$file"
  if [ -z "$floor" ]; then
    report "$file" "belongs to no floor of docs/architecture.md"
    continue
  fi
  own=$floor
  check_includes "$file" "$own"
  if [ -n "${decoder[$own]:-}" ]; then check_no_exceptions "$file"; fi
done < <(find core protocol server client cli -name '*.h' -o -name '*.cpp' | sort)

[ "$violations" = 0 ] || { echo "$violations violations of the floor table"; exit 1; }
