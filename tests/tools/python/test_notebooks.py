"""The notebooks are those of their scripts, and their cells run one after the other, without a display."""
import json
import os
import unittest

import notebooks
import small


class Notebooks(unittest.TestCase):
    def test_scripts_and_notebooks_are_the_same(self):
        self.assertEqual(sorted(f"{name}.ipynb" for name in notebooks.NAMES),
                         sorted(name for name in os.listdir(notebooks.FOLDER) if name.endswith(".ipynb")))
        for name in notebooks.NAMES:
            self.assertEqual(small.read(notebooks.path(name, ".ipynb")), notebooks.from_script(name),
                             f"{name}: write it again with tools/python/notebooks.py")

    def test_every_cell_runs(self):
        for name in notebooks.NAMES:
            with self.subTest(name):
                if name.startswith("live_") and small.live():
                    self.skipTest(small.live())
                cells = json.loads(small.read(notebooks.path(name, ".ipynb")))["cells"]
                names = {}
                for k, cell in enumerate(cells):
                    text = "".join(cell["source"])
                    if cell["cell_type"] == "code":
                        exec(compile(text, f"{name}.ipynb, cell {k}", "exec"), names)
                    else:
                        self.assertNotIn("# %%", text)
