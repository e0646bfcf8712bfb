#!/usr/bin/env python3
"""Plain gravel of LIGGGHTS whose recordings end early: what `digloop trace` says of it.

    scripts/cut_study.py [CAMPAIGNS [LEAST]]     (BIN=build/bin)

A campaign has one bed of tests/data/reference along simpleA and actual, each cut at a share of its time drawn from LEAST
(.8) to 1. Prints a line a campaign, then how many (40) are `none`, have a name or are `unlisted`, and are refused.
A minute of one core.
"""
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

DIGS = pathlib.Path("tests/data/reference")
BEDS = ["mu0.3_mur0.3_rho2500", "mu0.3_mur0.9_rho2500", "mu0.5_mur0.5_rho2500", "mu0.5_mur0.9_rho2500", "mu0.9_mur0.3_rho2500",
        "mu0.9_mur0.9_rho2500", "mu0.5_mur0.5_rho4000", "mu0.3_mur0.3_rho2500_seed2", "mu0.9_mur0.9_rho2500_seed3",
        "mu0.5_mur0.5_rho2500_seed4"]


def cut(dig, share, to):
    head, *rows = dig.read_text().splitlines()
    end = share * float(rows[-1].split(",")[0])
    to.write_text("\n".join([head] + [row for row in rows if float(row.split(",")[0]) <= end]) + "\n")


def trace(bed, shares, folder):
    """Verdict of the campaign, or why it was refused."""
    for trajectory, share in shares.items():
        cut(DIGS / f"{bed}__{trajectory}.csv", share, folder / f"{trajectory}.csv")
    (folder / "campaign.yaml").write_text(
        "scene: rig\nrecordings:\n  - {file: simpleA.csv, trajectory: simpleA, role: identify}\n"
        "  - {file: actual.csv, trajectory: actual, role: fit}\n")
    run = subprocess.run([f"{os.environ.get('BIN', 'build/bin')}/digloop", "trace", "tables/reference_rig.sqlite", folder, "-q",
                          "--json", folder / "trace.json"], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        return "refused: " + run.stderr.splitlines()[-1]
    return " ".join(json.loads((folder / "trace.json").read_text())["verdict"])


def main():
    given = sys.argv[1:]
    campaigns, least = int(given[0]) if given else 40, float(given[1]) if given[1:] else .8
    random.seed(1)
    said = []
    for _ in range(campaigns):
        bed = random.choice(BEDS)
        shares = {"simpleA": random.uniform(least, 1), "actual": random.uniform(least, 1)}
        with tempfile.TemporaryDirectory() as folder:
            said.append(trace(bed, shares, pathlib.Path(folder)))
        print(f"{bed:28} {shares['simpleA']:.2f} {shares['actual']:.2f}  {said[-1]}", flush=True)
    none, refused = said.count("none"), sum(s.startswith("refused") for s in said)
    print(f"none {none}, named or unlisted {campaigns - none - refused}, refused {refused} of {campaigns}")


if __name__ == "__main__":
    main()
