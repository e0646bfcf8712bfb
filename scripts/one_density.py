#!/usr/bin/env python3
"""A table with one density of each gravel kept, whose scene says that springs go with the density.

scripts/one_density.py TABLE.sqlite OUT.sqlite [KGPM3]   KGPM3: 2500, which must be one of the table's

What density as a scale costs is then seen by scripts/evaluate.sh OUT.sqlite beside scripts/evaluate.sh TABLE.sqlite.
The digs are as they were: true of a scene that says so only at that one density.
"""

import hashlib
import os
import shutil
import sqlite3
import sys

import table_seal


def main(table, out, density_kgpm3):
    shutil.copyfile(table, out)
    os.chmod(out, 0o644)
    db = sqlite3.connect(out)
    (canonical,) = db.execute("SELECT canonical FROM scene").fetchone()
    head, _, trajectories = canonical.partition("trajectory=")
    lines = ("trajectory=" + trajectories).splitlines()
    # Behind the last trajectory, before what is not plain in laws and bed.
    last = max(i for i, line in enumerate(lines) if line.startswith("phase="))
    lines.insert(last + 1, f"young_at_kgpm3={density_kgpm3:.17g}")
    canonical = head + "\n".join(lines) + "\n"
    digest = hashlib.sha256(canonical.encode()).hexdigest()
    db.execute("UPDATE scene SET canonical = ?, hash = ?", (canonical, digest))
    db.execute("DELETE FROM seal")
    other = "ground IN (SELECT id FROM ground WHERE density_kgpm3 <> ?)"
    for rows in ("run", "entry"):
        db.execute(f"DELETE FROM {rows} WHERE {other}", (density_kgpm3,))
    db.execute("DELETE FROM ground WHERE density_kgpm3 <> ?", (density_kgpm3,))
    table_seal.seal(db)
    db.close()


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]) if len(sys.argv) == 4 else 2500.0)
