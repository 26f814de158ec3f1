"""run.py FILE: the unittest cases of a file test_*.py, or a script as it is. Status 77 where all cases were skipped."""
import importlib
import os
import runpy
import sys
import unittest

name = os.path.basename(sys.argv[1])
if not name.startswith("test_"):
    sys.argv = sys.argv[1:]
    runpy.run_path(sys.argv[0], run_name="__main__")
    sys.exit(0)
cases = unittest.defaultTestLoader.loadTestsFromModule(importlib.import_module(name.removesuffix(".py")))
result = unittest.TextTestRunner(sys.stdout, verbosity=2).run(cases)
assert result.testsRun > 0, "no cases found"
sys.exit(1 if not result.wasSuccessful() else 77 if len(result.skipped) == result.testsRun else 0)
