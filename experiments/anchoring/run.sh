#!/usr/bin/env bash
# Repeats the experiments of thesis section 2.6 in simulation, and those beyond it, and makes the
# tables and figures of docs/anchoring-experiments.md.
#
# Usage: experiments/anchoring/run.sh [--seeds N] [--longest S] [--build DIR] [--out DIR]
#                                     [--document FILE] [--ants DIR]
#   --seeds N        per point (30; a third of them for the ants)
#   --longest S      leave out ambiguities of more seconds (60)
#   --document FILE  put tables and figures into this document, too
#   --ants DIR       clip*.notag.frames.jsonl.gz of real ants: plots the expected number of them, too
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source experiments/options.sh

seeds=30 longest=60 build=build out=build/experiments/anchoring document='' ants=''
read_options "--seeds --longest --build --out --document --ants" "$(sed -n '2,10s/^# \{0,1\}//p' experiments/anchoring/run.sh)" "$@"
need_program "$build/anchoring_simulation"
mkdir -p "$out"

# study NAME SEEDS CONFIGURATION...: each configuration is a variant, named after what follows the
# first hyphen.
study() {
  local name=$1 count=$2 file variant
  shift 2
  for file in "$@"; do
    variant=$(basename "$file" .json)
    "$build/anchoring_simulation" "$name" "$file" --variant "${variant#*-}" --seeds "$count" \
      --longest "$longest" >"$out/$variant.csv"
  done
}
study boxes "$seeds" experiments/anchoring/boxes-*.json
study cups "$seeds" experiments/anchoring/cups-*.json
study hidden "$seeds" experiments/anchoring/hidden-*.json
study ants $((seeds < 3 ? 1 : seeds / 3)) experiments/anchoring/ants.json

videos=()
if [ -n "$ants" ]; then
  need_program "$build/anchor-replay"
  for clip in "$ants"/clip*.notag.frames.jsonl.gz; do
    name=$(basename "$clip" .notag.frames.jsonl.gz)
    zcat "$clip" | "$build/anchor-replay" --config experiments/anchoring/ants-video.json --input - \
      --no-timing --output "$out/$name.world.jsonl"
    videos+=(--video "$name" "$clip" "$out/$name.world.jsonl")
  done
fi
python3 experiments/anchoring/report.py --out "$out" ${document:+--document "$document"} \
  "${videos[@]}" "$out"/{boxes,cups,hidden}-*.csv "$out/ants.csv"
