# shellcheck shell=bash
# The page: bundled from viewer/ and its lockfile into build/viewer.

readonly VIEWER=build/viewer

# need_node: node and npm, Debian's unless there are others.
need_node() {
  if command -v node >/dev/null && command -v npm >/dev/null; then return; fi
  need "${PACKAGES_VIEWER[@]}"
}

# build_viewer: into $VIEWER, from what the lockfile names.
build_viewer() {
  need_node
  local modules=viewer/node_modules log=$CACHE/viewer.log
  if ! cmp -s viewer/package-lock.json "$modules/.of-lockfile"; then
    say "downloading what viewer/package-lock.json names"
    npm --prefix viewer ci --no-audit --no-fund --loglevel=error >"$log" 2>&1 || {
      tail -n 20 "$log" >&2
      fail "npm could not install what viewer/package-lock.json names"
    }
    cp viewer/package-lock.json "$modules/.of-lockfile"
  fi
  say "bundling the page into $VIEWER"
  npm --prefix viewer run --silent check >&2 || fail "the page's types do not fit"
  node viewer/build.mjs "$VIEWER" >&2 || fail "the page could not be bundled"
}
