# shellcheck shell=bash
# Fuzzing: every build-fuzz/*_fuzz for a while, nproc at a time. fuzz/corpus/NAME holds the
# inputs to start from; what a run finds beside them grows in .cache/fuzz/NAME, and the few of those
# that reach new code are merged into fuzz/corpus/NAME. An input that breaks NAME_fuzz stays as
# .cache/fuzz/NAME-crash-HASH (or -timeout-, -oom-).

command_fuzz() {
  local seconds=${1:-60}
  [[ $seconds =~ ^[1-9][0-9]*$ ]] || fail "fuzz takes a number of seconds, not $seconds" 2
  need "${PACKAGES_BUILD[@]}" "${PACKAGES_FUZZ[@]}"
  mkdir -p "$CACHE/fuzz"
  configure_and_build fuzz build-fuzz fuzz/all
  local targets
  mapfile -t targets < <(find build-fuzz -maxdepth 2 -type f -executable -name '*_fuzz' | sort)
  ((${#targets[@]})) || fail "no fuzz target was built: expected build-fuzz/*_fuzz"
  say "fuzzing ${#targets[@]} targets for $seconds s each, $(nproc) at a time"
  export -f fuzz_target
  export CACHE
  rm -f "$CACHE"/fuzz/*.failed
  printf '%s\n' "${targets[@]}" |
    xargs -P "$(nproc)" -I '{}' bash -c 'fuzz_target "$@"' fuzz '{}' "$seconds"
  local failed
  failed=$(find "$CACHE/fuzz" -maxdepth 1 -name '*.failed' | wc -l)
  summary fuzz $((${#targets[@]} - failed)) "$failed"
}

# fuzz_target PROGRAM SECONDS: one target, its result in a line; a failure also as NAME.failed.
fuzz_target() {
  local program=$1 seconds=$2 name corpus grown log
  name=$(basename "$program" _fuzz)
  corpus=fuzz/corpus/$name grown=$CACHE/fuzz/$name log=$CACHE/fuzz/$name.log
  mkdir -p "$corpus" "$grown"
  export ASAN_SYMBOLIZER_PATH=/usr/bin/llvm-symbolizer-14
  if ! "$program" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$CACHE/fuzz/$name-" "$grown" "$corpus" >"$log" 2>&1; then
    touch "$CACHE/fuzz/$name.failed"
    grep -aE -A 12 'ERROR: |runtime error:|SUMMARY: ' "$log" | head -n 40
    echo "$name: FAILED; the whole story is in $log"
    sed -n 's/.*Test unit written to \(.*\)/  again: '"${program//\//\\/}"' \1/p' "$log"
    return
  fi
  "$program" -set_cover_merge=1 -use_counters=0 "$corpus" "$grown" >>"$log" 2>&1
  local tried
  tried=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | head -n 1)
  echo "$name: $tried inputs tried, $(find "$corpus" -type f | wc -l) in the corpus"
}
