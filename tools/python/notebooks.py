"""Writes the notebooks examples/*.ipynb from the scripts of the same names, whose cells begin with `# %%`.

    python3 tools/python/notebooks.py

Cells of text begin with `# %% [markdown]`; their lines are comments. The notebooks have no outputs.
"""
from __future__ import annotations

import json
import os

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "examples")
NAMES = ("live_collapse", "ensemble_statistics", "precision_cost")


def path(name: str, ending: str) -> str:
    return os.path.join(FOLDER, name + ending)


def cell(kind: str, lines: list[str]) -> dict:
    if kind == "markdown":
        lines = [line[1:].removeprefix(" ") for line in lines]
    text = "\n".join(lines).strip("\n")
    code = {"execution_count": None, "outputs": []} if kind == "code" else {}
    return {"cell_type": kind, "metadata": {}, **code, "source": text.splitlines(keepends=True)}


def notebook(script: str) -> str:
    """The text of a notebook with the cells of the script."""
    cells: list[tuple[str, list[str]]] = []
    for line in script.splitlines():
        if line.startswith("# %%"):
            cells.append(("markdown" if "[markdown]" in line else "code", []))
        else:
            cells[-1][1].append(line)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    whole = {"cells": [cell(kind, lines) for kind, lines in cells], "nbformat": 4, "nbformat_minor": 4,
             "metadata": {"kernelspec": kernel, "language_info": {"name": "python"}}}
    return json.dumps(whole, indent=1) + "\n"


def from_script(name: str) -> str:
    with open(path(name, ".py"), encoding="utf-8") as file:
        return notebook(file.read())


if __name__ == "__main__":
    for each in NAMES:
        with open(path(each, ".ipynb"), "w", encoding="utf-8") as written:
            written.write(from_script(each))
