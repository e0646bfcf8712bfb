"""What comes from others: files that are none, and texts that would command a terminal once a frame is printed."""

import os
import stat
from pathlib import Path
from typing import Any


def check_regular(path: str | Path) -> None:
    """ValueError where a read would be of a folder or a device, or wait for a pipe; OSError where nothing is there."""
    if not stat.S_ISREG(os.stat(path).st_mode):
        raise ValueError(f"{path}: no regular file, expected one")


def check_texts(path: str | Path, value: Any) -> None:
    """ValueError where value, or anything in it, is a text with control characters other than line breaks and tabs."""
    if isinstance(value, str):
        if not value.translate({9: None, 10: None}).isprintable():
            raise ValueError(f"{path}: {value!r:.80}, expected printable text")
    elif isinstance(value, dict):
        check_texts(path, list(value.items()))
    elif isinstance(value, (list, tuple)):
        for one in value:
            check_texts(path, one)
