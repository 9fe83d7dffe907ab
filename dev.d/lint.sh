# shellcheck shell=bash
# What a machine can say about the source: style, rooms, suspicious code, sizes, paths.

readonly LONGEST_FILE=400  # lines
readonly CLANG_FORMAT=clang-format-14

command_format() {
  need "${PACKAGES_FORMAT[@]}"
  source_files | xargs -r "$CLANG_FORMAT" -i
  say "formatted $(source_files | wc -l) files"
}

command_lint() {
  need "${PACKAGES_LINT[@]}"
  mkdir -p "$CACHE/cppcheck"
  local check passed=0 failed=0
  for check in check_format check_rooms check_scripts check_sizes check_paths check_analysis; do
    say "$check"
    if "$check"; then passed=$((passed + 1)); else
      failed=$((failed + 1))
      echo "$check failed" >&2
    fi
  done
  summary lint "$passed" "$failed"
}

check_format() {
  source_files | xargs -r "$CLANG_FORMAT" --dry-run --Werror || {
    echo './dev format mends this' >&2
    return 1
  }
}

check_rooms() { python3 cmake/check_rooms.py; }

check_scripts() {
  { echo dev && echo .ci/run && project_files '*.sh' 'packaging/p*'; } | xargs shellcheck --external-sources
}

check_sizes() {
  project_files '*.cc' '*.h' '*.py' '*.sh' '*.cmake' '*.ts' '*.mjs' '*.css' '*.html' dev |
    xargs wc -l | awk -v most="$LONGEST_FILE" '
      $2 != "total" && $1 > most {print $2 ": " $1 " lines, more than " most; bad = 1}
      END {exit bad}'
}

# A path of the machine that a file was written on means nothing on another.
check_paths() {
  local found
  found=$(project_files '*' | grep -v '^fuzz/corpus/' |
    xargs -r -d '\n' grep -InE "(^|[^[:alnum:]_.<>-])/(work|farm|root|tmp|home/[a-z]+)/" || true)
  [[ -z "$found" ]] || {
    echo "$found"
    return 1
  }
}

# Cppcheck does all files in the time that clang-tidy needs for a few (1 to 11 s each). Left out are
# matters of taste and what its version 2.10 misjudges: std::array<T, N + 1> as N elements,
# `return a = std::move(b)` under an if, sums that start at 0.
check_analysis() {
  source_files | grep '\.cc$' | cppcheck --file-list=- -I . -j "$(nproc)" --quiet --std=c++20 \
    --language=c++ --library=googletest \
    -D'TYPED_TEST(suite, name)=void suite##_##name()' \
    -D'RC_GTEST_PROP(suite, name, arguments)=void suite##_##name arguments' \
    --enable=warning,performance,portability --inline-suppr \
    --suppress=missingInclude --suppress=missingIncludeSystem --suppress=unknownMacro \
    --suppress=useInitializationList --suppress=uselessCallsSubstr \
    --suppress=containerOutOfBounds --suppress=accessMoved --suppress=invalidFunctionArg \
    --cppcheck-build-dir="$CACHE/cppcheck" --error-exitcode=1 \
    --template='{file}:{line}: {severity}: {message} [{id}]'
}
