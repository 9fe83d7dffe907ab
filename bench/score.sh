#!/usr/bin/env bash
# Replays recorded detections and scores the belief against the truth:
#
#     bench/score.sh [-c CONFIG] [-i INPUT] TRUTH.csv INDEX.csv SCORE.py [ARGUMENT...]
#
# INPUT (data/plaza.lcm by default, with config/plaza.json) is what anchor-replay takes, JSON lines
# also with gzip. TRUTH.csv, INDEX.csv (utime,frame) and the ARGUMENTs go to SCORE.py, as
# --truth, --index and they are; without ARGUMENTs: --radius 1 --dims 2 --seen-within 0.5.
# PYTHON names the interpreter, ANCHOR_REPLAY the program.
set -euo pipefail

root=$(dirname "${BASH_SOURCE[0]}")/..
# shellcheck source=bench/replay.sh
source "$root/bench/replay.sh"
config=$root/config/plaza.json
input=$root/data/plaza.lcm
while getopts 'c:i:' option; do
  case $option in
    c) config=$OPTARG ;;
    i) input=$OPTARG ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
if (($# < 3)); then
  sed -n '2,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
truth=$1 index=$2 score=$3
shift 3
arguments=("$@")
if ((!$#)); then arguments=(--radius 1 --dims 2 --seen-within 0.5); fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
replay "$config" "$input" "$folder/all"
"${PYTHON:-python3}" "$score" --truth "$truth" --world "$folder/all.world.jsonl" --index "$index" \
  "${arguments[@]}"
cat "$folder/all.stats.json"
