"""Pictures and a report are made of every scene of the package, at the size of tests/tools/run/small_scenes.txt."""
import contextlib
import multiprocessing
import os
import subprocess
import unittest

from cradle import __main__, program

TABLE = os.path.join(os.path.dirname(__file__), "..", "run", "small_scenes.txt")


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
        with open(TABLE, encoding="utf-8") as file:
            lines = [line for line in file if not line.startswith("#")]
        with multiprocessing.Pool(2) as workers:
            self.assertEqual([wrong for wrong in workers.imap_unordered(made, lines) if wrong], [])
        self.assertGreater(len(lines), 30)
