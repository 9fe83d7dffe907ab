#!/usr/bin/env bash
# Usage (as root): cmake/fresh_package.sh PACKAGE.deb
# Installs the package (./dev package) on a bare Debian 12, runs the daemon from it, asks it, and
# purges it: is everything there that it needs, and does nothing stay behind? $FOLDER and $MIRROR as
# in fresh_machine.sh. Needs debootstrap. What systemd makes of the unit cannot be seen here.
set -euo pipefail
package=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source dev.d/common.sh

# shellcheck source=cmake/bare_debian.sh
source cmake/bare_debian.sh
cp "$package" "$root/anchord.deb"

# In namespaces of its own, network included: nothing is heard or sent outside.
inside() {
  # shellcheck disable=SC2016  # $0 and $@ are the inner shell's
  unshare --mount --pid --fork --kill-child "${@:2:$1}" bash -euc '
    mount -t proc proc "$0/proc"
    mount --bind /dev "$0/dev"
    exec chroot "$0" "$@"' "$root" env -i HOME=/root PATH="$PATH" TERM=dumb LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive "${@:$(($1 + 2))}"
}
online() { inside 0 "$@"; }
offline() { inside 1 --net "$@"; }
# Everything but what apt and dpkg keep about packages, and what programs make as they run.
files() {
  (cd "$root" && find . -xdev \( -path ./proc -o -path ./sys -o -path ./dev -o -path ./tmp -o -path ./run \
    -o -path ./var/lib/dpkg -o -path ./var/lib/apt -o -path ./var/cache -o -path ./var/log \
    -o -path ./var/lib/systemd -o -path ./anchord.deb \) -prune -o -print | sort)
}

say "installing what the package depends on, systemd and man"
online apt-get update -q >/dev/null
dependencies=$(dpkg-deb --field "$package" Depends | sed 's/ *([^)]*)//g; s/,//g')
# shellcheck disable=SC2086  # names of packages
online apt-get install -qy --no-install-recommends systemd man-db iproute2 $dependencies >/dev/null
before=$(files)

say "installing the package"
online apt-get install -qy /anchord.deb >/dev/null
[[ -L $root/etc/systemd/system/multi-user.target.wants/anchord.service ]]
for page in anchord anchorctl anchor-replay anchor-play anchor-tune; do online man -w "$page"; done
online systemd-analyze verify anchord.service

say "running it"
# shellcheck disable=SC2016
offline bash -euc '
  ip link set lo up
  ip link set lo multicast on
  ip route add 224.0.0.0/4 dev lo
  cd "$(mktemp -d)"
  log=$(mktemp)
  anchord --data /var/lib/anchord 2>"$log" &
  until grep -q "ready: " "$log"; do kill -0 $! || { cat "$log"; exit 1; }; sleep 0.1; done
  anchorctl status
  exec 3<>/dev/tcp/127.0.0.1/7780
  printf "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n" >&3
  grep "<title>anchord" <&3
  kill $! && wait $!
  anchord --http 0.0.0.0:7780 && exit 1
  [[ $? == 2 ]]'

say "purging it"
online apt-get purge -qy anchord >/dev/null
left=$(comm -13 <(echo "$before") <(files))
[[ -z $left ]] || fail "left behind: $left"
rm "$root/anchord.deb"
say "nothing is left behind"
