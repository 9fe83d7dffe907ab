#!/bin/sh
# Fetches the plaza's video into a folder: vtest.avi of Debian's package opencv-doc (795 frames,
# 768 x 576; PETS 2009 S2.L1 view 1, University of Reading). The package is unpacked, not installed:
# slim images leave documentation out.
set -eu
if [ $# -ne 1 ]; then
  echo "usage: $0 DIR    puts vtest.avi into DIR" >&2
  exit 2
fi
mkdir -p "$1"
target=$(cd "$1" && pwd)/vtest.avi
if [ -s "$target" ]; then
  echo "$target is there already"
  exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT INT TERM
cd "$work"
echo "fetching Debian's package opencv-doc (96 MB)..."
if ! apt-get download opencv-doc >log 2>&1; then
  # The package lists may be missing or old; apt wants root to renew them.
  apt-get update >>log 2>&1 || true
  if ! apt-get download opencv-doc >>log 2>&1; then
    cat log >&2
    echo "$0: the package opencv-doc cannot be fetched; 'apt-get update' as root may mend it" >&2
    exit 1
  fi
fi
dpkg-deb --fsys-tarfile opencv-doc_*.deb |
  tar -x --wildcards '*/examples/data/vtest.avi*'
found=$(find . -name 'vtest.avi*' -type f | head -n 1)
case $found in
  *.gz) gunzip -c "$found" >"$target.part" ;;
  *.avi) cp "$found" "$target.part" ;;
  *) echo "$0: this version of opencv-doc holds no vtest.avi" >&2; exit 1 ;;
esac
mv "$target.part" "$target"
echo "$target"
