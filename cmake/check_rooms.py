#!/usr/bin/env python3
"""Checks every #include against what its room may include.

Usage: check_rooms.py [ROOT]. Prints each violation as file:line: what; exit status 1 if any.
"""

import pathlib
import re
import sys

# What each room may include beside itself, in the order in which a detection passes through them.
ROOMS = {
    "core": set(),
    "lcmtypes": {"core"},
    "geometry": {"core"},
    "models": {"core", "geometry"},
    "knowledge": {"core", "geometry"},
    "mht": {"core"},
    "anchoring": {"core", "geometry", "models", "knowledge", "mht"},
    "maintenance": {"core", "geometry", "models", "knowledge", "mht", "anchoring"},
    "perception": {"core", "geometry", "knowledge"},
    "api": {"core", "lcmtypes", "geometry", "models", "knowledge", "mht"}
    | {"anchoring", "maintenance"},
}
# Programs and what exercises the rooms: they may include every room.
FREE = {"daemon", "tools", "bench", "fuzz", "tests", "experiments", "clients"}
# Libraries that belong to some rooms only: (headers, paths that may include them).
LIBRARIES = [
    (r"sqlite3\.h", ["knowledge/"]),
    (
        r"nlohmann/.*",
        ["api/", "knowledge/configuration", "knowledge/json_reader", "perception/camera_file"]
        + ["tools/anchorctl", "tools/anchor_tune"],
    ),
    (r"lcm/.*|anchord/\w+_t\.hpp", ["lcmtypes/", "api/", "tools/", "clients/"]),
    (r"opencv2/.*", ["perception/", "tools/"]),
    (
        r"thread|mutex|shared_mutex|atomic|condition_variable|future|stop_token|latch|barrier"
        r"|semaphore|pthread\.h",
        ["daemon/", "api/", "tools/", "clients/"],
    ),
]
EXERCISE = ("tests/", "bench/", "fuzz/", "experiments/")  # may use any library
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


def violation(path: str, quote: str, header: str) -> str | None:
    """Why the file at `path` (from the root, with slashes) may not include `header`, or None."""
    room = path.split("/")[0]
    if room not in ROOMS and room not in FREE:
        return f"{room}/ is not in the table of rooms (cmake/check_rooms.py)"
    other = header.split("/")[0] if "/" in header else None
    if other in ROOMS or other in FREE:
        if room in FREE or other == room or other in ROOMS[room]:
            return None
        return f"{room} may not include {header}: {describe(ROOMS[room])}"
    for pattern, allowed in LIBRARIES:
        if re.fullmatch(pattern, header):
            if path.startswith((*allowed, *EXERCISE)):
                return None
            return f"{header} is for {', '.join(allowed)} only"
    if quote == '"' and other is None and room in ROOMS:
        return f'write "{room}/{header}": headers of rooms are included from the root'
    return None


def describe(rooms: set[str]) -> str:
    return f"it may include {', '.join(sorted(rooms))}" if rooms else "it may include no other room"


def check(root: pathlib.Path) -> list[str]:
    """Every violation below `root`, as file:line: what."""
    found = []
    for folder in sorted(p for p in root.iterdir() if p.is_dir()):
        if folder.name.startswith((".", "build")):
            continue
        for file in sorted(p for p in folder.rglob("*") if p.suffix in {".cc", ".h"}):
            path = file.relative_to(root).as_posix()
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                match = INCLUDE.match(line)
                if match and (why := violation(path, *match.groups())):
                    found.append(f"{path}:{number}: {why}")
    return found


def main() -> int:
    default = pathlib.Path(__file__).resolve().parent.parent
    found = check(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else default)
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
