# shellcheck shell=bash
# What the experiments' commands share.

# read_options "--a --b" USAGE ARGUMENTS...: sets the variable a to what follows --a; on anything
# else prints the usage and ends.
read_options() {
  local known=$1 usage=$2
  shift 2
  while [ $# -gt 0 ]; do
    if [[ $1 != --* || " $known " != *" $1 "* ]]; then
      printf '%s\n' "$usage" >&2
      exit 2
    fi
    [ $# -ge 2 ] || { echo "$0: $1 wants a value" >&2; exit 2; }
    declare -g "${1#--}=$2"
    shift 2
  done
}

# need_program FILE: ends if it was not built.
need_program() {
  [ -x "$1" ] || { echo "$0: $1 is not there; run ./dev build, or give --build" >&2; exit 1; }
}
