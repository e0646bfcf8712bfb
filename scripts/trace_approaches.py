#!/usr/bin/env python3
"""What `digloop trace` makes of plain gravel that was dug otherwise than its table: shallower, deeper, with the bucket turned.

    scripts/trace_approaches.py TABLE.sqlite [RUNS.sqlite [KIND...]]     (BIN=build/bin)

Of every gravel that RUNS.sqlite (TABLE.sqlite itself by default) holds at several depths a campaign is made of each KIND that it was dug so:
plain, shallower, deeper, mixed, opened, closed, air. One dig along each trajectory at that depth, or with the bucket turned so (opened: the
least attack, closed: the most; air: plain, the recording begins a third of the first leg above the ground), a plain simple dig, and a plain
real dig held out. It is traced as force recordings and as what a ZX200 records. One line a campaign: verdict, what is told of the gravel and
whether the interval holds it (+ and - where the truth lies below and above it), the held-out error, and the depths and attacks that were
taken off. The last lines count. Some two seconds a campaign.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

from coverage_study import AXES, digs_of, run, where
from depth_study import MACHINE, SCENE, write

KINDS = ("plain", "shallower", "deeper", "mixed", "opened", "closed", "air")
AIR_S = 0.2
TOOTH_M = 0.09
PLAIN = "1.00 0.0"


def turned(start, attack_rad):
    """The start of a dig with the bucket turned about its tooth (core/approach.h)."""
    theta_rad, x_m, z_m = start
    turned_rad = theta_rad + attack_rad
    return (turned_rad, x_m + TOOTH_M * (math.sin(theta_rad) - math.sin(turned_rad)),
            z_m - TOOTH_M * (math.cos(theta_rad) - math.cos(turned_rad)))


def gravels_of(path):
    """{gravel: {(trajectory, depth, attack in degrees): [bed]}} of those at several depths; a bed: what write() takes behind the path."""
    gravels = {}
    for (*gravel, _), (depth, attack_rad), (name, start, phases, *curve) in digs_of(path, "1"):
        bed = (turned(start, attack_rad), phases, depth, *curve)
        gravels.setdefault(tuple(gravel), {}).setdefault((name, depth, round(math.degrees(attack_rad), 3)), []).append(bed)
    return {gravel: beds for gravel, beds in gravels.items() if len({depth for _, depth, _ in beds}) > 1}


def campaign_of(beds, kind):
    """[(trajectory, bed, role)]; empty where the gravel was not dug so."""
    depths = sorted({depth for _, depth, _ in beds})
    attacks = sorted({attack for *_, attack in beds})
    at = {"plain": [(1.0, 0.0)], "air": [(1.0, 0.0)], "shallower": [(depths[0], 0.0)], "deeper": [(depths[-1], 0.0)],
          "mixed": [(depths[0], 0.0), (depths[-1], 0.0)], "opened": [(1.0, attacks[0])], "closed": [(1.0, attacks[-1])]}[kind]
    if kind in ("opened", "closed") and at == [(1.0, 0.0)]:
        return []
    digs = []
    for i, name in enumerate(sorted({name for name, *_ in beds}, reverse=True)):
        digs.append((name, beds[name, *at[i % len(at)]][0], "identify" if name == "simpleA" else "fit"))
    digs.append(("simpleA", beds["simpleA", 1.0, 0.0][-1], "fit"))
    digs.append(("actual", beds["actual", 1.0, 0.0][-1], "holdout"))
    return digs


def trace(binaries, table, digs, machine, air_s):
    with tempfile.TemporaryDirectory() as work:
        with open(os.path.join(work, "campaign.yaml"), "w", encoding="ascii") as to:
            to.write(f"scene: {os.path.abspath(SCENE)}\n")
            if machine:
                to.write(f"machine: {os.path.abspath(MACHINE)}\n")
            to.write("recordings:\n")
            for i, (name, bed, role) in enumerate(digs):
                dug, told = os.path.join(work, f"dug{i}.csv"), os.path.join(work, f"{i}.csv")
                write(told if not machine else dug, *bed, air_s=air_s)
                if machine:
                    run(f"{binaries}/digrig", "record", dug, "--machine", MACHINE, "--scene", SCENE, "--seed", str(i + 1), "-o", told, "-q")
                to.write(f"  - {{file: {i}.csv, trajectory: {name}, role: {role}}}\n")
        answer = os.path.join(work, "trace.json")
        subprocess.run([f"{binaries}/digloop", "trace", table, work, "--json", answer, "-q"], check=True)
        with open(answer, encoding="utf-8") as read:
            return json.load(read)


def way_of(dig):
    return f"{dig['depth']:.2f} {dig['attack_deg'] + 0.0:.1f}".replace("-0.0", "0.0")


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    table, runs = sys.argv[1], (sys.argv[2:3] or sys.argv[1:2])[0]
    binaries = os.environ.get("BIN", "build/bin")
    campaigns, named, held = [0, 0], [0, 0], [[0] * 3, [0] * 3]
    for gravel, beds in gravels_of(runs).items():
        for kind in sys.argv[3:] or KINDS:
            digs = campaign_of(beds, kind)
            for machine in () if not digs else (False,) if kind == "air" else (False, True):
                told = trace(binaries, table, digs, machine, AIR_S if kind == "air" else 0.0)
                material, text = told["material"], []
                for i, axis in enumerate(AXES):
                    mark = where(gravel[i], material[axis]["low"], material[axis]["high"])
                    held[machine][i] += mark == " "
                    text.append(f"{material[axis]['value']:.{0 if i == 2 else 2}f}{mark}")
                campaigns[machine] += 1
                named[machine] += told["verdict"] != ["none"]
                print(f"{gravel[0]:.2f}/{gravel[1]:.2f}/{gravel[2]:.0f}  {kind:10s} {'machine' if machine else 'force':8s} "
                      f"{','.join(told['verdict']):10s} {'/'.join(text):20s} {told['error_after']['holdout']:.3f}  "
                      f"{', '.join(way_of(dig) for dig in told['residuals'] if way_of(dig) != PLAIN)}", flush=True)
    for which, kind in enumerate(("force recordings", "a machine's")):
        print(f"{kind}: {campaigns[which]} campaigns, named {named[which]}; intervals hold: friction {held[which][0]}, "
              f"rolling friction {held[which][1]}, density {held[which][2]}")


if __name__ == "__main__":
    main()
