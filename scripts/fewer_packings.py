#!/usr/bin/env python3
"""A table with the first beds of each gravel alone: what the others are worth.

scripts/fewer_packings.py TABLE.sqlite OUT.sqlite PACKINGS   PACKINGS: 2 or more

Then scripts/evaluate.sh OUT.sqlite beside scripts/evaluate.sh TABLE.sqlite (docs/tables.md, "How many packings").
"""

import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile


def main(table, out, packings):
    with tempfile.TemporaryDirectory() as folder:
        kept = os.path.join(folder, "kept.sqlite")
        shutil.copyfile(table, kept)
        os.chmod(kept, 0o644)
        db = sqlite3.connect(kept)
        # merge makes the entries anew, of the runs that are left.
        db.execute("DROP TABLE seal")
        db.execute("DELETE FROM run WHERE packing >= ?", (packings,))
        db.execute(
            "UPDATE entry SET packings = (SELECT count(*) FROM run"
            " WHERE run.ground = entry.ground AND run.trajectory = entry.trajectory)"
        )
        db.execute("PRAGMA user_version = 3")
        db.commit()
        db.close()
        subprocess.run([os.environ.get("BIN", "build/bin") + "/digtable", "merge", out, kept], check=True)


if __name__ == "__main__":
    if len(sys.argv) != 4 or int(sys.argv[3]) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]))
