"""README's Python, and the manual's, as they stand: every block is run, one after the other, beside a fig2.h5. Lines
for pandas are left out where it is not installed."""
import importlib.util
import os
import re
import unittest

import cradle
import small

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")


def blocks(name):
    return [part.split("```", 1)[0] for part in small.read(os.path.join(ROOT, name)).split("```python\n")[1:]]


class Readme(unittest.TestCase):
    def test_every_block_runs(self):
        cradle.run("fig2").close()
        found = blocks("README.md") + blocks("tools/README.md")
        self.assertGreaterEqual(len(found), 3)
        if not importlib.util.find_spec("pandas"):
            found = [re.sub(".*to_pandas.*\n", "", text) for text in found]
        for text in found:
            if "cradle.Simulation" in text and small.live():
                continue
            with self.subTest(text):
                exec(compile(text, "README.md", "exec"), {})
