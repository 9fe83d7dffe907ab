#!/usr/bin/env bash
# Usage: find_package_test.sh BUILD. Installs BUILD into an empty folder and lets a program that
# knows nothing but that folder find, link and use the package.
set -euo pipefail

build=$1
consumer=$(dirname "${BASH_SOURCE[0]}")/consumer
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cmake --install "$build" --prefix "$folder/prefix" >/dev/null
cmake -S "$consumer" -B "$folder/build" -G Ninja -DCMAKE_PREFIX_PATH="$folder/prefix" >/dev/null
cmake --build "$folder/build"
"$folder/build/consumer" "$folder/prefix/share/anchord/config/home.json"

for program in anchord anchorctl anchor-replay; do
  "$folder/prefix/bin/$program" --help >/dev/null
done

# Nothing that was installed may point back into the tree that it was built in.
if grep -rIlF "$(dirname "$build")/" "$folder/prefix"; then exit 1; fi
PYTHONPATH=$folder/prefix/lib/python3/dist-packages python3 -c '
import os, anchord
assert os.path.exists(os.path.join(os.path.dirname(anchord.__file__), "frame_t.py"))'
