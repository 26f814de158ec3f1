"""Every kind of picture, of the small runs of pictures.txt: made without a display, as PNG and as SVG, and by another
Python with the same bytes: as SVG, which has every number that is drawn, and the first kind as PNG too. The contents of
a file decide which pictures it has: the names that are printed are those of pictures.txt."""
import os
import re
import shlex
import unittest

import small
from cradle import program


def kinds():
    """Of each kind: its name, the names of pictures beside the main one, the words of its command and its status."""
    with open(os.path.join(os.path.dirname(__file__), "pictures.txt"), encoding="utf-8") as file:
        for part in re.sub("(?m)^#.*\n", "", file.read()).strip().split("\n\n"):
            head, command = part.strip().split("\n", 1)
            status, name, *others = head.split()
            yield name, others, shlex.split(command.replace("\\\n", ""))[1:], int(status)


class Pictures(unittest.TestCase):
    def test_are_made_twice_the_same(self):
        once, again, names = [], [], []
        for name, others, words, status in kinds():
            program.call([*words, "--quiet", "-o", f"{name}.h5"], accepted=(status,))
            for extension in (".png", ".svg"):
                once.append(["plot", f"{name}.h5", "-o", name + extension])
                names += [name + end + extension for end in ("", *(f"-{other}" for other in others))]
            again += once[-2 if len(once) == 2 else -1:]
        self.assertEqual(small.python_again(once).splitlines(), names)
        pictures = {name: small.read(name, "rb") for name in names}
        for name, picture in pictures.items():
            self.assertTrue(picture.startswith(b"\x89PNG\r" if name.endswith(".png") else b"<?xml"), name)
            self.assertGreater(len(picture), 10000, name)
        made_again = small.python_again(again).splitlines()
        self.assertEqual(made_again, [name for name in names if name.endswith(".svg") or name in made_again])
        for name in made_again:
            self.assertEqual(small.read(name, "rb"), pictures[name], name)
        # As by the program.
        call = program.call(once[0])
        self.assertEqual((call.stdout.splitlines(), call.stderr), (made_again[:len(call.stdout.splitlines())], ""))
        for name in call.stdout.splitlines():
            self.assertEqual(small.read(name, "rb"), pictures[name], name)
