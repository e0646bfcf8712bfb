"""A table of digtable (docs/formats/tables.md, "Table (SQLite)").

A file that is no such table, and a selection that the table does not hold, raise ValueError; a file that is missing or
cannot be opened raises OSError. Seals are not checked: `digtable check` finds damage.
"""

import os
import sqlite3
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from pandas.api.types import is_numeric_dtype

from .outside import check_regular, check_texts

APPLICATION_ID = 0x44494754  # "DIGT"
VERSION = 4
KEYS = ["friction", "rolling", "density_kgpm3", "trajectory", "effect", "magnitude", "depth", "attack_deg"]
RUN_KEYS = ["packing", "seed", "engine", "version", "grains"]
PLAIN = {"effect": "", "depth": 1.0, "attack_deg": 0.0}
CHANNELS = ["moment_Nm", "fx_N", "fz_N", "carried_kg"]  # in the order of a blob
SPREADS = ["moment_sd_Nm", "fx_sd_N", "fz_sd_N", "carried_sd_kg"]
ENTRIES = """SELECT friction, rolling, density_kgpm3, t.name AS trajectory, packings, effect, magnitude, depth,
    attack_rad, e.ground, e.trajectory AS number
    FROM entry e JOIN ground g ON g.id = e.ground JOIN trajectory t ON t.id = e.trajectory
    ORDER BY 1, 2, 3, effect, magnitude, depth, attack_rad, number"""

# Of what is computed with: a column that is not STRICT, and one that was not when it was written, holds anything.
TYPES = {"points": int, "packings": int, "packing": int, "windows": int, "first_s": float, "step_s": float}

PHASES = """SELECT t.name AS trajectory, number, p.name AS phase, duration_s, vx_mps, vz_mps, omega_radps
    FROM phase p JOIN trajectory t ON t.id = p.trajectory ORDER BY t.id, number"""


@dataclass(frozen=True, repr=False)
class Table:
    """An open table. Its connection only reads, and holds no lock between calls."""

    path: str
    scene: dict[str, Any]  # the row: name, hash, canonical, tooth_m, bucket_width_m, young_Pa, smooth_half_s, points
    phases: pd.DataFrame  # what every trajectory does, phase by phase; of the plain ones
    _entries: pd.DataFrame
    _db: sqlite3.Connection

    def __repr__(self) -> str:
        return f"<table {self.path}: scene {self.scene['name']}, {len(self._entries)} curves>"

    def entries(self) -> pd.DataFrame:
        """One row a curve: gravel, trajectory, packings, effect, magnitude, depth, attack_deg."""
        return self._entries.drop(columns=["ground", "number"])

    def curves(self, **where: float | str | None) -> pd.DataFrame:
        """Mean and standard deviation of one dig along the path, one row a point, of every curve selected.

        Keys are the columns of entries(). Only plain digs are selected unless effect, depth or attack_deg say
        otherwise; None stands for any. The deviation of a curve with a single packing is NaN.
        """
        points = self.scene["points"]
        frames = []
        for row in self._select(where):
            what = f"{self.path}: entry ({row['ground']}, {row['number']})"
            (entry,) = self._rows("SELECT packings, mean, spread FROM entry", row)
            mean = _channels(entry["mean"], points, f"{what}: mean")
            spread = np.full_like(mean, np.nan)
            if entry["spread"] is not None:
                spread = _channels(entry["spread"], points, f"{what}: spread")
            frame = pd.DataFrame({key: row[key] for key in KEYS} | {"packings": entry["packings"]}, index=range(points))
            frame["progress"] = np.linspace(0.0, 1.0, points)
            frame[CHANNELS] = mean.T
            frame[SPREADS] = spread.T
            frames.append(frame)
        return pd.concat(frames, ignore_index=True)

    def curve(self, **where: float | str | None) -> pd.DataFrame:
        """The one curve that is selected, as curves() does, over progress 0 to 1 along the path."""
        rows = self._select(where)
        if len(rows) != 1:
            differ = [key for key in KEYS if len({row[key] for row in rows}) > 1]
            raise ValueError(f"{self.path}: {len(rows)} curves fit, expected one: {', '.join(differ)} must be given")
        columns = [name for pair in zip(CHANNELS, SPREADS) for name in pair]
        return self.curves(**where).set_index("progress")[columns]

    def runs(self, **where: float | str | None) -> pd.DataFrame:
        """What the engine gave, one row a window, of every dig of the curves selected as curves() does."""
        frames = []
        for row in self._select(where):
            found = self._rows("SELECT * FROM run", row)
            if len(found) < row["packings"]:
                raise ValueError(f"{self.path}: run: {len(found)} of an entry with {row['packings']} packings")
            for run in sorted(found, key=lambda run: run["packing"]):
                value = _channels(run["curve"], run["windows"], f"{self.path}: run {run['id']}: curve")
                keys = {key: row[key] for key in KEYS} | {key: run[key] for key in RUN_KEYS}
                frame = pd.DataFrame(keys, index=range(run["windows"]))
                frame["t_s"] = run["first_s"] + run["step_s"] * np.arange(run["windows"])
                frame[CHANNELS] = value.T
                frames.append(frame)
        return pd.concat(frames, ignore_index=True)

    def _rows(self, select: str, row: dict[str, Any]) -> list[dict[str, Any]]:
        """Of the entry that the row names."""
        sql = f"{select} WHERE ground = ? AND trajectory = ?"
        return _query(self._db, self.path, sql, row["ground"], row["number"]).to_dict("records")

    def _select(self, where: dict[str, float | str | None]) -> list[dict[str, Any]]:
        rows = self._entries
        for key, value in {**PLAIN, **where}.items():
            if key not in KEYS:
                raise TypeError(f"{key}: no such key, expected one of {', '.join(KEYS)}")
            if value is None:
                continue
            known = rows[key]
            fits = np.isclose(known, value, rtol=1e-9, atol=1e-9) if is_numeric_dtype(known) else known == value
            if not fits.any():
                held = ", ".join(map(repr, known.unique()))
                raise ValueError(f"{self.path}: {key} {value!r}: the table has {held or 'none'} there")
            rows = rows[fits]
        return rows.to_dict("records")


