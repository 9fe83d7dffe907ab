#!/usr/bin/env bash
# Runs the simulations of thesis section 3.7 and those beyond it, and makes the tables and figures
# of docs/maintenance-simulation.md.
#
# Usage: experiments/maintenance/run.sh [--runs N] [--build DIR] [--out DIR] [--document FILE]
#   --runs N         per point (250, as in the thesis; the costlier studies make fewer)
#   --document FILE  put tables and figures into this document, too
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source experiments/options.sh

runs=250 build=build out=build/experiments/maintenance document=
read_options "--runs --build --out --document" "$(sed -n '2,8s/^# \{0,1\}//p' experiments/maintenance/run.sh)" "$@"
need_program "$build/maintenance_simulation"
mkdir -p "$out"
# Two at a time.
"$build/maintenance_simulation" --runs "$runs" house "quiet house" >"$out/house.csv" &
house=$!
"$build/maintenance_simulation" --runs "$runs" threshold omega sensitivity unreliable \
  >"$out/room.csv"
wait "$house"
python3 experiments/maintenance/report.py "$out/room.csv" "$out/house.csv" --out "$out" \
  ${document:+--document "$document"}
