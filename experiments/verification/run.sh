#!/usr/bin/env bash
# Follows people on the plaza's video by verification tasks alone (thesis section 3.8.1), with looks
# as often as their expected information gain is worth, and makes the table and figures of
# docs/verification.md.
#
# Usage: experiments/verification/run.sh [--truth TRUTH.csv] [--build DIR] [--out DIR]
#   TRUTH.csv: frame,id,x,y of all people (frames from 1, metres in the map): follows everybody and
#   tells the errors. Without it: one person, from where she first stands.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source experiments/options.sh

build=build out=build/experiments/verification truth=
read_options "--truth --build --out" "$(sed -n '2,9s/^# \{0,1\}//p' experiments/verification/run.sh)" "$@"
need_program "$build/verification_follow"
mkdir -p "$out"
tools/fetch_vtest.sh "$out" >/dev/null

# Somebody who comes in at the right and walks to and fro for 49 s.
whom=(--from 24 -11.4 -14.1 367)
[ -z "$truth" ] || whom=(--truth "$truth")
for threshold in 0 0.5 0.75 1 1.5 2; do
  "$build/verification_follow" "$out/vtest.avi" "${whom[@]}" --threshold "$threshold" \
    --output "$out/follow-$threshold.csv"
done
person=(--person 1)
[ -z "$truth" ] || person=(--person 11)
experiments/verification/report.py "$out" "$out"/follow-*.csv "${person[@]}"
"$build/verification_blob_time" | tee "$out/blob_time.csv"