def open_table(path: str | Path) -> Table:
    """Opens a table for reading."""
    name = str(path)
    check_regular(path)
    real = os.path.realpath(path)
    for beside in (f"{real}-journal", f"{real}-wal"):  # SQLite would open them, beside what a link points to
        if os.path.lexists(beside):
            check_regular(beside)
    with open(path, "rb"):  # SQLite's own error does not say why
        pass
    db = sqlite3.connect(f"{Path(real).as_uri()}?mode=ro", uri=True)
    _query(db, name, "PRAGMA trusted_schema = OFF")
    identity = _query(db, name, "PRAGMA application_id").iat[0, 0]
    version = _query(db, name, "PRAGMA user_version").iat[0, 0]
    if identity != APPLICATION_ID:
        raise ValueError(f"{name}: not a table of digtable (application_id {identity}, expected {APPLICATION_ID})")
    if version != VERSION:
        raise ValueError(f"{name}: table format {version}, expected {VERSION} (`digtable generate` makes it anew)")
    # Their types are what SQLite made of the schema, not what its text looks like.
    foreign = "SELECT 1 FROM pragma_table_list WHERE schema = 'main' AND type <> 'table'"
    trigger = "SELECT 1 FROM sqlite_master WHERE type = 'trigger'"
    computed = "SELECT 1 FROM sqlite_master m JOIN pragma_table_xinfo(m.name) WHERE hidden <> 0"
    if any(len(_query(db, name, sql)) > 0 for sql in (foreign, trigger, computed)):
        raise ValueError(f"{name}: a view, trigger, virtual table or column, expected the tables of digtable alone")

    scene = _query(db, name, "SELECT * FROM scene").drop(columns="id").to_dict("records")
    if len(scene) != 1 or scene[0]["points"] < 2:
        raise ValueError(f"{name}: scene: expected one row, of two points or more")
    phases = _query(db, name, PHASES)
    entries = _query(db, name, ENTRIES)
    entries.insert(8, "attack_deg", np.degrees(entries.pop("attack_rad").astype(float)))
    return Table(name, scene[0], phases, entries, db)


def _query(db: sqlite3.Connection, path: str, sql: str, *values: int) -> pd.DataFrame:
    try:
        cursor = db.execute(sql, values)
        rows = cursor.fetchall()
    except sqlite3.Error as error:
        raise ValueError(f"{path}: {error}, expected a table of digtable") from error
    check_texts(path, rows)
    names = [column[0] for column in cursor.description or ()]
    for name, values in zip(names, zip(*rows)):
        if name in TYPES and not all(isinstance(value, TYPES[name]) for value in values):
            raise ValueError(f"{path}: {name}: expected numbers")
    return pd.DataFrame(rows, columns=names)


def _channels(blob: Any, points: int, what: str) -> np.ndarray:
    """A blob as one row a channel. The carried mass is NaN throughout where it is not known."""
    if not isinstance(blob, bytes):
        raise ValueError(f"{what}: a {type(blob).__name__}, expected bytes")
    if len(blob) != 4 * 4 * points:
        raise ValueError(f"{what}: {len(blob)} bytes, expected {4 * 4 * points}")
    value = np.frombuffer(blob, "<f4").reshape(4, points).astype(float)
    finite = np.isfinite(value)
    if not finite[:3].all() or not (finite[3].all() or np.isnan(value[3]).all()):
        raise ValueError(f"{what}: expected finite numbers")
    return value
