# shellcheck shell=bash
# ./dev soak MINUTES: the daemon lives through a simulated home, kills and hostile bytes; see
# docs/soak.md.

command_soak() {
  [[ ${1:-} =~ ^[0-9]+(\.[0-9]+)?$ ]] || fail "soak takes MINUTES, and perhaps --seed N" 2
  need "${PACKAGES_BUILD[@]}" "${PACKAGES_TEST[@]}"
  configure_and_build release build anchord soak_home
  within_multicast python3 experiments/soak/soak.py "$@"
}
