"""Progress of a call: a bar on a terminal, in a notebook, or the caller's own function."""
from __future__ import annotations

import contextlib
import html
import sys
from collections.abc import Callable, Iterator

Show = Callable[[float, str], None]
WIDTH = 30


def in_notebook() -> bool:
    shell = sys.modules.get("IPython")
    shell = shell.get_ipython() if shell is not None else None
    return type(shell).__name__ == "ZMQInteractiveShell"


@contextlib.contextmanager
def shown(progress: bool | Show | None) -> Iterator[Show | None]:
    """What to call with the share done and a line of text; None where nothing is to be shown.

    progress: a function of these two; True and False; None shows where there is a terminal or a notebook.
    """
    if callable(progress):
        yield progress
    elif progress is False:
        yield None
    elif in_notebook():
        yield from notebook()
    elif progress or (sys.stderr is not None and sys.stderr.isatty()):
        yield from terminal()
    else:
        yield None


def terminal() -> Iterator[Show]:
    def show(share: float, text: str) -> None:
        sys.stderr.write(f"\r\033[K[{'#' * int(share * WIDTH):<{WIDTH}}] {text}")
        sys.stderr.flush()
        drawn.append(True)

    drawn: list[bool] = []
    try:
        yield show
    finally:
        if drawn:
            sys.stderr.write("\r\033[K")
            sys.stderr.flush()


def notebook() -> Iterator[Show]:
    from IPython.display import HTML, display

    def bar(share: float, text: str):
        return HTML(f'<progress max="1" value="{share:.3f}" style="width:20em"></progress> {html.escape(text)}')

    handle = display(bar(0, ""), display_id=True)
    last: list[str] = [""]

    def show(share: float, text: str) -> None:
        last[0] = text
        handle.update(bar(share, text))

    try:
        yield show
    finally:
        handle.update(HTML(html.escape(last[0])))
