"""python/digsight against what digtable prints of the same tables. tests/system/python.sh runs it."""

import io
import json
import os
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest
from contextlib import closing, redirect_stdout
from pathlib import Path

import digsight
import numpy as np
import pandas as pd

RIG, EFFECTS, PRODUCT = (f"tables/{name}.sqlite" for name in ("reference_rig", "reference_rig_effects", "product"))
OURS = {"My_Nm": "moment_Nm", "My_sd_Nm": "moment_sd_Nm"}
OURS |= {"Fx_N": "fx_N", "Fx_sd_N": "fx_sd_N", "Fz_N": "fz_N", "Fz_sd_N": "fz_sd_N"}
PLAIN = {"effect": "", "depth": 1, "attack_deg": 0}
ORDER = [*digsight.table.KEYS, "packing", "t_s", "progress"]
ANY = dict.fromkeys(PLAIN)
# A column takes anything once its table is not STRICT.
LAX = """PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = replace(replace(sql, 'STRICT', ''), 'NOT NULL', '');
    PRAGMA writable_schema = RESET; PRAGMA ignore_check_constraints = ON;"""
# SQLite reads it as before.
HIDDEN = """PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = replace(sql, 'CREATE VIRTUAL', 'CREATE /**/ VIRTUAL');
    PRAGMA writable_schema = RESET;"""


def digtable(*words: str) -> str:
    command = [os.environ.get("BIN", "build/bin") + "/digtable", *words]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def exported(*words: str) -> pd.DataFrame:
    unknown = {"carried_kg": "", "carried_sd_kg": ""}
    return pd.read_csv(io.StringIO(digtable(*words)), keep_default_na=False, na_values=unknown).rename(columns=OURS)


def changed(folder: str, sql: str) -> Path:
    path = Path(folder, "changed.sqlite")
    shutil.copyfile(PRODUCT, path)
    with closing(sqlite3.connect(path)) as db:
        db.executescript(sql)
    return path


