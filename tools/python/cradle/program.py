"""Finds and calls the program `cradle`: its output, its message and its progress."""
from __future__ import annotations

import contextlib
import html
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence

from .errors import BAD_FILE, BAD_INPUT, DONE, Error, in_python

WHERE = ((*[".."] * 3, "build", "release", "tools", "cradle"), (*[".."] * 4, "bin", "cradle"))  # from this package
WIDTH = 30  # of a bar
Show = Callable[[float, str], None]  # of the finished share and a line of text


def find() -> str:
    """The program: $CRADLE_PROGRAM, that of this package's build or installation, or `cradle` on the path.

    Raises Error if there is none.
    """
    chosen = os.environ.get("CRADLE_PROGRAM")
    here = os.path.dirname(os.path.abspath(__file__))
    own = (os.path.normpath(os.path.join(here, *where)) for where in WHERE)
    tried = [chosen] if chosen else [*own, "cradle"]
    for place in tried:
        if found := shutil.which(place):
            return found
    raise Error(f"the program cradle is missing (tried {', '.join(tried)}): "
                "build it with tools/quickstart.sh, or set CRADLE_PROGRAM to it", BAD_FILE)


def call(arguments: Sequence[str], accepted: Sequence[int] = (DONE,), show: Show | None = None,
         warn: Callable[[str], None] | None = None) -> subprocess.CompletedProcess[str]:
    """Calls the program with these arguments.

    show: called some times a second with the finished share, 0 to 1, and a line of text.
    warn: called with the lines that the program writes to standard error while it computes.
    Raises Error with the program's message and status if the status is not among the accepted ones. Ctrl-C interrupts
    the program, which writes its checkpoint, and then the caller.
    """
    command = [find(), *map(str, arguments)]
    ours, theirs = socket.socketpair()  # for its progress (tools/support/progress.hpp)
    environment = os.environ | {"CRADLE_PROGRESS_FD": str(theirs.fileno())}  # keeps progress out of the messages
    child = None
    with ours, theirs, tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        try:
            # The call gets its own session: else Ctrl-C in a terminal would send it a second signal, which ends it.
            with interrupts_later():
                child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                         start_new_session=True, pass_fds=[theirs.fileno()], env=environment)
            theirs.close()
            read = 0
            with ours.makefile(encoding="utf-8", errors="replace") as lines:
                for line in lines:
                    messages = os.pread(err.fileno(), 1 << 16, read)
                    messages = messages[:messages.rfind(b"\n") + 1]
                    read += len(messages)
                    if warn and messages:
                        warn(messages.decode("utf-8", "replace"))
                    share, text = line.rstrip("\n").split("\t", 1)
                    if show:
                        show(float(share), text)
            status = child.wait()
        except BaseException as error:  # Ctrl-C, first of all
            if child is not None:
                child.send_signal(signal.SIGINT)
                child.wait()
            elif isinstance(error, ValueError):  # a character 0
                raise Error(f"a word that no program can be given ({error}): leave out the character 0",
                            BAD_INPUT) from None
            elif isinstance(error, OSError):
                raise Error(f"{command[0]} cannot be run ({error.strerror}): set CRADLE_PROGRAM to a program of this "
                            "machine", BAD_FILE) from None
            raise
        out.seek(0), err.seek(0)
        printed, messages = (file.read().decode("utf-8", "replace") for file in (out, err))
    if status in accepted:
        return subprocess.CompletedProcess(command, status, printed, messages)
    said = ("\n" + messages.strip()).rpartition("\ncradle: ")[2]  # without what was noted before
    raise Error(in_python(said) or f"{' '.join(command[:2])} ended without a message (status {status}): "
                "run it in a terminal to see more", status if status >= 0 else 128 - status)


@contextlib.contextmanager
def interrupts_later():
    """Delays Ctrl-C to the end of the block: one that came while a program is being started would leave it running."""
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or before is None:
        yield
        return
    came = []
    signal.signal(signal.SIGINT, lambda number, frame: came.append((number, frame)))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if came and callable(before):
        before(*came[0])


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
