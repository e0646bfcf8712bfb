"""What `digloop trace --json` found (docs/formats/trace.md, "Trace (JSON)")."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from .outside import check_regular, check_texts


@dataclass(frozen=True, repr=False)
class Trace:
    """The lists of the file as frames. A column is named by the path to it, as `soil.moment_Nm.before.rms`."""

    verdict: list[str]
    effects: pd.DataFrame
    candidates: pd.DataFrame
    residuals: pd.DataFrame
    residual_against: pd.DataFrame  # of each regressor; bins holds a list
    material: pd.DataFrame  # of each axis: value, low, high; before: without the effects
    whole: dict[str, Any]  # the file as it is, with the rest

    def __repr__(self) -> str:
        return f"<trace of {self.whole['digs']} digs: {', '.join(self.verdict)}>"


def read_trace(path: str | Path) -> Trace:
    """Reads a trace; ValueError where it is none."""
    check_regular(path)
    text = Path(path).read_text(encoding="utf-8")
    try:
        whole = json.loads(text)
        if not isinstance(whole, dict):
            raise ValueError(f"{path}: a {type(whole).__name__}, expected an object")
        check_texts(path, whole)
        lists = ("effects", "candidates", "residuals", "residual_against")
        for name, kind in {"verdict": str, **dict.fromkeys(lists, dict)}.items():
            if not isinstance(whole[name], list) or not all(isinstance(one, kind) for one in whole[name]):
                raise ValueError(f"{path}: {name}: expected what digloop trace --json writes")
        if "digs" not in whole:  # __repr__ tells it
            raise KeyError("digs")
        material = pd.DataFrame(whole["material"]).T
        material["before"] = pd.Series(whole["material_before"], dtype=float)
        frames = {name: pd.json_normalize(whole[name]) for name in lists}
        return Trace(verdict=whole["verdict"], material=material, whole=whole, **frames)
    except json.JSONDecodeError as error:
        raise ValueError(f"{path}:{error.lineno}: {error.msg}, expected JSON") from error
    except RecursionError as error:
        raise ValueError(f"{path}: nested too deep, expected what digloop trace --json writes") from error
    except KeyError as error:
        raise ValueError(f"{path}: no key {error}, expected what digloop trace --json writes") from error
