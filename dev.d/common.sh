# shellcheck shell=bash
# What every part of ./dev uses: messages, and which files are the project's.

# shellcheck disable=SC2034  # the other parts use it
readonly CACHE=.cache

# say MESSAGE...: what is being done, on standard error, so that answers stay alone on the other.
say() { printf '\033[1m==>\033[0m %s\n' "$*" >&2; }
if [[ ! -t 2 ]]; then say() { printf '==> %s\n' "$*" >&2; }; fi

# fail MESSAGE [STATUS]: says what went wrong and ends.
fail() {
  printf './dev: %s\n' "$1" >&2
  exit "${2:-1}"
}

# as_root COMMAND...: runs it as root, through sudo where we are not.
as_root() {
  if ((EUID == 0)); then "$@"; else sudo "$@"; fi
}

# project_files [PATTERN...]: the project's own files that match, one per line. Without git
# (a tarball, a container) the build and cache folders are left out by name.
project_files() {
  if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    git ls-files --cached --others --exclude-standard -- "$@" | sort -u | while read -r file; do
      if [[ -f "$file" ]]; then echo "$file"; fi
    done
  else
    local names=() pattern
    for pattern in "$@"; do names+=(-o -path "./$pattern" -o -path "./*/$pattern"); done
    find . \( -name .git -o -path './build*' -o -path ./.cache -o -path ./anchord-data \
      -o -name __pycache__ \) -prune -o -type f \( -false "${names[@]}" \) -print |
      sed 's|^\./||' | sort
  fi
}

# source_files: what clang-format and the analysers look at.
source_files() { project_files '*.cc' '*.h'; }

# summary NAME PASSED FAILED [SKIPPED]: the closing line of a command; fails if anything did.
summary() {
  printf '%s: %d passed, %d failed%s\n' "$1" "$2" "$3" "${4:+, $4 skipped}"
  (($3 == 0))
}
