#!/usr/bin/env python3
"""What `digloop trace` says of a machine whose pressures have noise that lasts, as a pump's pulses and valves that hunt.

    scripts/noise_study.py [CAMPAIGNS [SEED [KIND...]]]     (BIN=build/bin)

A campaign is what a ZX200 records of two beds of a gravel, along simpleA and actual each. To every pressure noise is added that
becomes e times less alike in .05 to .5 s, 1 to 5 % of the range that the pressure has in that dig, and at most a third of its
median. So many (12) are made of each KIND: plain; quiet, without noise; offset, the bucket's head side reads .5 MPa more; weight,
its bucket is 120 kg heavier than its file; slope, one bed whose surface rises by 8 degrees. Prints a line a campaign, then how
often what is there was named, alone or in a set, and nothing beside it, and how many intervals of the gravel miss. Two seconds a campaign.
"""
import json
import math
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile

MACHINE = "config/machines/zx200_trench.yaml"
SCENE = "config/scenes/rig.yaml"
REFERENCE = "tests/data/reference/"
MORE = "tests/data/liggghts_more/"
GRAVELS = {REFERENCE + "mu0.3_mur0.3_rho2500": ["", "_seed2", "_seed3", "_seed4"],
           REFERENCE + "mu0.5_mur0.5_rho2500": ["", "_seed2", "_seed3", "_seed4", "_seed5"],
           REFERENCE + "mu0.9_mur0.9_rho2500": ["", "_seed2", "_seed3", "_seed4"],
           MORE + "mu0.35_mur0.6_rho3500": ["_seed1", "_seed2"], MORE + "mu0.4_mur0.4_rho2000": ["_seed1", "_seed2"],
           MORE + "mu0.6_mur0.8_rho3000": ["_seed1", "_seed2"], MORE + "mu0.8_mur0.4_rho1700": ["_seed1", "_seed2"]}
SLOPED = {MORE + "slope_up": ["_seed1"]}
EXPECTED = {"plain": "none", "quiet": "none", "offset": "pressure_offset", "weight": "bucket_weight", "slope": "ground_slope"}
OFFSET_PA, HEAVIER_KG, STEP_PA = 5e5, 120, 2e5
AXES = ("friction", "rolling", "density_kgpm3")


def binary(name):
    return f"{os.environ.get('BIN', 'build/bin')}/{name}"


def record(dig, kind, seed, folder):
    """What the machine's sensors read: its head, its rows, and which of them are of the dig."""
    true, to, truth = folder / "true.yaml", folder / "recorded", folder / "truth"
    text = pathlib.Path(MACHINE).read_text()
    if kind == "weight":
        text = re.sub(r"(\nbucket:(?:\n  .*)*?\n  mass_kg: )(\d+)", lambda m: m[1] + str(int(m[2]) + HEAVIER_KG), text, count=1)
    true.write_text(text)
    subprocess.run([binary("digrig"), "record", dig, "--machine", true, "--scene", SCENE, "--seed", str(seed), "--truth", truth, "-q",
                    "-o", to], check=True)
    lines = to.read_text().splitlines()
    head = [line for line in lines if not line[0].isdigit()]
    soil = [abs(float(line.split(",")[6])) > 1e-3 for line in truth.read_text().splitlines()[1:]]
    return head, [line.split(",") for line in lines[len(head):]], soil


def spoil(head, rows, soil, share, memory_s, draw, offset_Pa):
    """Adds noise, and the offset of the bucket's head side, to the rows' pressures."""
    kept = math.exp(-(float(rows[1][0]) - float(rows[0][0])) / memory_s)
    for k, name in enumerate(head[-1].split(",")):
        if not name.endswith("_Pa"):
            continue
        dug = [float(row[k]) for row, is_soil in zip(rows, soil) if is_soil]
        # A pressure does not go below vacuum, where a push would not count.
        sigma_Pa = min(share * (max(dug) - min(dug)), statistics.median(float(row[k]) for row in rows) / 3)
        noise_Pa = sigma_Pa * draw.gauss(0, 1)
        for row in rows:
            noise_Pa = kept * noise_Pa + math.sqrt(1 - kept * kept) * sigma_Pa * draw.gauss(0, 1)
            read_Pa = float(row[k]) + noise_Pa + (offset_Pa if name == "bucket_head_Pa" else 0)
            row[k] = f"{STEP_PA * round(read_Pa / STEP_PA):.0f}"


def campaign(kind, gravel, beds, draw, folder):
    """Verdict (or why it was refused), and which numbers of the gravel miss their interval."""
    share = 0 if kind == "quiet" else math.exp(draw.uniform(math.log(.01), math.log(.05)))
    memory_s = math.exp(draw.uniform(math.log(.05), math.log(.5)))
    text = f"scene: {os.path.abspath(SCENE)}\nmachine: {os.path.abspath(MACHINE)}\nrecordings:\n"
    for i, bed in enumerate(draw.sample(beds, min(len(beds), 2))):
        for trajectory in ("simpleA", "actual"):
            head, rows, soil = record(f"{gravel}{bed}__{trajectory}.csv", kind, draw.randrange(1, 10 ** 6), folder)
            spoil(head, rows, soil, share, memory_s, draw, OFFSET_PA if kind == "offset" else 0)
            folder.joinpath(f"{trajectory}{i}.csv").write_text("\n".join(head + [",".join(row) for row in rows]) + "\n")
            role = "identify" if (i, trajectory) == (0, "simpleA") else "fit"
            text += f"  - {{file: {trajectory}{i}.csv, trajectory: {trajectory}, role: {role}}}\n"
    folder.joinpath("campaign.yaml").write_text(text)
    run = subprocess.run([binary("digloop"), "trace", "tables/reference_rig.sqlite", folder, "-q", "--json", folder / "trace.json"],
                         capture_output=True, text=True, check=False)
    if run.returncode != 0:
        return share, memory_s, ["refused: " + run.stderr.splitlines()[-1]], []
    found = json.loads((folder / "trace.json").read_text())
    verdict = found["verdict"]
    for alike in found["indistinguishable"]:
        verdict = ["/".join(alike) if name in alike else name for name in verdict]
    truth = [.5, .5, 2500] if "slope" in gravel else [float(part.lstrip("murho")) for part in gravel.split("/")[-1].split("_")]
    of = [found["material"][axis] for axis in AXES]
    return share, memory_s, verdict, [not m["low"] <= value <= m["high"] for m, value in zip(of, truth)]


def main():
    given = sys.argv[1:]
    campaigns, seed = int(given[0]) if given else 12, int(given[1]) if given[1:] else 1
    for kind in given[2:] or EXPECTED:
        draw = random.Random(f"{kind} {seed}")
        right, missed = 0, [0, 0, 0]
        for _ in range(campaigns):
            gravel, beds = draw.choice(list((SLOPED if kind == "slope" else GRAVELS).items()))
            with tempfile.TemporaryDirectory() as name:
                share, memory_s, verdict, misses = campaign(kind, gravel, beds, draw, pathlib.Path(name))
            right += len(verdict) == 1 and EXPECTED[kind] in verdict[0].split("/")
            missed = [n + m for n, m in zip(missed, misses or [0, 0, 0])]
            marks = "".join("x" if miss else "." for miss in misses)
            print(f"{kind:9} {gravel.split('/')[-1]:24} {100 * share:.1f} % {memory_s:.2f} s  {marks:3} {' '.join(verdict)}", flush=True)
        print(f"{kind}: {EXPECTED[kind]} {right} of {campaigns}; intervals that miss: {', '.join(map(str, missed))}", flush=True)


if __name__ == "__main__":
    main()
