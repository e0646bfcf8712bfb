"""Reads tables and traces of Digsight as pandas frames; writes nothing. Recipes: docs/python.md."""

from .table import Table, open_table
from .trace import Trace, read_trace

__all__ = ["Table", "Trace", "open_table", "read_trace"]
