"""The manual's pages, as they stand: every command and every example is run, page by page, each page in a folder of its
own, and prints what the page says it prints. Of README, the Python and the commands marked `console`.

    ```sh, ```python             is run; after `<!-- status: 3 -->` commands have to end with that status
    ```LANGUAGE title="NAME"     is written to the file NAME
    ```text                      the next block after one that was run, in the same section: its lines are in the
                                 output, in this order; `...` stands for anything
    <!-- not run: REASON -->     the block below is left alone
"""
import contextlib
import glob
import importlib.util
import io
import os
import re
import subprocess
import sys
import tempfile
import unittest
from collections import namedtuple

import matplotlib.pyplot as plt

import small

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")
MOST_NOT_RUN = 12  # of some hundred blocks

BLOCK = re.compile(r"(?:^<!-- (?P<mark>not run|status): (?P<said>.+?) -->\n)?"
                   r"^```(?P<language>\w+)(?: title=\"(?P<title>[^\"]+)\")?\n(?P<text>.*?)^```$", re.M | re.S)
Block = namedtuple("Block", [*BLOCK.groupindex, "begin", "end"])


def blocks(page):
    """The blocks of a page, and the page."""
    whole = small.read(page)
    found = [Block(**block.groupdict(""), begin=block.start(), end=block.end()) for block in BLOCK.finditer(whole)]
    return found, whole


def pages():
    return sorted(glob.glob(os.path.join(ROOT, "tools", "manual", "*.md")))


def missing(expected, output):
    """The first line of a page that the output does not have where it should; None if it has all."""
    left = iter(line.rstrip() for line in output.splitlines())
    for line in filter(None, map(str.rstrip, expected.splitlines())):
        pattern = ".*".join(map(re.escape, line.split("...")))
        if not any(re.fullmatch(pattern, found) for found in left):
            return line
    return None


class Manual(unittest.TestCase):
    def setUp(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        self.enterContext(contextlib.chdir(folder))
        self.addCleanup(plt.close, "all")
        programs = os.path.join(folder, ".programs")
        os.mkdir(programs)
        os.symlink(sys.executable, os.path.join(programs, "python3"))
        os.symlink(os.environ["CRADLE_PROGRAM"], os.path.join(programs, "cradle"))
        self.environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}", "CRADLE_PYTHON": sys.executable}

    def commands(self, block):
        status = int(block.said) if block.mark == "status" else 0
        run = subprocess.run(["bash", "-euo", "pipefail", "-c", block.text], env=self.environment, text=True,
                             stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        self.assertEqual(run.returncode, status, run.stdout)
        return run.stdout

    def python(self, block):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(block.text, "manual", "exec"), {"__name__": "__main__"})
        return printed.getvalue()

    def page(self, page):
        found, whole = blocks(page)
        output, end = None, 0
        for block in found:
            if block.title:
                small.written(block.title, block.text.encode())
            if block.language == "text" and output is not None and "\n#" not in whole[end:block.begin]:
                with self.subTest(said=block.text):
                    self.assertIsNone(missing(block.text, output), f"is not printed; this is:\n{output}")
            output = None
            if block.title or block.language not in ("sh", "python") or block.mark == "not run":
                continue
            if "cradle.Simulation" in block.text and small.live():
                continue
            if not importlib.util.find_spec("pandas"):
                block = block._replace(text=re.sub(".*to_pandas.*\n", "", block.text))
            with self.subTest(block.text):
                output = self.commands(block) if block.language == "sh" else self.python(block)
            end = block.end

    def of_readme(self, language):
        found = [block for block in blocks(os.path.join(ROOT, "README.md"))[0] if block.language == language]
        self.assertTrue(found)
        return found

    def test_python_of_readme(self):
        for block in self.of_readme("python"):
            with self.subTest(block.text):
                self.python(block)

    def test_commands_of_readme(self):
        for block in self.of_readme("console"):
            self.commands(block)
        for made in ("fig2.h5", "fig2.png", "theory.txt", "fig4.h5", "keys.txt"):
            self.assertTrue(os.path.exists(made), made)

    def test_blocks_that_are_not_run_are_few_and_say_why(self):
        marked = [block for page in pages() for block in blocks(page)[0] if block.mark == "not run"]
        self.assertLessEqual(len(marked), MOST_NOT_RUN)
        for block in marked:
            self.assertGreater(len(block.said.split()), 2, block.text)

    def test_every_block_is_read(self):
        for page in pages():
            found, whole = blocks(page)
            self.assertEqual(len(re.findall("^```", whole, re.M)), 2 * len(found), page)
            known = {"sh", "python", "toml", "text", "cpp", "csv", "julia"}
            self.assertEqual({block.language for block in found} - known, set(), page)


for path in pages():
    name = os.path.basename(path)[:-3].replace("-", "_").lower()
    setattr(Manual, f"test_page_{name}", lambda self, path=path: self.page(path))
