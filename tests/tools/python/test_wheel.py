"""`pip install` of the package into a clean environment beside Debian's h5py, without network."""
import importlib.util
import os
import shutil
import subprocess
import sys
import unittest

import cradle

SOURCE = os.path.dirname(os.path.dirname(os.path.abspath(cradle.__file__)))
NEEDED = ("pip", "setuptools", "wheel", "ensurepip")


def run(*words, **options):
    done = subprocess.run(words, capture_output=True, text=True, **options)
    assert done.returncode == 0, f"{' '.join(words)}:\n{done.stdout}{done.stderr}"
    return done.stdout


class Wheel(unittest.TestCase):
    def test_installs_and_runs_in_a_clean_environment(self):
        lacking = [name for name in NEEDED if importlib.util.find_spec(name) is None]
        if lacking:
            self.skipTest(f"no {', '.join(lacking)} (Debian: python3-pip, python3-setuptools, python3-wheel, "
                          "python3-venv)")
        shutil.copytree(SOURCE, "source", ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"))
        run(sys.executable, "-m", "venv", "--system-site-packages", "clean")
        python = os.path.abspath(os.path.join("clean", "bin", "python3"))
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        # Without the source tree around it the package is pure Python.
        run(python, "-m", "pip", "install", "--no-index", "--no-build-isolation", "./source", env=environment)
        code = ("import cradle, os; print(cradle.__file__, cradle.check('fig5')['run.until'],"
                "cradle.run('fig5', output='wheel.h5').outcome, os.path.exists(os.path.join(os.path.dirname("
                "cradle.__file__), 'py.typed')))")
        place, *said = run(python, "-c", code, env=environment).split(None, 1)
        self.assertIn(os.path.join("clean", "lib"), place)
        self.assertRegex(said[0], r"^[0-9.]+ reached the end True$")
        for data in ("cite.bib", "page/page.css", "microscope.js"):
            self.assertTrue(os.path.exists(os.path.join(os.path.dirname(place), data)), data)
