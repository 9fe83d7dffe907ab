# shellcheck shell=bash
# shellcheck disable=SC2034  # the lists are used by the other parts
# Every Debian 12 package that the project needs, by what it is needed for; nothing else installs
# anything. libboost1.81-dev conflicts with Debian's default Boost (1.74): no package that pulls
# libboost-dev or a *1.74 one may enter these lists.

PACKAGES_BUILD=(
  g++ cmake ninja-build pkg-config
  libeigen3-dev                              # vectors and matrices
  liblcm-dev liblcm-bin libglib2.0-dev       # LCM, its lcm-gen, and what lcm.pc requires
  libsqlite3-dev                             # the frame log
  libcereal-dev                              # checkpoints of the belief
  nlohmann-json3-dev                         # configuration, HTTP API
  libboost1.81-dev                           # Beast: HTTP
  libcli11-dev libspdlog-dev libsystemd-dev  # command lines, logging, service readiness
  libopencv-core-dev libopencv-imgproc-dev libopencv-objdetect-dev libopencv-video-dev
  libopencv-videoio-dev libopencv-imgcodecs-dev    # perception
  libgtest-dev librapidcheck-dev libbenchmark-dev  # one configuration builds tests, benchmarks too
)
PACKAGES_TEST=(python3 iproute2)
PACKAGES_VIEWER=(nodejs npm)      # bundles the page
PACKAGES_BROWSER=(chromium)       # looks at it
PACKAGES_RUN=(iproute2)
PACKAGES_PACKAGE=(dpkg-dev file gzip)  # dpkg-deb, dpkg-shlibdeps
PACKAGES_FORMAT=(clang-format-14)
PACKAGES_LINT=(clang-format-14 cppcheck shellcheck python3)
PACKAGES_FUZZ=(clang-14 libclang-rt-14-dev llvm-14)

# need PACKAGE...: installs those that are missing; silent and quick when none is.
need() {
  command -v dpkg-query >/dev/null || {
    say "not a Debian: what these packages hold must be here already: $*"
    return
  }
  local missing packages
  missing=$(missing_packages "$@")
  [[ -n $missing ]] || return 0
  mapfile -t packages <<<"$missing"
  if ((EUID != 0)) && ! command -v sudo >/dev/null; then
    fail "packages are missing, and there is neither root nor sudo to install them. As root:
  apt-get install --no-install-recommends ${packages[*]}"
  fi
  say "installing ${#packages[@]} missing packages: ${packages[*]}"
  say "asking the mirrors what they have (apt-get update)"
  apt_get update
  say "downloading and unpacking them with what they depend on"
  apt_get install --no-install-recommends --no-remove "${packages[@]}"
}

# missing_packages PACKAGE...: those that are not installed, one per line.
missing_packages() {
  local installed
  installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null |
    sed -n 's/^installed //p') || true
  printf '%s\n' "$@" | grep -vxF "$installed" || true
}

# apt_get ARGUMENT...: without questions; its output goes to a log, a line for every fifty
# packages to the terminal. Waits for another apt that is running.
apt_get() {
  local log=$CACHE/apt.log
  as_root env DEBIAN_FRONTEND=noninteractive apt-get --yes --quiet \
    -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 "$@" 2>&1 | tee "$log" |
    awk '/^Need to get/ || /newly installed/ {print "    " $0; fflush()}
         /^Unpacking/ && ++unpacked % 50 == 0 {print "    " unpacked " unpacked"; fflush()}
         /^Setting up/ && ++ready % 50 == 0 {print "    " ready " set up"; fflush()}' >&2 || {
    tail -n 20 "$log" >&2
    fail "apt-get $1 failed; the lines above are the end of $log"
  }
}
