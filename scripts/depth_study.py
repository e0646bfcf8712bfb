#!/usr/bin/env python3
"""How deep a machine takes digs to be that a table holds, and whether it then tells their gravel.

    scripts/depth_study.py TABLE.sqlite [RUNS.sqlite]     (BIN=build/bin)

Every plain or deeper run along simpleA in RUNS.sqlite (TABLE.sqlite itself by default) becomes a force recording, then one of
the sensors of a ZX200, and is identified by TABLE.sqlite. One line a true depth. Some 0.4 s a dig.
"""
import json
import math
import os
import sqlite3
import struct
import subprocess
import sys
import tempfile

ALONG = "simpleA"
MACHINE = "config/machines/zx200_trench.yaml"
SCENE = "config/scenes/product.yaml"
CHANNELS = 4  # My, Fx, Fz, carried mass, one after the other


def pose(start, phases, time_s, depth):
    """Of the pin: the first phase goes down as far as the depth says; here it begins at the ground."""
    theta_rad, x_m, z_m = start
    for number, (duration_s, vx_mps, vz_mps, omega_radps) in enumerate(phases):
        spent_s = min(time_s, duration_s)
        factor = depth if number == 0 else 1.0
        x_m += vx_mps * factor * spent_s
        z_m += vz_mps * factor * spent_s
        theta_rad += omega_radps * spent_s
        time_s -= spent_s
    return x_m, z_m, math.degrees(theta_rad)


def write(path, start, phases, depth, first_s, step_s, windows, curve, air_s=0.0):
    """A force recording; it begins air_s above the ground, on the line of the first phase."""
    value = struct.unpack(f"<{CHANNELS * windows}f", curve)
    with open(path, "w", encoding="ascii") as to:
        to.write("t_s,pin_x_m,pin_z_m,theta_deg,Fx_N,Fy_N,Fz_N,Mx_Nm,My_Nm,Mz_Nm\n")
        for i in range(-round(air_s / step_s), windows):
            time_s = first_s + i * step_s
            my_nm, fx_n, fz_n = (value[c * windows + i] if i >= 0 else 0.0 for c in range(3))
            x_m, z_m, theta_deg = pose(start, phases, time_s, depth)
            to.write(f"{time_s + air_s:.6f},{x_m:.6f},{z_m:.6f},{theta_deg:.4f},{fx_n:.9g},0,{fz_n:.9g},0,{my_nm:.9g},0\n")


def identify(binaries, table, recording, work):
    machine = os.path.join(work, "machine.csv")
    subprocess.run([f"{binaries}/digrig", "record", recording, "--machine", MACHINE, "--scene", SCENE, "-o", machine, "-q"], check=True)
    told = subprocess.run([f"{binaries}/digloop", "identify", table, machine, "--machine", MACHINE, "--trajectory", ALONG, "--json"],
                          check=False, capture_output=True, text=True)
    return json.loads(told.stdout) if told.returncode == 0 else None


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    table, runs = sys.argv[1], sys.argv[-1]
    binaries = os.environ.get("BIN", "build/bin")
    db = sqlite3.connect(f"file:{runs}?mode=ro", uri=True)
    along, *start = db.execute("SELECT id, theta0_rad, start_x_m, start_z_m FROM trajectory WHERE name = ?", (ALONG,)).fetchone()
    phases = db.execute("SELECT duration_s, vx_mps, vz_mps, omega_radps FROM phase WHERE trajectory = ? ORDER BY number", (along,)).fetchall()
    digs = db.execute("SELECT depth, friction, rolling, density_kgpm3, first_s, step_s, windows, curve FROM run JOIN ground g "
                      "ON g.id = ground WHERE trajectory = ? AND attack_rad = 0 AND effect = '' ORDER BY depth, run.id", (along,)).fetchall()
    seen = {}
    with tempfile.TemporaryDirectory() as work:
        for depth, friction, rolling, density, first_s, step_s, windows, curve in digs:
            recording = os.path.join(work, "dig.csv")
            write(recording, start, phases, depth, first_s, step_s, windows, curve)
            seen.setdefault(depth, []).append(((friction, rolling, density), identify(binaries, table, recording, work)))
    print("depth  digs  refused  outside   told: mean  standard deviation   in the 90 % interval: friction  rolling  density")
    for depth, all_digs in seen.items():
        told = [(truth, one) for truth, one in all_digs if one is not None]
        depths = [one["depth"] for _, one in told]
        mean = sum(depths) / len(depths)
        spread = math.sqrt(sum((d - mean) ** 2 for d in depths) / max(len(depths) - 1, 1))
        held = [sum(one["low"][axis] <= truth[i] * (1 + 1e-9) and truth[i] <= one["high"][axis] * (1 + 1e-9) for truth, one in told)
                for i, axis in enumerate(("friction", "rolling", "density_kgpm3"))]
        print(f"{depth:5.2f} {len(all_digs):5d} {len(all_digs) - len(told):8d} {sum(one['outside'] for _, one in told):8d} "
              f"{mean:12.3f} {spread:19.3f} {held[0]:39d} {held[1]:8d} {held[2]:8d}")


if __name__ == "__main__":
    main()