class Digsight(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def same(self, ours: pd.DataFrame, theirs: pd.DataFrame) -> None:
        """In all that theirs has but the time of a mean curve; numbers as they are written, with nine digits."""
        by = [name for name in ORDER if name in theirs and name in ours]
        ours, theirs = (frame.round({"attack_deg": 6}).sort_values(by, ignore_index=True) for frame in (ours, theirs))
        self.assertEqual(len(ours), len(theirs))
        for name in theirs.columns.intersection(ours.columns) if "progress" in theirs else theirs:
            if theirs[name].dtype == object:
                self.assertTrue((ours[name] == theirs[name]).all(), name)
            else:
                np.testing.assert_allclose(ours[name], theirs[name], rtol=1e-8, atol=1e-12, err_msg=name)

    def test_curves_are_those_that_digtable_exports(self) -> None:
        for words in (["export", RIG], ["export", PRODUCT], ["export", "--effects", EFFECTS]):
            ours, theirs = digsight.open_table(words[-1]).curves(**ANY), exported(*words)
            self.assertEqual(set(theirs) - set(ours), {"t_s"})
            # digtable gives a single packing the spread of the others.
            theirs.loc[theirs["packings"] == 1, theirs.columns.str.contains("_sd_")] = np.nan
            self.same(ours, theirs)

    def test_one_curve_is_what_digtable_shows(self) -> None:
        for table, density_kgpm3 in ((RIG, 2500), (PRODUCT, 2500)):  # the second holds it at other depths, too
            where = {"friction": 0.3, "rolling": 0.3, "density_kgpm3": density_kgpm3, "trajectory": "actual"}
            ours = digsight.open_table(table).curve(**where)
            gravel = ("--friction", ".3", "--rolling", ".3", "--density", str(density_kgpm3))
            self.same(ours.reset_index(), exported("show", table, *gravel, "--trajectory", "actual", "--csv"))

    def test_runs_are_those_that_digtable_exports(self) -> None:
        self.same(digsight.open_table(PRODUCT).runs(**ANY), exported("export", PRODUCT, "--runs"))

    def test_entries_are_those_that_digtable_lists(self) -> None:
        for table in (RIG, EFFECTS, PRODUCT):
            listed = json.loads(digtable("list", table, "--json"))
            rows = [
                PLAIN | {"magnitude": 0} | entry | {"trajectory": name, "packings": packings}
                for entry in listed["entries"] + listed["effects"]
                for name, packings in entry["packings"].items()
            ]
            theirs = pd.DataFrame(rows).query("packings > 0").drop(columns="entry", errors="ignore")
            self.same(digsight.open_table(table).entries(), theirs)

    def test_a_table_is_never_written(self) -> None:
        before = Path(RIG).read_bytes()
        table = digsight.open_table(RIG)
        table.curves()
        with self.assertRaisesRegex(sqlite3.OperationalError, "readonly"):
            table._db.execute("DELETE FROM run")
        self.assertEqual(before, Path(RIG).read_bytes())

    def test_what_is_no_sound_table_is_refused(self) -> None:
        def everything(path: str | Path) -> None:
            table = digsight.open_table(path)
            table.curves(**ANY)
            table.runs(**ANY)

        with self.assertRaises(FileNotFoundError):
            everything("tables/none.sqlite")
        with self.assertRaisesRegex(ValueError, "README.md: file is not a database"):
            everything("README.md")
        for sql, says in (
            ("PRAGMA application_id = 7", "not a table of digtable"),
            ("PRAGMA user_version = 3", "table format 3, expected 4"),
            ("CREATE VIEW more AS SELECT 1", "a view"),
            ("DROP TABLE seal; DROP TABLE entry", "no such table: entry"),
            ("UPDATE scene SET points = 1", "scene: expected"),
            ("UPDATE scene SET points = 1000000000", "mean: 4096 bytes, expected 16000000000"),
            ("UPDATE entry SET mean = substr(mean, 5)", "mean: 4092 bytes, expected 4096"),
            ("UPDATE entry SET spread = substr(spread, 2)", "spread: 4095 bytes, expected 4096"),
            ("UPDATE entry SET mean = CAST(x'0000c07f' || substr(mean, 5) AS BLOB)", "mean: expected finite"),
            ("UPDATE run SET windows = 1000000000", "expected 16000000000"),
            ("DELETE FROM run WHERE packing = 0", "run: 2 of an entry with 3 packings"),
            ("ALTER TABLE run ADD COLUMN more BLOB AS (zeroblob(900000000))", "a view, trigger, virtual table or column"),
            ("UPDATE trajectory SET name = char(27) || '[2J' || id", r"'\\x1b\[2J0', expected printable text"),
            ("UPDATE ground SET effect = char(8238)", r"'\\u202e', expected printable text"),
            ("UPDATE scene SET name = CAST(x'ff' AS TEXT)", "decode to UTF-8"),
            ("UPDATE run SET version = char(7)", r"'\\x07', expected printable text"),
            (f"{LAX} UPDATE entry SET mean = 'none'", "mean: a str, expected bytes"),
            (f"{LAX} UPDATE scene SET points = 'many'", "points: expected numbers"),
            (f"{LAX} UPDATE run SET first_s = 'soon'", "first_s: expected numbers"),
            (f"{LAX} UPDATE entry SET packings = 'two'", "packings: expected numbers"),
            (f"{LAX} UPDATE run SET windows = NULL WHERE id = 1", "windows: expected numbers"),
            ("CREATE VIRTUAL TABLE more USING rtree(id, a, b)", "a view, trigger, virtual table"),
            (f"CREATE VIRTUAL TABLE more USING rtree(id, a, b); {HIDDEN}", "a view, trigger, virtual table"),
        ):
            with self.assertRaisesRegex(ValueError, f"changed.sqlite: .*{says}"):
                everything(changed(self.folder, sql))

    def test_what_is_no_file_is_not_waited_for(self) -> None:
        pipe, table = Path(self.folder, "pipe"), changed(self.folder, "")
        os.mkfifo(pipe)
        for path in (pipe, self.folder, "/dev/zero"):
            for reader in (digsight.open_table, digsight.read_trace):
                with self.assertRaisesRegex(ValueError, "no regular file"):
                    reader(path)
        link = Path(self.folder, "link.sqlite")
        os.symlink(table, link)
        for beside in ("-journal", "-wal"):
            os.rename(pipe, f"{table}{beside}")
            for name in (table, link):
                with self.assertRaisesRegex(ValueError, f"changed.sqlite{beside}: no regular file"):
                    digsight.open_table(name)
            os.rename(f"{table}{beside}", pipe)
        digsight.open_table(table)
        digsight.open_table(link)

    def test_what_a_table_lacks_is_refused_with_what_it_has(self) -> None:
        rig = digsight.open_table(RIG)
        for where, says in (
            ({"friction": 0.6}, "friction 0.6: the table has 0.3, 0.5, 0.7, 0.9 there"),
            ({"trajectory": "simple"}, "'simple': the table has 'simpleA', 'simpleB', 'actual' there"),
            ({"friction": 0.5, "rolling": 0.5}, "9 curves fit, expected one: density_kgpm3, trajectory must be given"),
        ):
            with self.assertRaisesRegex(ValueError, says):
                rig.curve(**where)
        with self.assertRaisesRegex(TypeError, "density: no such key"):
            rig.curves(density=2500)
        with self.assertRaisesRegex(ValueError, "effect '': the table has 'adhesion'"):
            digsight.open_table(EFFECTS).curves()

    def test_a_trace_is_read_as_frames(self) -> None:
        trace = digsight.read_trace("tests/data/formats/trace.json")
        self.assertEqual(trace.verdict, ["cylinder_friction", "unlisted"])
        self.assertEqual(trace.effects["parameters.coulomb_N.high"][0], 861)
        self.assertEqual(list(trace.candidates["inclusion"]), [0.97, 0])
        self.assertEqual(trace.residuals["lifted.fz_N.after.rms"][0], 0.375)
        self.assertEqual(trace.residual_against["against"][5], "pass")
        rolling = dict(trace.material.loc["rolling"])
        self.assertEqual(rolling, {"value": 0.47, "low": 0.31, "high": 0.66, "before": 0.5})
        self.assertEqual(trace.whole["noise_floor"], 0.11)

    def test_what_is_no_trace_is_refused(self) -> None:
        path = Path(self.folder, "trace.json")
        for text, says in (
            ('{"verdict":\n}', "trace.json:2: "),
            ("[]", "a list, expected an object"),
            ('{"digs": 1}', "no key 'verdict'"),
            ('{"verdict": "none"}', "verdict: expected what"),
            ('{"verdict": [1]}', "verdict: expected what"),
            ('{"verdict": [], "effects": [[]]}', "effects: expected what"),
            ('{"verdict": [], "effects": [], "candidates": null}', "candidates: expected what"),
            ("[" * 100000, "nested too deep"),
            ('{"verdict": ["\\u001b[2J"]}', r"'\\x1b\[2J', expected printable text"),
            ('{"a": [{"\\u009b": 1}]}', r"'\\x9b', expected printable text"),
        ):
            path.write_text(text)
            with self.assertRaisesRegex(ValueError, says):
                digsight.read_trace(path)

    def test_every_block_of_the_page_runs(self) -> None:
        blocks = re.findall(r"^```python\n(.*?)^```$", Path("docs/python.md").read_text(), re.M | re.S)
        self.assertGreater(len(blocks), 5)
        for block in blocks:
            with self.subTest(block), redirect_stdout(io.StringIO()) as said:
                exec(compile(block, "docs/python.md", "exec"), {})
                self.assertNotEqual(said.getvalue(), "")

    def test_the_paper_is_reproduced(self) -> None:
        """docs/paper.md, c: the gravels that tests/paper chose for these digs, and the errors of their actual digs."""
        subprocess.run([sys.executable, "python/examples/paper.py", self.folder], check=True, capture_output=True)
        nearest = pd.read_csv(Path(self.folder, "table_v.csv"), index_col=0)
        for name, gravel, error in (("A", "0.5/0.7/2500", 0.134), ("B", "0.3/0.5/2500", 0.108)):
            self.assertEqual(nearest.loc[name, "nearest simple dig"], gravel)
            self.assertAlmostEqual(nearest.loc[name, "error of its actual dig"], error, delta=0.001)
        linked = re.findall(r'(?:src|href)="([^"]*)"', Path(self.folder, "paper.html").read_text())
        self.assertEqual([name[:9] for name in linked], ["figure_13", "figure_14", "figure_15"])
        self.assertTrue(all(Path(self.folder, name).exists() for name in linked))


if __name__ == "__main__":
    result = unittest.main(exit=False, verbosity=2).result
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed} passed, {failed} failed")
    sys.exit(failed > 0)
