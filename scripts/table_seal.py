#!/usr/bin/env python3
"""Seals every entry of a table anew, after its rows were changed (docs/formats/tables.md, "Seals").

scripts/table_seal.py TABLE.sqlite
"""

import hashlib
import sqlite3
import struct
import sys

ENTRY = """SELECT s.name, s.hash, s.tooth_m, s.bucket_width_m, s.young_Pa, s.smooth_half_s, s.points,
    g.friction, g.rolling, g.density_kgpm3, g.effect, g.magnitude, g.depth, g.attack_rad,
    e.trajectory, e.packings, e.mean, e.spread
    FROM entry e JOIN ground g ON g.id = e.ground JOIN scene s WHERE e.ground = ? AND e.trajectory = ?"""
RUNS = """SELECT packing, seed, engine, version, grains, windows, first_s, step_s, curve, made_utc, wall_s
    FROM run WHERE ground = ? AND trajectory = ? ORDER BY packing"""


def packed(value):
    if value is None:
        return struct.pack("<q", 5)
    if isinstance(value, int):
        return struct.pack("<qq", 1, value)
    if isinstance(value, float):
        return struct.pack("<qd", 2, value)
    data = value.encode() if isinstance(value, str) else value
    return struct.pack("<qq", 3 if isinstance(value, str) else 4, len(data)) + data


def seal(db):
    db.execute("DELETE FROM seal")
    for entry in db.execute("SELECT ground, trajectory FROM entry ORDER BY 1, 2").fetchall():
        rows = db.execute(ENTRY, entry).fetchall() + db.execute(RUNS, entry).fetchall()
        digest = hashlib.sha256(b"".join(packed(value) for row in rows for value in row)).digest()
        db.execute("INSERT INTO seal VALUES (?, ?, ?)", (*entry, int.from_bytes(digest[:8], "big") >> 1))
    db.commit()


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    seal(sqlite3.connect(sys.argv[1]))
