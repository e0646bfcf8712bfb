#!/usr/bin/env python3
"""Measures again what README and docs/accuracy.md quote, and compares.

docs/figures.toml ties a figure to the command that prints it:

  [[figure]]
  doc = "docs/accuracy.md"
  quoted = 'regular expression of the document, a group for each number'
  command = "what to run, from the root of the sources"
  printed = 'regular expression of its output, a group for each number'
  within = 0.02        # how far apart they may be; default: half a unit of the last digit quoted
  range = true         # of all that is printed: the most, or the least and the most where two are quoted
  cost = "quick"       # or "long": hours

A figure without groups holds where `printed` is found. A row of a table in docs/accuracy.md that no figure is tied
to fails, too.

usage: release_check.py [--all | --ties] [--logs DIR] [--from DIR] [--list FILE] [--page FILE]

  --all        the long ones, too
  --ties       run nothing: is every figure in its document, and has every row a command? (part of make docs-check)
  --logs DIR   keep what the commands print there (build/release)
  --from DIR   take what they printed from there, run what is missing
  --list FILE  the figures (docs/figures.toml)
  --page FILE  write the table there (build/release/figures.md)

examples:
  scripts/release_check.py                        # minutes
  scripts/release_check.py --all --from build/release

exit codes: 0 all agree; 1 one differs, is not found or has no command; 2 bad usage
"""
import argparse
import hashlib
import pathlib
import re
import subprocess
import sys
import tomllib


def fail(text):
    print(f"release_check: {text}", file=sys.stderr)
    sys.exit(2)


def read_figures(path):
    try:
        with open(path, "rb") as file:
            figures = tomllib.load(file).get("figure", [])
    except (OSError, tomllib.TOMLDecodeError) as error:
        fail(f"{path}: {error}")
    for number, figure in enumerate(figures, 1):
        for key in ("doc", "quoted", "command", "printed"):
            if not isinstance(figure.get(key), str):
                fail(f"{path}: figure {number}: key `{key}`: missing, expected a text")
        if figure.get("cost", "quick") not in ("quick", "long"):
            fail(f"{path}: figure {number}: key `cost`: expected quick or long")
        for key in ("quoted", "printed"):
            try:
                re.compile(figure[key])
            except re.error as error:
                fail(f"{path}: figure {number}: key `{key}`: {error}")
    return figures


def half_a_unit(text):
    mantissa, _, exponent = text.lower().partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 0.5 * 10.0 ** (int(exponent or 0) - decimals) * 1.000001


class Outputs:
    """What commands print: run once each, kept, or taken from an earlier run."""

    def __init__(self, logs, earlier):
        self.logs, self.earlier, self.seen = logs, earlier, {}

    def of(self, command):
        if command not in self.seen:
            name = hashlib.sha256(command.encode()).hexdigest()[:12] + ".log"
            if self.earlier and (self.earlier / name).is_file():
                self.seen[command] = (self.earlier / name).read_text(errors="replace")
            else:
                print(f"release_check: {command}", file=sys.stderr, flush=True)
                # The commands are ours, from a file of the sources; what they print is read as text.
                done = subprocess.run(["bash", "-c", command], stdin=subprocess.DEVNULL, text=True, errors="replace",
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
                self.seen[command] = done.stdout
                self.logs.mkdir(parents=True, exist_ok=True)
                (self.logs / name).write_text(done.stdout)
        return self.seen[command]


def judge(figure, text, outputs, costs):
    """(quoted, measured, verdict)"""
    quoted = re.search(figure["quoted"], text, re.M)
    if not quoted:
        return figure["quoted"], "", "not in the document"
    said = quoted.groups()
    if figure.get("cost", "quick") not in costs:
        return " ".join(said), "", "not run"
    printed = re.search(figure["printed"], outputs.of(figure["command"]), re.M)
    if not printed:
        return " ".join(said), "", "not printed"
    measured = printed.groups()
    if figure.get("range"):
        all_of_it = [m[1] for m in re.finditer(figure["printed"], outputs.of(figure["command"]), re.M)]
        measured = (min(all_of_it, key=float), max(all_of_it, key=float))[2 - len(said):]
    if len(said) != len(measured):
        return " ".join(said), " ".join(measured), "not as many numbers"
    agree = all(abs(float(a.replace("−", "-")) - float(b)) <= figure.get("within", half_a_unit(a)) for a, b in zip(said, measured))
    return " ".join(said), " ".join(measured), "ok" if agree else "differs"


def rows_without_a_figure(path, text, figures):
    """Rows of the tables of a document that hold a digit and that no figure is tied to."""
    covered = set()
    for figure in figures:
        if figure["doc"] == path:
            for match in re.finditer(figure["quoted"], text, re.M):
                covered.update(range(text.count("\n", 0, match.start()), text.count("\n", 0, match.end()) + 1))
    rows, head = [], False
    lines = text.split("\n")
    for number, line in enumerate(lines):
        is_row = line.startswith("|")
        ruled = is_row and re.fullmatch(r"[|\s:-]+", line)
        titled = is_row and number + 1 < len(lines) and re.fullmatch(r"[|\s:-]+", lines[number + 1] or "x")
        if is_row and not ruled and not titled and number not in covered and re.search(r"\d", line):
            rows.append(line)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--ties", action="store_true")
    parser.add_argument("--logs", type=pathlib.Path, default=pathlib.Path("build/release"))
    parser.add_argument("--from", dest="earlier", type=pathlib.Path)
    parser.add_argument("--list", default="docs/figures.toml")
    parser.add_argument("--page", type=pathlib.Path, default=pathlib.Path("build/release/figures.md"))
    parser.add_argument("--rows-of", default="docs/accuracy.md", help=argparse.SUPPRESS)
    options = parser.parse_args()
    figures = read_figures(options.list)
    outputs = Outputs(options.logs, options.earlier)
    costs = () if options.ties else ("quick", "long") if options.all else ("quick",)
    lines, bad = ["| document | quoted | measured | | command |", "|---|---|---|---|---|"], 0
    for figure in figures:
        text = pathlib.Path(figure["doc"]).read_text()
        quoted, measured, verdict = judge(figure, text, outputs, costs)
        if verdict not in ("ok", "not run"):
            bad += 1
        elif options.ties:
            continue
        lines.append(f"| {figure['doc']} | {quoted} | {measured} | {verdict} | `{figure['command']}` |")
    rows = rows_without_a_figure(options.rows_of, pathlib.Path(options.rows_of).read_text(), figures)
    bad += len(rows)
    lines += ["", f"Rows of {options.rows_of} without a command: {len(rows)}", *rows]
    if options.ties and not bad:
        return 0
    if not options.ties:
        options.page.parent.mkdir(parents=True, exist_ok=True)
        options.page.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    print(f"{len(figures)} figures, {bad} wrong or without a command")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
