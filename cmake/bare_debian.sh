# shellcheck shell=bash
# Leaves a bare Debian 12 in $root: that of $FOLDER, where one is kept, or a temporary one that goes
# with the script. $MIRROR names another Debian mirror. After dev.d/common.sh.

((EUID == 0)) || fail "only root can make a bare system"
command -v debootstrap >/dev/null || fail "debootstrap is missing: apt-get install debootstrap"

root=${FOLDER:-}
if [[ -z $root ]]; then
  root=$(mktemp -d)
  trap 'rm -rf --one-file-system "$root"' EXIT
fi
if [[ ! -x $root/usr/bin/apt-get ]]; then
  say "making a bare Debian 12 in $root"
  debootstrap --variant=minbase bookworm "$root" "${MIRROR:-http://deb.debian.org/debian}" >/dev/null
fi
