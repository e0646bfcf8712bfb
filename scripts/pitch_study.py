#!/usr/bin/env python3
"""What `digloop trace` says of a machine that stands on pitched ground, digs along it, and does not record its pitch.

    scripts/pitch_study.py [CAMPAIGNS [SEED]]     (BIN=build/bin)

A campaign is what a ZX200 records of two beds of a gravel, along simpleA and actual each, all at one pitch. digrig knows none: it
is given the path and forces turned by the pitch, and a machine whose boom and boom cylinder stand turned; the pitch is taken off the
boom's angle. So many (8) are made of each pitch, of 0 to 5 degrees, nose up and down in turn. Prints a line a campaign, then how
often it was `none`, had a name or was `unlisted`, how far what was said of the pitch is off, and how many intervals of the gravel
miss. Three seconds a campaign.
"""
import json
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

from noise_study import AXES, GRAVELS, MACHINE, SCENE, binary

DEGREES = (0.0, 0.5, 1.0, 2.0, 3.0, 5.0)


def turned_machine(rad, to):
    """Its boom and what moves that stand turned by the pitch."""
    text = pathlib.Path(MACHINE).read_text()
    for limit in ("min_deg", "max_deg"):
        text = re.sub(rf"(\nboom:(?:\n  .*)*?\n  {limit}: )(\S+)", lambda m: m[1] + str(float(m[2]) + math.degrees(rad)), text, count=1)
    x, z = map(float, re.search(r"\n  boom:(?:\n    .*)*?\n    base_m: \[(.*), (.*)\]", text).groups())
    base = f"[{math.cos(rad) * x - math.sin(rad) * z:.9f}, {math.sin(rad) * x + math.cos(rad) * z:.9f}]"
    text = re.sub(r"(\n  boom:(?:\n    .*)*?\n    base_m: )\[.*\]", lambda m: m[1] + base, text, count=1)
    to.write_text(text)


def turned_dig(dig, rad, to):
    """The rig's x runs against the machine's X: nose up turns it the other way."""
    lines = dig.read_text().splitlines()
    head = [line for line in lines if not line[0].isdigit()]
    names = head[-1].split(",")
    c, s, rows = math.cos(rad), math.sin(rad), []
    for line in lines[len(head):]:
        at = dict(zip(names, map(float, line.split(","))))
        for x, z in (("pin_x_m", "pin_z_m"), ("Fx_N", "Fz_N")):
            at[x], at[z] = c * at[x] + s * at[z], c * at[z] - s * at[x]
        at["theta_deg"] -= math.degrees(rad)
        rows.append(",".join(f"{at[name]:.9g}" for name in names))
    to.write_text("\n".join(head + rows) + "\n")


def record(dig, rad, seed, folder, to):
    true, turned, whole = folder / "true.yaml", folder / "turned", folder / "whole"
    turned_machine(rad, true)
    turned_dig(dig, rad, turned)
    subprocess.run([binary("digrig"), "record", turned, "--machine", true, "--scene", SCENE, "--seed", str(seed), "-q", "-o", whole],
                    check=True)
    lines = whole.read_text().splitlines()
    head = [line for line in lines if not line[0].isdigit()]
    names = head[-1].split(",")
    boom, pitch = names.index("boom_rad"), names.index("pitch_rad")
    for k in range(len(head), len(lines)):
        row = lines[k].split(",")
        row[boom], row[pitch] = f"{float(row[boom]) - rad:.7f}", ""
        lines[k] = ",".join(row)
    to.write_text("\n".join(lines) + "\n")


def trace(gravel, beds, rad, seed):
    with tempfile.TemporaryDirectory() as name:
        folder, recordings = pathlib.Path(name), ""
        for i, (bed, kind) in enumerate((bed, kind) for bed in beds for kind in ("simpleA", "actual")):
            record(pathlib.Path(f"{gravel}{bed}__{kind}.csv"), rad, seed + i, folder, folder / f"{i}.csv")
            role = "identify" if kind == "simpleA" else "fit"
            recordings += f"  - {{file: {i}.csv, trajectory: {kind}, role: {role}}}\n"
        (folder / "campaign.yaml").write_text(f"scene: {os.path.abspath(SCENE)}\nmachine: {os.path.abspath(MACHINE)}\nrecordings:\n{recordings}")
        subprocess.run([binary("digloop"), "trace", "tables/reference_rig.sqlite", folder, "-q", "--json", folder / "trace.json"],
                        stdout=subprocess.DEVNULL, check=True)
        return json.loads((folder / "trace.json").read_text())


def misses(found, gravel):
    truth = re.search(r"mu([\d.]+)_mur([\d.]+)_rho([\d.]+)", gravel).groups()
    of = [found["material"][axis] for axis in AXES]
    return sum(not m["low"] <= float(value) <= m["high"] for m, value in zip(of, truth))


def study(degrees, campaigns, seed):
    draw = random.Random(f"{degrees} {seed}")
    said, off, missed = [], [0.0], 0
    for i in range(campaigns):
        gravel = draw.choice(list(GRAVELS))
        pitch = degrees * (-1) ** i
        found = trace(gravel, draw.sample(GRAVELS[gravel], 2), math.radians(pitch), 1000 * seed + 10 * i)
        told = re.search(r"pitched by (\S+) degrees", found["advice"])
        said.append(" ".join(found["verdict"]))
        missed += misses(found, gravel)
        if told:
            off.append(abs(float(told[1]) - pitch))
        print(f"{pitch:5.1f}  {pathlib.Path(gravel).name:24} {said[-1]:16} {told[0] if told else ''}", flush=True)
    none, unlisted = said.count("none"), said.count("unlisted")
    print(f"{degrees:g} degrees: none {none}, unlisted {unlisted}, named {len(said) - none - unlisted} of {len(said)}; "
          f"pitch told in {len(off) - 1}, off by {max(off):.1f} at most; intervals that miss: {missed} of {3 * len(said)}", flush=True)


def main():
    given = [int(word) for word in sys.argv[1:]]
    for degrees in DEGREES:
        study(degrees, given[0] if given else 8, given[1] if given[1:] else 1)


if __name__ == "__main__":
    main()
