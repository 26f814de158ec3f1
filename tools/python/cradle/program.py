"""The program `cradle`: where it is, and calling it: what it prints, its message and its progress."""
from __future__ import annotations

import contextlib
import os
import selectors
import shutil
import signal
import socket
import subprocess
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from .errors import BAD_FILE, DONE, Error

WHERE = ((*[".."] * 3, "build", "release", "tools", "cradle"), (*[".."] * 4, "bin", "cradle"))  # from this package


def find() -> str:
    """The program: $CRADLE_PROGRAM, that of the build or installation that this package is of, or `cradle` on the path.

    Raises Error where there is none.
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
    ours, theirs = (None, None) if show is None else socket.socketpair()  # progress (tools/support/progress.hpp)
    extra = {} if theirs is None else {"pass_fds": [theirs.fileno()],
                                       "env": os.environ | {"CRADLE_PROGRESS_FD": str(theirs.fileno())}}
    child = None
    try:
        # A session of its own: else a terminal's Ctrl-C would reach it twice, and the second ends it at once.
        with interrupts_later():
            child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                     start_new_session=True, **extra)
        out, messages = listen(child, ours, show)
    except BaseException as error:  # Ctrl-C, first of all
        if child is not None:
            child.send_signal(signal.SIGINT)
            child.wait()
        elif isinstance(error, OSError):
            raise Error(f"{command[0]} cannot be run ({error.strerror}): set CRADLE_PROGRAM to a program of this "
                        "machine", BAD_FILE) from None
        raise
    finally:
        pipes = () if child is None else (child.stdout, child.stderr)
        for source in (*pipes, ours, theirs):
            if source is not None:
                source.close()
    status = child.wait()
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


def listen(child: subprocess.Popen, progress: socket.socket | None, show) -> tuple[str, str]:
    """Standard output and error until both have ended; lines of progress go to show(share, text)."""
    texts = {child.stdout: bytearray(), child.stderr: bytearray()}
    lines = b""
    with selectors.DefaultSelector() as waiting:
        for source in (*texts, *([progress] if progress is not None else [])):
            waiting.register(source, selectors.EVENT_READ)
        while any(source in waiting.get_map() for source in texts):
            for key, _ in waiting.select():
                piece = os.read(key.fd, 1 << 16)
                if not piece:
                    waiting.unregister(key.fileobj)
                elif key.fileobj is not progress:
                    texts[key.fileobj] += piece
                else:
                    *whole, lines = (lines + piece).split(b"\n")
                    for line in whole:
                        share, text = line.decode("utf-8", "replace").split("\t", 1)
                        show(float(share), text)
    out, err = texts.values()
    return out.decode("utf-8", "replace"), err.decode("utf-8", "replace")
