"""Progress of a call: a bar on a terminal, in a notebook, or the caller's own function."""
from __future__ import annotations

import contextlib
import html
import sys
from collections.abc import Callable, Iterator

Show = Callable[[float, str], None]
WIDTH = 30


@contextlib.contextmanager
def shown(progress: bool | Show | None) -> Iterator[Show | None]:
    """The function to call with the finished share and a line of text; None if nothing is to be shown.

    progress: a function of these two; True or False; None shows progress on terminals and in notebooks.
    """
    shell = sys.modules.get("IPython") and sys.modules["IPython"].get_ipython()
    if callable(progress) or progress is False:
        yield progress or None
    elif type(shell).__name__ == "ZMQInteractiveShell":
        yield from notebook()
    elif progress or (sys.stderr is not None and sys.stderr.isatty()):
        yield from terminal()
    else:
        yield None


def terminal() -> Iterator[Show]:
    def show(share: float, text: str) -> None:
        print(f"\r\033[K[{'#' * int(share * WIDTH):<{WIDTH}}] {text}", end="", file=sys.stderr, flush=True)
        drawn.append(True)

    drawn: list[bool] = []
    try:
        yield show
    finally:
        if drawn:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


def notebook() -> Iterator[Show]:
    from IPython.display import HTML, display

    def show(share: float, text: str) -> None:
        last[0] = html.escape(text)
        handle.update(HTML(f'<progress max="1" value="{share:.3f}" style="width:20em"></progress> {last[0]}'))

    handle, last = display(HTML(""), display_id=True), [""]
    try:
        yield show
    finally:
        handle.update(HTML(last[0]))
