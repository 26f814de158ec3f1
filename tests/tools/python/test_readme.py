"""README's Python as it stands: every block is run, one after the other, beside a fig2.h5. test_manual.py does the same
for the pages of the manual."""
import os
import unittest

import cradle

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")


def blocks(name):
    with open(os.path.join(ROOT, name), encoding="utf-8") as file:
        return [part.split("```", 1)[0] for part in file.read().split("```python\n")[1:]]


class Readme(unittest.TestCase):
    def test_every_block_runs(self):
        cradle.run("fig2").close()
        found = blocks("README.md")
        self.assertGreaterEqual(len(found), 2)
        for text in found:
            with self.subTest(text):
                exec(compile(text, "README.md", "exec"), {})
