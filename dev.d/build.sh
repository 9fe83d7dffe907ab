# shellcheck shell=bash
# Building: one folder per preset, build/ for release.

# configure_and_build PRESET FOLDER [TARGET...]: everything, or the named targets.
configure_and_build() {
  local preset=$1 folder=$2 jobs launcher=()
  shift 2
  local targets=("${@:-all}")
  jobs=$(nproc)
  if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  say "configuring $folder (preset $preset${launcher:+, with ccache})"
  local log=$CACHE/configure.log
  "${around_build[@]}" cmake --preset "$preset" "${launcher[@]}" -Wno-dev >"$log" 2>&1 || {
    tail -n 40 "$log" >&2
    fail "CMake could not configure; the lines above are the end of $log"
  }
  cmake --build "$folder" -- -t cleandead >/dev/null  # programs that are no longer built
  say "building ${*:-everything} in $folder, $jobs at a time"
  NINJA_STATUS='[%f/%t %es] ' "${around_build[@]}" \
    cmake --build "$folder" --parallel "$jobs" --target "${targets[@]}" >&2 ||
    fail "the build failed: the first error above is the one to look at"
}

# What builds and tests run under; ThreadSanitizer needs something here (test.sh).
around_build=()

command_build() {
  need "${PACKAGES_BUILD[@]}"
  build_viewer
  configure_and_build release build
  say "the programs are in build/:"
  programs | sed 's/^/    /'
}

command_package() {
  need "${PACKAGES_BUILD[@]}" "${PACKAGES_PACKAGE[@]}"
  build_viewer
  configure_and_build package build-package
  say "packing build-package"
  rm -f build-package/*.deb
  (cd build-package && cpack) >"$CACHE/cpack.log" 2>&1 || {
    tail -n 40 "$CACHE/cpack.log" >&2
    fail "CPack could not make the package; the lines above are the end of $CACHE/cpack.log"
  }
  say "the package, for apt install ./FILE, is"
  ls build-package/*.deb
}

# programs: what a user runs, leaving out tests and benchmarks.
programs() {
  find build -maxdepth 1 -type f -executable ! -name '*_test' ! -name '*_bench' | sort
}

command_bench() {
  need "${PACKAGES_BUILD[@]}"
  configure_and_build release build
  local benches bench
  mapfile -t benches < <(find build -maxdepth 1 -type f -executable -name '*_bench' | sort)
  ((${#benches[@]})) || fail "no benchmark was built: expected build/*_bench"
  echo "machine: $(uname -n), $(machine_description), $(date -u +%F)"
  local arguments
  for bench in "${benches[@]}"; do
    arguments=()
    if [[ $bench == */micro_bench ]]; then arguments=("$@"); fi  # the one on Google Benchmark
    printf '\n%s\n' "$bench"
    within_multicast "$bench" "${arguments[@]}"
  done
}

machine_description() {
  local cpu
  cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
  echo "$(nproc) x ${cpu:-$(uname -m)}, Linux $(uname -r)"
}
