# shellcheck shell=bash
# The page: bundled from viewer/ and its lockfile into build/viewer.

readonly VIEWER=build/viewer

# has COMMAND PACKAGE...: the command, Debian's unless there is another; false if it cannot be had.
has() {
  command -v "$1" >/dev/null || (need "${@:2}")
}

# build_viewer: into $VIEWER, from what the lockfile names. Where that cannot be downloaded the daemon
# is built, and serves, without the page.
build_viewer() {
  has npm "${PACKAGES_VIEWER[@]}" || {
    say "without node and npm the page is left out"
    return 0
  }
  local modules=viewer/node_modules log=$CACHE/viewer.log
  if ! cmp -s viewer/package-lock.json "$modules/.of-lockfile"; then
    say "downloading what viewer/package-lock.json names"
    npm --prefix viewer ci --no-audit --no-fund --loglevel=error --fetch-retries=1 \
      --fetch-retry-mintimeout=2000 >"$log" 2>&1 || {
      tail -n 20 "$log" >&2
      say "npm could not download what viewer/package-lock.json names: the page is left out"
      return 0
    }
    cp viewer/package-lock.json "$modules/.of-lockfile"
  fi
  say "bundling the page into $VIEWER"
  npm --prefix viewer run --silent check >&2 || fail "the page's types do not fit"
  node viewer/build.mjs "$VIEWER" >&2 || fail "the page could not be bundled"
}
