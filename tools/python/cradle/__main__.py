"""The program runs this: python -m cradle plot FILE -o OUT [--force], or report FILE -o OUT [--force].

Exit status: 0 done, 2 bad arguments, 4 a file could not be read or written. No display is needed.
"""
from __future__ import annotations

import os
import sys
import warnings

if not __package__:  # run as a folder, which then is no package yet
    sys.path[0] = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    __package__ = "cradle"

import cradle  # noqa: E402
from cradle.errors import BAD_FILE, BAD_INPUT, Error  # noqa: E402


def main(words: list[str]) -> int:
    os.environ["MPLBACKEND"] = "Agg"
    warnings.filterwarnings("ignore", module=r"(cradle\.drawing|matplotlib|numpy)\b")  # of data too few for a picture
    try:
        if (len(words) < 4 or words[0] not in ("plot", "report") or words[2] != "-o"
                or words[4:] not in ([], ["--force"])):
            raise Error(f"bad arguments ({' '.join(words)}): give plot or report, FILE, -o and OUT", BAD_INPUT)
        command, file, _, output = words[:4]
        force = len(words) == 5
        made = (cradle.plot.save(file, output, force=force) if command == "plot"
                else [cradle.report(file, output, force=force)])
        with open(1, "wb", closefd=False) as out:  # at the end: all are made before anybody can stop reading
            out.write(b"".join(os.fsencode(path) + b"\n" for path in made))
    except BrokenPipeError:  # nobody reads the names of what was made: `cradle plot FILE | head -1`
        pass
    except OSError:
        print("cradle: standard output cannot be written: check where it goes, a full disk or a program that has ended",
              file=sys.stderr)
        return BAD_FILE
    except Error as error:
        print(f"cradle: {error}", file=sys.stderr)
        return error.status
    except ImportError as error:
        name = (error.name or "matplotlib").split(".")[0]
        print(f"cradle: Python module {name} is missing ({sys.executable}: {error}): install the Debian package "
              f"python3-{name}", file=sys.stderr)
        return BAD_FILE
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
