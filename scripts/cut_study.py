#!/usr/bin/env python3
"""Plain gravel of LIGGGHTS whose recordings end early or begin late: what `digloop trace` says of it.

    scripts/cut_study.py [CAMPAIGNS [LEAST]]           (BIN=build/bin)
    scripts/cut_study.py machine [CAMPAIGNS [SEED]]    what a ZX200 records, see KINDS

A campaign has one bed of tests/data/reference along simpleA and actual, each cut at a share of its time drawn from LEAST
(.8) to 1. Prints a line a campaign, then how many (40) are `none`, have a name or are `unlisted`, and are refused. A
minute of one core. Of a machine there are so many (16) of each kind, and how many intervals of friction, rolling friction
and density miss; five minutes.
"""
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

DIGS = pathlib.Path("tests/data/reference")
MACHINE = "config/machines/zx200_trench.yaml"
SCENE = "config/scenes/rig.yaml"
BEDS = ["mu0.3_mur0.3_rho2500", "mu0.3_mur0.9_rho2500", "mu0.5_mur0.5_rho2500", "mu0.5_mur0.9_rho2500", "mu0.9_mur0.3_rho2500",
        "mu0.9_mur0.9_rho2500", "mu0.5_mur0.5_rho4000", "mu0.3_mur0.3_rho2500_seed2", "mu0.9_mur0.9_rho2500_seed3",
        "mu0.5_mur0.5_rho2500_seed4"]
AXES = ("friction", "rolling", "density_kgpm3")
LAMBDA = 10.0

# From where to where of a dig a machine's recording goes, in shares of it; before 0 and behind 1 is air, behind 1 the bucket is
# full at first.
KINDS = {
    "whole": lambda draw: (-9.0, 9.0),
    "no air after": lambda draw: (-9.0, draw(1.0, 1.03)),
    "ends while lifting": lambda draw: (-9.0, draw(.8, 1.0)),
    "little air before": lambda draw: (draw(-.15, 0.0), 9.0),
    "begins in the soil": lambda draw: (draw(0.0, .1), 9.0),
    "both": lambda draw: (draw(-.15, .1), draw(.8, 1.0)),
}


def binary(name):
    return f"{os.environ.get('BIN', 'build/bin')}/{name}"


def cut(dig, first_s, end_s, to):
    rows = dig.read_text().splitlines()
    head = [row for row in rows if not row[0].isdigit()]
    to.write_text("\n".join(head + [row for row in rows if row[0].isdigit() and first_s <= float(row.split(",")[0]) <= end_s]) + "\n")


def last_s(dig):
    return float(dig.read_text().splitlines()[-1].split(",")[0])


def record(bed, trajectory, seed, folder):
    """The machine's recording, when its dig begins in it and how long it takes."""
    dig, to, truth = DIGS / f"{bed}__{trajectory}.csv", folder / "whole.csv", folder / "truth"
    subprocess.run([binary("digrig"), "record", dig, "--machine", MACHINE, "--scene", SCENE, "--seed", str(seed), "--truth", truth, "-q",
                    "-o", to], check=True)
    loaded = next(row for row in truth.read_text().splitlines()[1:] if abs(float(row.split(",")[6])) > 1e-3)
    return to, float(loaded.split(",")[0]), last_s(dig) * LAMBDA ** .5


def trace(folder, machine=""):
    """What was found of the campaign's files, or why it was refused."""
    folder.joinpath("campaign.yaml").write_text(
        f"scene: {os.path.abspath(SCENE)}\n" + machine +
        "recordings:\n  - {file: simpleA.csv, trajectory: simpleA, role: identify}\n  - {file: actual.csv, trajectory: actual, role: fit}\n")
    run = subprocess.run([binary("digloop"), "trace", "tables/reference_rig.sqlite", folder, "-q", "--json", folder / "trace.json"],
                         capture_output=True, text=True, check=False)
    if run.returncode != 0:
        return None, "refused: " + run.stderr.splitlines()[-1]
    found = json.loads((folder / "trace.json").read_text())
    return found, " ".join(found["verdict"])


def cut_forces(bed, shares, folder):
    for trajectory, share in shares.items():
        dig = DIGS / f"{bed}__{trajectory}.csv"
        cut(dig, 0.0, share * last_s(dig), folder / f"{trajectory}.csv")
    return trace(folder)[1]


def count(said):
    none, refused = said.count("none"), sum(s.startswith("refused") for s in said)
    return f"none {none}, named or unlisted {len(said) - none - refused}, refused {refused} of {len(said)}"


def forces(campaigns, least):
    random.seed(1)
    said = []
    for _ in range(campaigns):
        bed = random.choice(BEDS)
        shares = {"simpleA": random.uniform(least, 1), "actual": random.uniform(least, 1)}
        with tempfile.TemporaryDirectory() as folder:
            said.append(cut_forces(bed, shares, pathlib.Path(folder)))
        print(f"{bed:28} {shares['simpleA']:.2f} {shares['actual']:.2f}  {said[-1]}", flush=True)
    print(count(said))


def misses(found, bed):
    """Of the gravel's numbers, which lie outside their interval."""
    truth = [float(part.lstrip("murho")) for part in bed.split("_")[:3]]
    of = [found["material"][axis] for axis in AXES]
    return [not m["low"] <= value <= m["high"] for m, value in zip(of, truth)]


def machines(campaigns, seed):
    for kind, span in KINDS.items():
        draw = random.Random(f"{kind} {seed}")
        said, missed = [], [0, 0, 0]
        for i in range(campaigns):
            bed = draw.choice(BEDS)
            parts = []
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                for trajectory in ("simpleA", "actual"):
                    whole, begins_s, lasts_s = record(bed, trajectory, 100 * seed + i, folder)
                    part = span(draw.uniform)
                    cut(whole, begins_s + part[0] * lasts_s, begins_s + part[1] * lasts_s, folder / f"{trajectory}.csv")
                    parts.append(f"{part[0]:.2f}..{part[1]:.2f}")
                found, verdict = trace(folder, f"machine: {os.path.abspath(MACHINE)}\n")
            said.append(verdict)
            missed = [n + m for n, m in zip(missed, misses(found, bed) if found else [0, 0, 0])]
            print(f"{kind:20} {bed:28} {' '.join(parts):26} {verdict}", flush=True)
        print(f"{kind}: {count(said)}; intervals that miss: {', '.join(map(str, missed))}", flush=True)


def main():
    given = sys.argv[1:]
    if given[:1] == ["machine"]:
        machines(int(given[1]) if given[1:] else 16, int(given[2]) if given[2:] else 1)
    else:
        forces(int(given[0]) if given else 40, float(given[1]) if given[1:] else .8)


if __name__ == "__main__":
    main()
