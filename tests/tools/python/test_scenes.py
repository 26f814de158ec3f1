"""Every scene of the package, at the size of tests/tools/run/small_scenes.txt, ends with the status that it is meant to
end with, and pictures and a report are made of its result. A scene that is added needs a row there."""
import contextlib
import multiprocessing
import os
import pathlib
import subprocess
import unittest

from cradle import __main__, program

TESTS = pathlib.Path(__file__).resolve().parents[1]
TABLE = TESTS / "run" / "small_scenes.txt"
SCENES = TESTS.parents[1] / "tools" / "scenes"


def made(line):
    """The command and what it printed, if a result, its pictures or its report cannot be made; else nothing."""
    status, *command = line.split()
    name = "-".join(command[:2]).replace("/", "-")
    run = subprocess.run([program.find(), *command, "--quiet", "--threads", "1", "-o", f"{name}.h5"],
                         capture_output=True, text=True)
    if run.returncode != int(status):
        return f"{line}: status {run.returncode}\n{run.stderr}"
    with open(f"{name}.err", "w+") as file, contextlib.redirect_stderr(file), contextlib.redirect_stdout(file):
        for make, output in (("plot", f"{name}.png"), ("report", f"{name}.html")):
            ended = __main__.main([make, f"{name}.h5", "-o", output])  # what it throws is a failure, too
            file.seek(0)
            printed = file.read()
            if ended or "Traceback" in printed or not os.path.getsize(output):
                return f"{line}: {make}, status {ended}\n{printed}"
    return ""


class Scenes(unittest.TestCase):
    def test_all_have_pictures_and_a_report(self):
        lines = [line for line in TABLE.read_text("utf-8").splitlines() if not line.startswith("#")]
        with multiprocessing.Pool(2) as workers:
            self.assertEqual([wrong for wrong in workers.imap_unordered(made, lines) if wrong], [])
        self.assertEqual({line.split()[2] for line in lines},
                         {str(scene.relative_to(SCENES).with_suffix("")) for scene in SCENES.rglob("*.toml")})
