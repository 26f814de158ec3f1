"""Scenes: the text in a result as nested dicts, and nested dicts as text for the program."""
from __future__ import annotations

import json
import re
from typing import Any, Mapping


def parse_toml(text: str) -> dict[str, Any]:
    """The scene as nested dicts; without tomllib (Python < 3.11) only tables of single-line scalars."""
    try:
        import tomllib
        return tomllib.loads(text)
    except ImportError:
        pass
    root: dict[str, Any] = {}
    table = root
    for line in text.splitlines():
        if header := re.match(r"\s*\[([\w.\- ]+)\]", line):
            table = root
            for key in header[1].split("."):
                table = table.setdefault(key.strip(), {})
        elif entry := re.match(r"\s*([\w.\-]+)\s*=\s*(\"[^\"]*\"|[^\s#]+)", line):
            *path, last = entry[1].split(".")
            inner = table
            for key in path:
                inner = inner.setdefault(key, {})
            inner[last] = entry[2].strip('"')
    return root


def value_text(value: Any) -> str:
    """A value as TOML: numbers with all digits (a Decimal too, not a Fraction), texts quoted, lists in brackets."""
    if hasattr(value, "tolist"):  # numpy's
        value = value.tolist()
    if isinstance(value, (bool, str)):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")  # written as in TOML
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {value_text(inner)}" for key, inner in given(value)) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(inner) for inner in value) + "]"
    return str(value)


def given(table: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """Without the keys that are None."""
    return [(key, value) for key, value in table.items() if value is not None]


def scene_text(scene: Mapping[str, Any]) -> str:
    """A scene file of nested dicts, `{"law": {"type": "wet", "loss": 1e-4}, ...}`."""
    plain = {key: value for key, value in given(scene) if not isinstance(value, Mapping)}
    lines = [f"{key} = {value_text(value)}" for key, value in plain.items()]
    for name, table in given(scene):
        if name not in plain:
            lines.append(f"[{name}]")
            lines += [f"{key} = {value_text(value)}" for key, value in given(table)]
    return "\n".join(lines) + "\n"
