# shellcheck shell=bash
# ./dev experiment NAME: one published figure or table again, beside the published numbers.

command_experiment() {
  local name=${1:-}
  if [[ -z "$name" || ! -f "experiments/$name/run.sh" ]]; then
    local known
    known=$(find experiments -mindepth 2 -maxdepth 2 -name run.sh -printf '%h ' | sed 's,experiments/,,g')
    fail "experiment takes one of: ${known}and its own arguments" 2
  fi
  shift
  need "${PACKAGES_BUILD[@]}"
  configure_and_build release build
  "experiments/$name/run.sh" "$@"
}
