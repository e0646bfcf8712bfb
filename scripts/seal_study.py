#!/usr/bin/env python3
"""Whether a machine whose seals rub still tells its gravel, with a file that says nothing of them.

    scripts/seal_study.py TABLE.sqlite RUNS.sqlite...     (BIN=build/bin, MACHINE=config/machines/zx200_trench.yaml, SEEDS=1)

Every plain simpleA dig in RUNS becomes one of the machine's sensors. The seals of all drives rub with a share of the drive's
largest push against the rod's motion, and hold a rod that stands. `digloop identify` tells the gravel by TABLE, `digloop check`
judges the file by a minute of free air of the same machine. One line a share. Some half a second a dig.
"""
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile

from coverage_study import AXES, beds_of
from depth_study import ALONG, SCENE, write

SHARES = (0, .002, .005, .01, .02)
DRIVES = {"boom": 1, "arm": -1, "bucket": -1}  # whether the rod comes out as the angle grows
BENT_rad = .0005  # by so much of the joint's last way a seal can bend
STEADY = 10  # samples before and after one that its angle is averaged over


def reliefs_of(machine):
    """Pa at which each drive's valve opens."""
    with open(machine, encoding="utf-8") as file:
        text = file.read().split("\ncylinders:")[1]
    return {drive: float(re.search(rf"\n  {drive}:.*?relief_Pa: *(\S+)", text, re.S).group(1)) for drive in DRIVES}


def bent(angles):
    """What a seal pushes back, from -1 to 1, sample by sample."""
    at, last, told = 0.0, angles[0], []
    for i in range(len(angles)):
        near = angles[max(i - STEADY, 0):i + STEADY + 1]
        now = sum(near) / len(near)
        at = min(max(at + (now - last) / BENT_rad, -1.0), 1.0)
        last = now
        told.append(at)
    return told


def rub(path, exact, reliefs, share, to):
    """The recording as a machine with such seals makes it. exact: the same without noise or steps."""
    with open(path, encoding="ascii") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    with open(exact, encoding="ascii") as file:
        true = list(csv.DictReader(line for line in file if not line.startswith("#")))
    for drive, sign in DRIVES.items():
        for row, held in zip(rows, bent([sign * float(row[f"{drive}_rad"]) for row in true])):
            row[f"{drive}_head_Pa"] = f'{float(row[f"{drive}_head_Pa"]) + share * reliefs[drive] * held:.1f}'
    with open(to, "w", encoding="ascii") as file:
        table = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def run(*command):
    return subprocess.run(command, check=False, capture_output=True, text=True)


def position(axis, value):
    return math.log(value) / math.log(2) if axis == "density_kgpm3" else value


def study(binaries, table, machine, digs, seeds, work):
    rig = [f"{binaries}/digrig", "record", f"{work}/dig.csv", "--machine", machine, "--scene", SCENE, "-q", "-o"]
    reliefs = reliefs_of(machine)
    told = {share: [] for share in SHARES}
    for truth, (name, start, phases, *curve) in digs:
        write(f"{work}/dig.csv", start, phases, 1.0, *curve)
        run(*rig, f"{work}/exact.csv", "--exact").check_returncode()
        for seed in range(1, seeds + 1):
            run(*rig, f"{work}/plain.csv", "--seed", str(seed)).check_returncode()
            for share in SHARES:
                rub(f"{work}/plain.csv", f"{work}/exact.csv", reliefs, share, f"{work}/machine.csv")
                one = run(f"{binaries}/digloop", "identify", table, f"{work}/machine.csv", "--machine", machine, "--trajectory", name, "--json")
                told[share].append((truth, json.loads(one.stdout) if one.returncode == 0 else None))
    return told


def verdict(binaries, machine, share, work):
    """What `digloop check` says of the file."""
    reliefs = reliefs_of(machine)
    rig = [f"{binaries}/digrig", "air", "--machine", machine, "-q", "-o"]
    run(*rig, f"{work}/exact.csv", "--exact").check_returncode()
    run(*rig, f"{work}/plain.csv").check_returncode()
    rub(f"{work}/plain.csv", f"{work}/exact.csv", reliefs, share, f"{work}/air.csv")
    return "fits" if run(f"{binaries}/digloop", "check", machine, f"{work}/air.csv").returncode == 0 else "does not fit"


def main():
    if len(sys.argv) < 3 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    binaries = os.environ.get("BIN", "build/bin")
    machine = os.environ.get("MACHINE", "config/machines/zx200_trench.yaml")
    digs = [(truth, dig) for runs in sys.argv[2:] for truth, along in beds_of(runs) for dig in along if dig[0] == ALONG]
    print("seals rub, %  digs  refused  outside  depth: mean  deviation   in the 90 % interval: friction  rolling  density"
          "   mean width: friction  rolling  octaves of density  digloop check")
    with tempfile.TemporaryDirectory() as work:
        told = study(binaries, sys.argv[1], machine, digs, int(os.environ.get("SEEDS", "1")), work)
        for share, of in told.items():
            seen = [(truth, one) for truth, one in of if one is not None]
            depths = [one["depth"] for _, one in seen if "depth" in one]
            mean = sum(depths) / max(len(depths), 1)
            spread = math.sqrt(sum((d - mean) ** 2 for d in depths) / max(len(depths) - 1, 1))
            held = [sum(one["low"][a] <= truth[i] * (1 + 1e-9) and truth[i] <= one["high"][a] * (1 + 1e-9) for truth, one in seen)
                    for i, a in enumerate(AXES)]
            wide = [sum(position(a, one["high"][a]) - position(a, one["low"][a]) for _, one in seen) / max(len(seen), 1) for a in AXES]
            print(f"{100 * share:12.1f} {len(of):5d} {len(of) - len(seen):8d} {sum(one['outside'] for _, one in seen):8d} {mean:12.3f} {spread:10.3f} "
                  f"{held[0]:33d} {held[1]:8d} {held[2]:8d} {wide[0]:22.3f} {wide[1]:8.3f} {wide[2]:19.3f}  {verdict(binaries, machine, share, work)}")


if __name__ == "__main__":
    main()
