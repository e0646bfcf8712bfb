# What the system tests of digtable share. Source it from the repository's root.
. tests/system/check.bash
scene=tests/data/formats/scene.yaml # a coarse tub: a dig takes a fraction of a second

# digtable ARGUMENTS…: its exit code in $code, its words in $work/out and $work/err.
digtable() {
    code=0
    "$BIN/digtable" "$@" >"$work/out" 2>"$work/err" </dev/null || code=$?
}

runs() { # TABLE: how many it has
    sqlite3 "$1" 'SELECT count(*) FROM run' 2>/dev/null | grep . || echo 0
}
