"""The notebooks are those of their scripts, and their cells run one after the other, without a display."""
import json
import unittest

import notebooks
import small


class Notebooks(unittest.TestCase):
    def test_scripts_and_notebooks_are_the_same(self):
        files = notebooks.FOLDER.glob("*.ipynb")
        self.assertEqual({path.stem: path.read_text("utf-8") for path in files},
                         {name: notebooks.notebook(name) for name in notebooks.NAMES},
                         "write them again with tools/python/notebooks.py")

    def test_every_cell_runs(self):
        for name in notebooks.NAMES:
            with self.subTest(name):
                if name.startswith("live_") and small.live():
                    self.skipTest(small.live())
                cells = json.loads(notebooks.notebook(name))["cells"]
                names = {}
                for k, cell in enumerate(cells):
                    text = "".join(cell["source"])
                    if cell["cell_type"] == "code":
                        exec(compile(text, f"{name}.ipynb, cell {k}", "exec"), names)
                    else:
                        self.assertNotIn("# %%", text)
