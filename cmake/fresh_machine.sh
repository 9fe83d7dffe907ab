#!/usr/bin/env bash
# Usage (as root): cmake/fresh_machine.sh [COMMAND...]
# Runs ./dev COMMAND for each COMMAND (test) on a bare Debian 12 that is made for it in
# $FOLDER (a temporary one; removed afterwards): does the project build and pass where nothing was
# installed before? A $FOLDER that is named is kept, and used as it is if it holds a system already.
# $MIRROR names another Debian mirror. Needs debootstrap.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source dev.d/common.sh

# shellcheck source=cmake/bare_debian.sh
source cmake/bare_debian.sh
rm -rf "$root/project"
mkdir "$root/project"
project_files '*' | tar --create --files-from=- | tar --extract --directory="$root/project"

# In namespaces of its own: what is mounted and started there ends with it.
inside() {
  # shellcheck disable=SC2016  # $0 and $@ are the inner shell's
  unshare --mount --pid --fork --kill-child bash -euc '
    mount -t proc proc "$0/proc"
    mount -t sysfs sysfs "$0/sys"
    mount --bind /dev "$0/dev"
    mount -t tmpfs tmpfs "$0/dev/shm"
    exec chroot "$0" "$@"' "$root" env -i HOME=/root PATH="$PATH" TERM=dumb "$@"
}
for command in "${@:-test}"; do
  say "./dev $command on the fresh machine"
  started=$SECONDS
  inside "/project/dev" "$command"
  say "./dev $command took $((SECONDS - started)) s"
done
