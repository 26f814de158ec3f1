"""What the program runs: python -m cradle plot FILE [-o OUT] [--theory CSV], or report FILE [-o OUT].

Exit status: 0 done, 2 bad arguments, 4 a file could not be read or written. No display is needed.
"""
from __future__ import annotations

import argparse
import os
import sys

if not __package__:  # run as a folder, which then is no package yet
    sys.path[0] = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    __package__ = "cradle"
    import cradle  # noqa: F401

from cradle.errors import BAD_FILE, BAD_INPUT, Error  # noqa: E402


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Error(f"bad arguments ({message}): see {self.prog} --help", BAD_INPUT)


def main(words: list[str] | None = None) -> int:
    os.environ["MPLBACKEND"] = "Agg"
    parser = Parser(prog="cradle", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True, parser_class=Parser)
    for name, ending in (("plot", ".png"), ("report", ".html")):
        command = commands.add_parser(name)
        command.add_argument("file", metavar="FILE", help="result, or of a report FILE.part as well")
        command.add_argument("-o", dest="out", metavar="OUT", help=f"by default FILE with {ending}")
        if name == "plot":
            command.add_argument("--theory", metavar="CSV", help="predictions, as `cradle theory SCENE --csv` has them")
    try:
        options = parser.parse_args(words)
        (plot if options.command == "plot" else report)(options)
        sys.stdout.flush()
    except BrokenPipeError:  # nobody reads the names of what was made: `cradle plot FILE | head -1`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except Error as error:
        print(f"{parser.prog}: {error.message}", file=sys.stderr)
        return error.status
    except ImportError as error:
        print(f"{parser.prog}: {missing(error)}", file=sys.stderr)
        return BAD_FILE
    return 0


def plot(options) -> None:
    import cradle
    from cradle.drawing.theory import Theory
    from cradle.plot import saved
    out = options.out or os.path.splitext(options.file)[0] + ".png"
    paths = saved(cradle.open(options.file), out, Theory(options.theory) if options.theory else Theory())
    print(*paths, sep="\n")  # at the end: all are made before anybody can stop reading


def report(options) -> None:
    import cradle
    print(cradle.report(options.file, options.out))


def missing(error: ImportError) -> str:
    """A module that is not there is named with its Debian package."""
    name = (error.name or "matplotlib").split(".")[0]
    return f"Python module {name} is missing ({sys.executable}: {error}): install the Debian package python3-{name}"


if __name__ == "__main__":
    sys.exit(main())
