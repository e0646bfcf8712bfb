#!/bin/sh
# What part 1 of the tutorial makes, for a reader who begins with part 3: table, recordings, model.
set -eu
digtable generate -q scene.yaml grid.yaml -o yard.sqlite
sh site.sh
digloop trace yard.sqlite campaign --json trace.json --add model.json 2>trace.txt
