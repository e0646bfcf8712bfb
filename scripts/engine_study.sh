#!/bin/bash
# Do two engines dig alike? Over every gravel and trajectory of a table that has runs of both
# (docs/numerics/dem.md, "On a graphics card"). A minute.
#   BIN=build/bin scripts/engine_study.sh [TABLE.sqlite [FIRST [SECOND]]]
set -euo pipefail
bin=${BIN:-build/bin} table=${1:-tables/reference_rig.sqlite} first=${2:-kernel} second=${3:-cuda}

"$bin/digtable" export "$table" --runs | awk -v first="$first" -v second="$second" -f scripts/compare_runs.awk
