#!/usr/bin/env python3
"""How often the 90 % intervals of a gravel hold, and how well its real digs are predicted, on gravels all over a table's grid.

    scripts/coverage_study.py TABLE.sqlite RUNS.sqlite...     (BIN=build/bin)

Every bed of plain gravel in RUNS is identified by its simpleA dig (`digloop identify`), which predicts its actual dig (`digloop
predict`), and is traced by all its digs (`digloop trace`). One line a bed: truth, then what is told and whether the interval holds it
(+ and - where the truth lies below and above it). The last lines count. Some two seconds a bed.
"""
import json
import math
import os
import sqlite3
import subprocess
import sys
import tempfile

from depth_study import write

AXES = ("friction", "rolling", "density_kgpm3")


def paths_of(db):
    along = {}
    for number, name, *start in db.execute("SELECT id, name, theta0_rad, start_x_m, start_z_m FROM trajectory"):
        phases = db.execute("SELECT duration_s, vx_mps, vz_mps, omega_radps FROM phase WHERE trajectory = ? ORDER BY number",
                            (number,)).fetchall()
        along[number] = (name, start, phases)
    return along


def digs_of(path, where):
    """((friction, rolling, density, packing), (depth, attack_rad), (trajectory, start, phases, first_s, step_s, windows, curve)) of plain runs, by
    ground, depth, attack, packing and trajectory."""
    db = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
    along = paths_of(db)
    for friction, rolling, density, packing, depth, attack_rad, trajectory, *curve in db.execute(
            "SELECT friction, rolling, density_kgpm3, packing, depth, attack_rad, trajectory, first_s, step_s, windows, curve FROM run "
            f"JOIN ground g ON g.id = ground WHERE effect = '' AND {where} ORDER BY ground, depth, attack_rad, packing, trajectory"):
        yield (friction, rolling, density, packing), (depth, attack_rad), (*along[trajectory], *curve)


def beds_of(path):
    """Truth and digs of every bed at depth 1."""
    beds = {}
    for truth, _, dig in digs_of(path, "depth = 1 AND attack_rad = 0"):
        beds.setdefault(truth, []).append(dig)
    return beds.items()


def run(*command):
    told = subprocess.run(command, check=False, capture_output=True, text=True)
    if told.returncode != 0:
        sys.exit(told.stderr)
    return told.stdout


def where(truth, low, high):
    return "+" if truth < low * (1 - 1e-9) else "-" if truth > high * (1 + 1e-9) else " "


def study(binaries, table, scene, truth, digs, work):
    names = []
    for name, start, phases, first_s, step_s, windows, curve in digs:
        write(os.path.join(work, f"{name}.csv"), start, phases, 1.0, first_s, step_s, windows, curve)
        names.append(name)
    simple, identity = os.path.join(work, "simpleA.csv"), os.path.join(work, "identity.json")
    found = run(f"{binaries}/digloop", "identify", table, simple, "--json")
    with open(identity, "w", encoding="ascii") as to:
        to.write(found)
    found = json.loads(found)
    told = json.loads(run(f"{binaries}/digloop", "predict", table, "--identified", identity, "--trajectory", "actual", "--measured",
                          os.path.join(work, "actual.csv"), "--json"))
    with open(os.path.join(work, "campaign.yaml"), "w", encoding="ascii") as to:
        to.write(f"scene: {scene}\nrecordings:\n")
        for name in names:
            role = "identify" if name == "simpleA" else "fit"
            to.write(f"  - {{file: {name}.csv, trajectory: {name}, role: {role}}}\n")
    trace = os.path.join(work, "trace.json")
    run(f"{binaries}/digloop", "trace", table, work, "--json", trace, "-q")
    with open(trace, encoding="utf-8") as read:
        traced = json.load(read)
    single = [(found["mean"][a], found["low"][a], found["high"][a]) for a in AXES]
    material = traced["material"]
    joint = [(material[a]["value"], material[a]["low"], material[a]["high"]) for a in AXES]
    return single, joint, traced["verdict"], found["outside"], told


def main():
    if len(sys.argv) < 3 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    table = sys.argv[1]
    binaries = os.environ.get("BIN", "build/bin")
    scene = json.loads(run(f"{binaries}/digtable", "list", table, "--json"))["scene"]["name"]
    held, off2, beds, named, errors, floors = [[0] * 3, [0] * 3], [[0.0] * 3, [0.0] * 3], 0, 0, [], []
    print("truth            from simpleA alone           from all digs                verdict     error  floor")
    for path in sys.argv[2:]:
        for truth, digs in beds_of(path):
            with tempfile.TemporaryDirectory() as work:
                single, joint, verdict, outside, told = study(binaries, table, scene, truth, digs, work)
            text = []
            for which, answer in enumerate((single, joint)):
                marks = [where(truth[i], low, high) for i, (_, low, high) in enumerate(answer)]
                for i, mark in enumerate(marks):
                    held[which][i] += mark == " "
                    off2[which][i] += (answer[i][0] - truth[i]) ** 2
                text.append(f"{answer[0][0]:.2f}{marks[0]}/{answer[1][0]:.2f}{marks[1]}/{answer[2][0]:.0f}{marks[2]}")
            beds += 1
            named += verdict != ["none"]
            errors.append(told["error"])
            floors.append(told["noise_floor"])
            print(f"{truth[0]:.2f}/{truth[1]:.2f}/{truth[2]:.0f}   {text[0]:28s} {text[1]:28s} {','.join(verdict):10s} "
                  f"{told['error']:6.3f} {told['noise_floor']:6.3f}{'  outside' if outside else ''}", flush=True)
    for which, answer in enumerate(("from simpleA alone", "from all digs")):
        off = [math.sqrt(square / beds) for square in off2[which]]
        print(f"{answer}: friction {held[which][0]}, rolling {held[which][1]}, density {held[which][2]} of {beds}; "
              f"off by {off[0]:.3f}, {off[1]:.3f}, {off[2]:.0f} kg/m3 (rms)")
    print(f"named: {named}; error of actual: mean {sum(errors) / beds:.3f}, noise floor {sum(floors) / beds:.3f}")


if __name__ == "__main__":
    main()
