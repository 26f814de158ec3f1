"""The program `cradle`: where it is, and calling it: what it prints, its message and its progress."""
from __future__ import annotations

import contextlib
import os
import re
import selectors
import shutil
import signal
import subprocess
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from .errors import BAD_FILE, DONE, Error

BAR = re.compile(r"\[(#*) *\] (.*)")  # tools/support/progress.cpp, on a terminal
REDRAWN = re.compile(r"\r(?:\033\[K)?")
WHERE = ((*[".."] * 3, "build", "release", "tools", "cradle"), (*[".."] * 4, "bin", "cradle"))  # from this package


def find() -> str:
    """The program: $CRADLE_PROGRAM, that of the build or installation that this package is of, or `cradle` on the path.

    Raises Error where there is none.
    """
    chosen = os.environ.get("CRADLE_PROGRAM")
    here = os.path.dirname(os.path.abspath(__file__))
    own = (os.path.normpath(os.path.join(here, *where)) for where in WHERE)
    looked_at = [chosen] if chosen else [*own, "cradle"]
    for place in looked_at:
        if found := shutil.which(place):
            return found
    raise Error(f"the program cradle is missing (looked at {', '.join(looked_at)}): "
                "build it with tools/quickstart.sh, or set CRADLE_PROGRAM to it", BAD_FILE)


@dataclass
class Call:
    """What a call came to: standard output, messages on standard error, exit status."""
    out: str
    messages: str
    status: int


def call(arguments: Sequence[str], accepted: Sequence[int] = (DONE,),
         show: Callable[[float, str], None] | None = None) -> Call:
    """Calls the program with these arguments.

    show: gets the share that is done, 0 to 1, and a line of text, some times a second.
    Raises Error with the program's message and status where the status is none of those accepted. Ctrl-C interrupts
    the program, which writes its checkpoint, and then the caller.
    """
    command = [find(), *map(str, arguments)]
    terminal, theirs = (None, subprocess.PIPE) if show is None else os.openpty()  # a bar is for terminals only
    child = None
    try:
        try:
            # A session of its own: else a terminal's Ctrl-C would reach it twice, and the second ends it at once.
            with interrupts_later():
                child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=theirs,
                                         start_new_session=True)
        finally:
            if terminal is not None:
                os.close(theirs)
        out, err = listen(child, terminal, show)
    except BaseException as error:  # Ctrl-C, first of all
        if child is not None:
            child.send_signal(signal.SIGINT)
            child.wait()
        elif isinstance(error, OSError):
            raise Error(f"{command[0]} cannot be run ({error.strerror}): set CRADLE_PROGRAM to a program of this "
                        "machine", BAD_FILE) from None
        raise
    finally:
        if child is not None:
            child.stdout.close()
        if terminal is not None:
            os.close(terminal)
        elif child is not None:
            child.stderr.close()
    status = child.wait()
    messages = messages_in(err)
    if status in accepted:
        return Call(out, messages, status)
    said = messages.strip().removeprefix("cradle: ")
    raise Error(said or f"{' '.join(command[:2])} ended without a message (status {status}): "
                "run it in a terminal to see more", status if status >= 0 else 128 - status)


@contextlib.contextmanager
def interrupts_later():
    """Ctrl-C waits for the end of the block: one that came while a program is started would leave it running."""
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


def listen(child: subprocess.Popen, terminal: int | None, show) -> tuple[str, str]:
    """Standard output and error until both have ended."""
    errors = terminal if terminal is not None else child.stderr.fileno()
    texts = {child.stdout.fileno(): bytearray(), errors: bytearray()}
    with selectors.DefaultSelector() as waiting:
        for source in texts:
            waiting.register(source, selectors.EVENT_READ)
        while waiting.get_map():
            for key, _ in waiting.select():
                try:
                    piece = os.read(key.fd, 1 << 16)
                except OSError:  # a terminal whose other end is closed
                    piece = b""
                if not piece:
                    waiting.unregister(key.fd)
                    continue
                texts[key.fd] += piece
                if show is not None and key.fd == terminal:
                    tell(bytes(texts[key.fd][-4096:]), show)
    out, err = texts.values()
    return out.decode("utf-8", "replace"), err.decode("utf-8", "replace").replace("\r\n", "\n")


def tell(text: bytes, show: Callable[[float, str], None]) -> None:
    """The last bar that is drawn, if it is whole."""
    bars = [bar for bar in REDRAWN.split(text.decode("utf-8", "replace"))[1:] if "\n" not in bar]
    if bars and (bar := BAR.fullmatch(bars[-1])):
        width = bars[-1].index("]") - 1
        show(len(bar[1]) / width, bar[2])


def messages_in(text: str) -> str:
    """What stays of it on a terminal: bars that were drawn over are gone."""
    lines = (REDRAWN.split(line)[-1] for line in text.split("\n"))
    return "\n".join(lines)
