#!/usr/bin/env bash
# Replays public recordings with the configuration in bench/public, scores the belief against the
# truth, and prints a Markdown table with what others reached on the same frames:
#
#     bench/public.sh kitti|clutter|ants|pets|crowd|all DATA SCORE.py [OUT]
#
# DATA holds the folders kitti, clutter, ants, pets09 and crowd: for each sequence frames (JSON
# lines, gzip), truth (frame,id,x,y[,z][,class][,ignore]) and index (utime,frame). They are not part
# of the project. SCORE.py is called with the settings of each data set and prints a line of JSON per
# class. Then follows how far probabilities can be taken at their word (bench/reliability.py), over
# all sets of the call, as a table and as OUT/reliability.svg. OUT keeps the beliefs; by default it
# is removed at the end. PYTHON names the interpreter, ANCHOR_REPLAY the program.
set -euo pipefail
shopt -s nullglob

here=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=bench/replay.sh
source "$here/replay.sh"
if (($# < 3)); then
  sed -n '2,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
name=$1 data=$2 score=$3 out=${4:-}
if [[ -z $out ]]; then
  out=$(mktemp -d)
  trap 'rm -rf "$out"' EXIT
fi
python=${PYTHON:-python3}
measured=()  # for the reliability: set, radius, seen within, its sequences

# run SET CONFIG ENDING INDEX "RADIUS SEEN" "SCORE ARGUMENTS" FRAMES...: the truth of the sequence
# X.ENDING is X.truth.csv; so is its index X.index.csv, unless INDEX names one for all.
run() {
  local set=$1 config=$here/public/$2.json ending=$3 index=$4 means=$5 settings=$6
  shift 6
  (($#)) || { echo "$0: no frames of $set in $data" >&2; exit 1; }
  mkdir -p "$out/$set"
  local frames base truth=() world=() indices=()
  for frames in "$@"; do
    base=${frames%"$ending"}
    replay "$config" "$frames" "$out/$set/$(basename "$base")" --all
    world+=("$out/$set/$(basename "$base").world.jsonl")
    truth+=("$base.truth.csv")
    indices+=("${index:-$base.index.csv}")
  done
  local arguments
  read -ra arguments <<<"$settings"
  "$python" "$score" --truth "${truth[@]}" --world "${world[@]}" --index "${indices[@]}" \
    "${arguments[@]}" >"$out/$set/score.jsonl"
  # The published filters report what their best hypothesis holds, whatever the others say.
  "$python" "$score" --truth "${truth[@]}" --world "${world[@]}" --index "${indices[@]}" \
    "${arguments[@]}" --min-p 0 >"$out/$set/best_world.jsonl"
  "$python" "$here/public_table.py" "$set" "$here/public/peers.csv" "$out/$set"
  local i
  for i in "${!world[@]}"; do
    measured+=("$set $means ${world[i]} ${truth[i]} ${indices[i]}")
  done
}

kitti() {
  run kitti kitti .frames.jsonl.gz "" "2 0.15" \
    "--radius 2 --dims 2 --per-class --gospa 2 --seen-within 0.15" "$data"/kitti/*.frames.jsonl.gz
}
clutter() {
  local model setting
  for model in clutter clutter_uniform; do
    for setting in 10_75 30_98; do
      run ${model}_$setting ${model}_$setting .frames.jsonl.gz "$data/clutter/index.csv" "50 inf" \
        "--radius 50 --dims 2 --gospa 100" "$data"/clutter/$setting/*.frames.jsonl.gz
    done
  done
}
ants() {
  local tags
  for tags in notag tagonce tag; do
    run ants_$tags ants .$tags.frames.jsonl.gz "$data/ants/index.csv" "0.002 inf" \
      "--radius 0.002 --dims 2" "$data"/ants/*.$tags.frames.jsonl.gz
  done
}
pets() {
  local folder=$out/pets_frames
  mkdir -p "$folder"  # the sequence's files under one name
  cp "$data/pets09/frrcnn.frames.jsonl.gz" "$data/pets09/frrcnn.index.csv" "$folder"
  cp "$data/pets09/truth_ground.csv" "$folder/frrcnn.truth.csv"
  run pets pets .frames.jsonl.gz "" "1 0.5" "--radius 1 --dims 2 --seen-within 0.5" \
    "$folder/frrcnn.frames.jsonl.gz"
}
crowd() {
  local scene
  for scene in N20_1hz N50_1hz N100_1hz; do
    run crowd_$scene ../crowd .frames.jsonl.gz "" "1 inf" "--radius 1 --dims 2 --gospa 1" \
      "$data/crowd/$scene.frames.jsonl.gz"
  done
}

case $name in
  kitti | clutter | ants | pets | crowd) "$name" ;;
  all) for set in kitti clutter ants pets crowd; do "$set"; done ;;
  *) echo "$0: no set is called $name" >&2; exit 2 ;;
esac
printf '%s\n' "${measured[@]}" |
  PYTHONPATH="$here/../experiments${PYTHONPATH:+:$PYTHONPATH}" \
    "$python" "$here/reliability.py" "$out/reliability.svg"
