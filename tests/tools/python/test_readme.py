"""README's Python as it stands: every block is run, one after the other, beside a fig2.h5. test_manual.py does the same
for the pages of the manual."""
import os
import unittest

import cradle
import small

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")


def blocks(name):
    return [part.split("```", 1)[0] for part in small.read(os.path.join(ROOT, name)).split("```python\n")[1:]]


class Readme(unittest.TestCase):
    def test_every_block_runs(self):
        cradle.run("fig2").close()
        found = blocks("README.md")
        self.assertTrue(found)
        for text in found:
            with self.subTest(text):
                exec(compile(text, "README.md", "exec"), {})
