#!/usr/bin/python3
"""The paper's Tables V and VII and Figures 13 to 15, from a table and digs of another code (docs/python.md).

    PYTHONPATH=python python/examples/paper.py OUT [TABLE.sqlite]

Writes OUT/paper.html and a CSV of each; matplotlib, where there is one, draws the figures.
"""

import sys
from pathlib import Path

import digsight
import numpy as np
import pandas as pd

try:
    import matplotlib
except ImportError:
    matplotlib = None

# The gravels of the paper's Table V as LIGGGHTS digs them; X is of mixed sizes and in no table.
OBJECTS = {
    "A": "tests/data/reference/mu0.5_mur0.9_rho2500__{}.csv",
    "B": "tests/data/reference/mu0.3_mur0.9_rho2500__{}.csv",
    "C": "tests/data/reference/mu0.3_mur0.3_rho2500__{}.csv",
    "X": "tests/data/liggghts_digs/poly_seed1__{}.csv",
}
ABOUT = """<!doctype html>
<meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>The paper, from a table</title>
<body style="font-family: sans-serif">
<p>Objects A .5/.9/2500, B .3/.9/2500, C .3/.3/2500 and X (.5/.5/2500, grains of 6 to 10 mm) are single digs of
LIGGGHTS. Error and difference: Euclidean norm of the moment, relative, smoothed by &plusmn;0.16 s.</p>"""
GRAVEL = ["friction", "rolling", "density_kgpm3"]


def smooth(moments: pd.DataFrame, half_s: float) -> pd.DataFrame:
    """The paper's moving average, centred, of columns over time."""
    half = round(half_s / (moments.index[1] - moments.index[0]))
    return moments.rolling(2 * half + 1, center=True, min_periods=1).mean()


def calculated(table: digsight.Table, trajectory: str) -> pd.DataFrame:
    """Mean moment over beds, one column a gravel, named friction/rolling/density."""
    moments = table.runs(trajectory=trajectory).pivot_table(values="moment_Nm", index="t_s", columns=GRAVEL)
    return moments.set_axis(["/".join(f"{value:g}" for value in gravel) for gravel in moments], axis="columns")


def measured(trajectory: str, times_s: pd.Index) -> pd.DataFrame:
    """Moment, one column an object."""
    digs = {name: pd.read_csv(path.format(trajectory), comment="#") for name, path in OBJECTS.items()}
    return pd.DataFrame({name: np.interp(times_s, dig["t_s"], dig["My_Nm"]) for name, dig in digs.items()}, times_s)


def norms(curve: pd.Series, others: pd.DataFrame) -> pd.Series:
    """Euclidean norm of the difference to each of the others, over that of the curve."""
    return np.sqrt(others.sub(curve, axis=0).pow(2).sum() / curve.pow(2).sum())


def reproduce(path: str) -> dict[str, pd.DataFrame]:
    """Title to table or figure; a figure is indexed by time."""
    table = digsight.open_table(path)
    model = {name: smooth(calculated(table, name), table.scene["smooth_half_s"]) for name in ("simpleA", "actual")}
    digs = {name: smooth(measured(name, model[name].index), table.scene["smooth_half_s"]) for name in model}

    rows = {}
    for name in OBJECTS:
        error = norms(digs["actual"][name], model["actual"])
        by_simple = norms(digs["simpleA"][name], model["simpleA"]).idxmin()
        rows[name] = [error.idxmin(), error.min(), by_simple, error[by_simple]]
    columns = ["nearest actual dig", "its error", "nearest simple dig", "error of its actual dig"]
    nearest = pd.DataFrame.from_dict(rows, "index", columns=columns)

    # X is taken for the object whose simple dig is nearest, as in the paper, and for the gravel whose is.
    to_x = norms(digs["simpleA"]["X"], digs["simpleA"][["A", "B", "C"]]).to_frame("difference to X")
    gravels = {name: nearest.loc[name, "nearest simple dig"] for name in (to_x["difference to X"].idxmin(), "X")}
    actual = {f"{gravel}, chosen for {name}": model["actual"][gravel] for name, gravel in gravels.items()}
    return {
        "Table V: the gravel (friction/rolling friction/density) that is nearest to each object": nearest,
        "Table VII: simple digs of the objects against that of X": to_x,
        "Figure 13: simple dig of X, and of the others": digs["simpleA"],
        "Figure 14: actual dig of X": digs["actual"][["X"]],
        "Figure 15: actual dig of X, measured and calculated": pd.DataFrame({"measured": digs["actual"]["X"]} | actual),
    }


def put(title: str, frame: pd.DataFrame, out: Path) -> str:
    """Writes the CSV, draws; returns what the page shows."""
    path = out / title.split(":")[0].lower().replace(" ", "_")
    frame.to_csv(path.with_suffix(".csv"), float_format="%.6g")
    if frame.index.name != "t_s":
        return frame.to_html(float_format="{:.3f}".format)
    if matplotlib is None:
        return f'<a href="{path.name}.csv">{path.name}.csv</a>'
    axes = frame.plot(figsize=(7.6, 3.8), grid=True, style=["-", "--", ":", "-."], xlabel="t [s]", ylabel="My [N m]")
    axes.figure.savefig(path.with_suffix(".png"), dpi=120, bbox_inches="tight")
    return f'<img src="{path.name}.png" alt="{title}" style="max-width: 100%">'


def main(out: str, path: str = "tables/reference_rig.sqlite") -> None:
    if matplotlib is not None:
        matplotlib.use("Agg")
    Path(out).mkdir(parents=True, exist_ok=True)
    page = [ABOUT]
    page += [f"<h2>{title}</h2>\n{put(title, frame, Path(out))}" for title, frame in reproduce(path).items()]
    Path(out, "paper.html").write_text("\n".join(page) + "\n", encoding="utf-8")
    print(f"{out}/paper.html")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: paper.py OUT [TABLE.sqlite]")
    main(*sys.argv[1:])
