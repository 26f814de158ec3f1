"""Every scene of the package, at the size of tests/tools/run/small_scenes.txt, ends with the status that it is meant to
end with, and a report with all pictures is made of its result. They are drawn once, for a dark page:
test_pictures draws all kinds for light ones. A scene that is added needs a row there."""
import multiprocessing
import pathlib
import subprocess
import traceback
import unittest
from unittest import mock

import cradle
from cradle import program

TESTS = pathlib.Path(__file__).resolve().parents[1]
TABLE = TESTS / "run" / "small_scenes.txt"
SCENES = TESTS.parents[1] / "tools" / "scenes"


def made(line):
    """The command and what went wrong, if a result or its report cannot be made; else nothing."""
    status, *command = line.split()
    name = "-".join(command[:2]).replace("/", "-")
    run = subprocess.run([program.find(), *command, "--quiet", "--threads", "1", "-o", f"{name}.h5"],
                         capture_output=True, text=True)
    if run.returncode != int(status):
        return f"{line}: status {run.returncode}\n{run.stderr}"
    try:
        cradle.report(f"{name}.h5")
    except Exception:
        return f"{line}\n{traceback.format_exc()}"


class Scenes(unittest.TestCase):
    @mock.patch("cradle.page.page.SCHEMES", ("dark",))
    def test_all_have_pictures_and_a_report(self):
        lines = [line for line in TABLE.read_text("utf-8").splitlines() if not line.startswith("#")]
        with multiprocessing.Pool(2) as workers:
            self.assertEqual([wrong for wrong in workers.imap_unordered(made, lines) if wrong], [])
        self.assertEqual({line.split()[2] for line in lines},
                         {str(scene.relative_to(SCENES).with_suffix("")) for scene in SCENES.rglob("*.toml")})
