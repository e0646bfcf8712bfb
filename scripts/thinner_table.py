#!/usr/bin/env python3
"""A table with a part of its digs alone: what the others are worth.

scripts/thinner_table.py TABLE.sqlite OUT.sqlite PACKINGS [FRICTIONS [ROLLINGS]]
    PACKINGS: 2 or more, the first of each gravel; FRICTIONS, ROLLINGS: those kept, as .3,.5,.9

Then scripts/evaluate.sh OUT.sqlite beside scripts/evaluate.sh TABLE.sqlite (docs/tables.md, "How many digs").
"""

import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile

import table_seal


def keep_values(db, axis, text):
    values = [float(v) for v in text.split(",")]
    marks = ", ".join("?" * len(values))
    other = f"ground IN (SELECT id FROM ground WHERE {axis} NOT IN ({marks}))"
    for rows in ("run", "entry"):
        db.execute(f"DELETE FROM {rows} WHERE {other}", values)
    db.execute(f"DELETE FROM ground WHERE {axis} NOT IN ({marks})", values)


def main(table, out, packings, *kept_values):
    with tempfile.TemporaryDirectory() as folder:
        kept = os.path.join(folder, "kept.sqlite")
        shutil.copyfile(table, kept)
        os.chmod(kept, 0o644)
        db = sqlite3.connect(kept)
        # merge makes the entries anew, of the runs that are left.
        db.execute("DELETE FROM seal")
        db.execute("DELETE FROM run WHERE packing >= ?", (packings,))
        for axis, text in zip(("friction", "rolling"), kept_values):
            keep_values(db, axis, text)
        db.execute(
            "UPDATE entry SET packings = (SELECT count(*) FROM run"
            " WHERE run.ground = entry.ground AND run.trajectory = entry.trajectory)"
        )
        table_seal.seal(db)
        db.close()
        subprocess.run([os.environ.get("BIN", "build/bin") + "/digtable", "merge", out, kept], check=True)


if __name__ == "__main__":
    if not 4 <= len(sys.argv) <= 6 or int(sys.argv[3]) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]), *sys.argv[4:])
