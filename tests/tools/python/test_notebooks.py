"""The notebooks are those of their scripts, and their cells run one after the other, without a display."""
import json
import os
import unittest

import cradle
import notebooks
from cradle import simulation

try:
    LIVE = bool(simulation.module())
except cradle.Error as error:
    LIVE, REASON = False, error.message


class Notebooks(unittest.TestCase):
    def test_scripts_and_notebooks_are_the_same(self):
        self.assertEqual(sorted(f"{name}.ipynb" for name in notebooks.NAMES),
                         sorted(name for name in os.listdir(notebooks.FOLDER) if name.endswith(".ipynb")))
        for name in notebooks.NAMES:
            with open(notebooks.path(name, ".ipynb"), encoding="utf-8") as file:
                self.assertEqual(file.read(), notebooks.from_script(name),
                                 f"{name}: write it again with tools/python/notebooks.py")

    def test_every_cell_runs(self):
        for name in notebooks.NAMES:
            with self.subTest(name):
                if name.startswith("live_") and not LIVE:
                    self.skipTest(REASON)
                with open(notebooks.path(name, ".ipynb"), encoding="utf-8") as file:
                    cells = json.load(file)["cells"]
                names = {}
                for k, cell in enumerate(cells):
                    text = "".join(cell["source"])
                    if cell["cell_type"] == "code":
                        exec(compile(text, f"{name}.ipynb, cell {k}", "exec"), names)
                    else:
                        self.assertNotIn("# %%", text)


if __name__ == "__main__":
    unittest.main()
