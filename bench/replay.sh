# shellcheck shell=bash
# What the scripts that replay and score share.

# replay CONFIG INPUT OUTPUT [ARGUMENT...]: writes OUTPUT.world.jsonl and OUTPUT.stats.json. INPUT is
# what anchor-replay takes, JSON lines also with gzip. ANCHOR_REPLAY names the program.
replay() {
  local config=$1 input=$2 output=$3
  shift 3
  local program=("${ANCHOR_REPLAY:-$(dirname "${BASH_SOURCE[0]}")/../build/anchor-replay}"
    --config "$config" --no-timing --output "$output.world.jsonl" --stats "$output.stats.json" "$@")
  if [[ $input == *.gz ]]; then
    gzip -dc "$input" | "${program[@]}" --input -
  else
    "${program[@]}" --input "$input"
  fi
}
