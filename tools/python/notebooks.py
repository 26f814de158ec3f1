"""Writes the notebooks examples/*.ipynb from the scripts of the same names, whose cells begin with `# %%`.

    python3 tools/python/notebooks.py

Cells of text begin with `# %% [markdown]`; their lines are comments. The notebooks have no outputs.
"""
from __future__ import annotations

import json
from pathlib import Path

FOLDER = Path(__file__).resolve().parent / "examples"
NAMES = ("live_collapse", "ensemble_statistics", "precision_cost")


def cell(kind: str, lines: list[str]) -> dict:
    if kind == "markdown":
        lines = [line[1:].removeprefix(" ") for line in lines]
    text = "\n".join(lines).strip("\n")
    code = {"execution_count": None, "outputs": []} if kind == "code" else {}
    return {"cell_type": kind, "metadata": {}, **code, "source": text.splitlines(keepends=True)}


def notebook(name: str) -> str:
    """The text of the notebook with the cells of the script of this name."""
    cells: list[tuple[str, list[str]]] = []
    for line in (FOLDER / f"{name}.py").read_text("utf-8").splitlines():
        if line.startswith("# %%"):
            cells.append(("markdown" if "[markdown]" in line else "code", []))
        else:
            cells[-1][1].append(line)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    whole = {"cells": [cell(kind, lines) for kind, lines in cells], "nbformat": 4, "nbformat_minor": 4,
             "metadata": {"kernelspec": kernel, "language_info": {"name": "python"}}}
    return json.dumps(whole, indent=1) + "\n"


if __name__ == "__main__":
    for each in NAMES:
        (FOLDER / f"{each}.ipynb").write_text(notebook(each), "utf-8")
