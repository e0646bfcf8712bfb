#!/usr/bin/python3
"""Real plates pressed into real sand as tables and campaigns of our own formats (docs/python.md).

    plates.py DATA OUT [FACTOR]

DATA holds large_N_ft.csv, large_N_pos.csv, small_N_ft.csv and small_N_pos.csv, N from 1 to 9: force, and place of the
stage, of a testbed. Of every plate's six repeats each choice of three becomes a folder OUT/PLATE_NNN: scene.yaml, map.yaml and
curves.csv for `digtable import`, and a campaign of the other three, whose forces are multiplied by FACTOR.
"""

import sys
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd

SIDES_m = [0.06, 0.1, 0.08]  # of repeats 1-3, 4-6, 7-9 of both boxes
SPEED_mps, STEP_s = 0.02, 0.005  # the stage was cranked: depth tells how far a push is, not time
TOUCH_N = 2  # above what the sensor drifts by
CLOCKS_APART_s = 5 * 3600  # of the two files
SCENE = """name: plate
source: a square plate pressed level into sand; what says how to compute it is not measured
# The pin is above the front edge: the force in the plate's middle has a lever of half its side.
bucket: {{width_m: {side}, profile_m: [[0, -0.1], [-{side}, -0.1], [-{side}, -0.09]]}}
box_m: {{x: [0, 0.6], y: [-0.3, 0.3], z: [0, 0.2]}}
packing: {{solid_fraction: 0.3, fill_factor: 0.7, fall_mps: 0.3, settle_s: 0.1, relax_s: 0.1}}
material: {{diameter_m: 0.01, young_Pa: 5.0e+6, poisson: 0.2, restitution: 0.2, characteristic_velocity_mps: 2}}
gravity_mps2: 9.81
time_step_s: 0
output_s: {step}
trajectories:
  - name: simplePush
    theta0_deg: 0
    start_pin_m: [0.3, 0.3]
    phases: [{{name: push, duration_s: {duration}, vx_mps: 0, vz_mps: -{speed}, omega_degps: 0}}]
"""
MAP = """scene: scene.yaml
engine: testbed
version: sand
columns:
  friction: {value: 0.5} # one ground, whose gravel nobody knows: the values only name it
  rolling: {value: 0.5}
  density_kgpm3: {value: 1600}
  trajectory: {value: simplePush}
  packing: {column: repeat}
  t_s: {column: t_s}
  My_Nm: {column: My_Nm}
  Fx_N: {value: 0} # not taken from the data, and in no recording of the campaign
  Fz_N: {value: 0}
"""


def push(data: Path, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Depth below where the plate touches, m, never falling, and the force up, N; until the deepest place."""
    path = data / f"{name}_ft.csv"
    began_s = float(path.read_text().partition("t0_unix=")[2].split()[0])
    sensor, stage = pd.read_csv(path, comment="#"), pd.read_csv(data / f"{name}_pos.csv")
    z_m = 1e-3 * np.interp(sensor["t_s"], stage["t_unix"] + CLOCKS_APART_s - began_s, stage["Z_mm"])
    force_N = sensor["Fz_N"][:100].median() - sensor["Fz_N"]
    touch, end = np.argmax(force_N.rolling(20).median() > TOUCH_N), np.argmin(z_m)
    depth_m = np.maximum.accumulate(-z_m)[touch:end]
    return depth_m - depth_m[0], force_N.to_numpy()[touch:end]


def moments(depth_m: np.ndarray, force_N: np.ndarray, deepest_m: float, side_m: float) -> pd.DataFrame:
    """The moment about the pin at even steps of a push at SPEED_mps, mean of all forces at a tenth of a millimetre."""
    mean_N = pd.Series(force_N).groupby(np.rint(depth_m / 1e-4)).mean()
    t_s = np.arange(0, deepest_m / SPEED_mps, STEP_s)
    return pd.DataFrame({"t_s": t_s, "My_Nm": side_m / 2 * np.interp(SPEED_mps * t_s, 1e-4 * mean_N.index, mean_N)})


def write(folder: Path, side_m: float, table: list[pd.DataFrame], campaign: list[pd.DataFrame], factor: float) -> None:
    folder.joinpath("campaign").mkdir(parents=True)
    duration_s = table[0]["t_s"].iloc[-1]
    scene = SCENE.format(side=side_m, step=STEP_s, duration=f"{duration_s:.6f}", speed=SPEED_mps)
    folder.joinpath("scene.yaml").write_text(scene)
    folder.joinpath("map.yaml").write_text(MAP)
    # A table's sample is the mean over its window, at the window's middle.
    windows = [dig.rolling(2).mean()[1:].assign(repeat=number) for number, dig in enumerate(table)]
    pd.concat(windows).to_csv(folder / "curves.csv", index=False)
    lines = ["scene: plate", "recordings:"]
    for number, dig in enumerate(campaign):
        pose = {"pin_x_m": 0.3, "pin_z_m": 0.3 - SPEED_mps * dig["t_s"], "theta_deg": 0, "My_Nm": factor * dig["My_Nm"]}
        dig.assign(**pose).to_csv(folder / "campaign" / f"{number}.csv", index=False)
        lines.append(f"  - {{file: {number}.csv, trajectory: simplePush, role: fit}}")
    folder.joinpath("campaign", "campaign.yaml").write_text("\n".join(lines) + "\n")


def main(data: str, out: str, factor: str = "1") -> None:
    for group, side_m in enumerate(SIDES_m):
        names = [f"{box}_{3 * group + n}" for box in ("large", "small") for n in (1, 2, 3)]
        pushes = [push(Path(data), name) for name in names]
        deepest_m = min(depth_m[-1] for depth_m, _ in pushes)
        digs = [moments(*each, deepest_m, side_m) for each in pushes]
        for chosen in combinations(range(6), 3):
            folder = Path(out, f"{1e3 * side_m:.0f}mm_" + "".join(str(n + 1) for n in chosen))
            others = [dig for n, dig in enumerate(digs) if n not in chosen]
            write(folder, side_m, [digs[n] for n in chosen], others, float(factor))


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
