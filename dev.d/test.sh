# shellcheck shell=bash
# Running the tests, plainly and under the sanitizers.

command_test() {
  need "${PACKAGES_BUILD[@]}" "${PACKAGES_TEST[@]}"
  build_viewer
  has chromium "${PACKAGES_BROWSER[@]}" || say "without Chromium the page's tests are left out"
  configure_and_build release build
  run_tests test build ${1:+--tests-regex "$1"}
}

command_check() {
  need "${PACKAGES_BUILD[@]}" "${PACKAGES_TEST[@]}"
  local failures=0
  configure_and_build asan build-asan
  ASAN_OPTIONS=strict_string_checks=1:detect_stack_use_after_return=1 \
    UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 \
    run_tests 'check (address, undefined)' build-asan || failures=1
  # ThreadSanitizer of g++ 12 knows only the memory layouts of kernels with little randomisation.
  if setarch -R true 2>/dev/null; then around_build=(setarch -R); fi
  configure_and_build tsan build-tsan
  TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1 \
    run_tests 'check (thread)' build-tsan || failures=1
  return "$failures"
}

# run_tests NAME FOLDER [CTEST ARGUMENT...]: ctest where LCM can speak, then the closing line.
run_tests() {
  local name=$1 folder=$2 report=$PWD/$2/tests.xml
  shift 2
  rm -f "$report"
  say "running the tests of $folder"
  within_multicast ctest --test-dir "$folder" --parallel 2 --output-on-failure --no-tests=error \
    --output-junit "$report" "$@" || true
  [[ -s "$report" ]] || fail "ctest ended without a report"
  local total failed skipped
  total=$(junit_count tests "$report")
  failed=$(junit_count failures "$report")
  skipped=$(($(junit_count skipped "$report") + $(junit_count disabled "$report")))
  if ((skipped)); then
    say "$skipped skipped (their names are above), for these reasons:"
    grep -a -A 1 ': Skipped$' "$report" >&2 || true
  fi
  summary "$name" $((total - failed - skipped)) "$failed" "$skipped"
}

# junit_count ATTRIBUTE REPORT: that attribute of the first <testsuite>.
junit_count() {
  sed -n '/<testsuite/,/>/{s/.*[[:space:]]'"$1"'="\([0-9]*\)".*/\1/p}' "$2" | head -n 1
}

# within_multicast COMMAND...: in a network namespace of its own, where loopback carries
# multicast and nobody listens in; where the kernel forbids that, plainly.
within_multicast() {
  local namespace=(unshare --net)
  if ((EUID != 0)); then namespace=(unshare --map-root-user --net); fi
  local prepare
  prepare="$(declare -f multicast_on_loopback); multicast_on_loopback"
  if "${namespace[@]}" bash -c "$prepare" 2>/dev/null; then
    "${namespace[@]}" bash -c "$prepare && exec \"\$@\"" bash "${around_build[@]}" "$@"
  else
    say "no network namespaces here: without a multicast route, tests over real LCM skip. As root:"
    say "  ip link set lo multicast on; ip route add 224.0.0.0/4 dev lo"
    "${around_build[@]}" "$@"
  fi
}

multicast_on_loopback() {
  ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo
}
