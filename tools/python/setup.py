"""`pip install .`: the package, with its compiled module where CMake, a C++ compiler and what the program is built from
are found. It is made in the build tree of the program, so that after tools/quickstart.sh little is left to compile.
Without them, or outside of the source tree, the package is pure Python; only live simulations are missing then.
"""
import os
import shutil
import subprocess
import sys
import sysconfig

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

TREE = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
BUILD = os.path.join(TREE, "build", "release")
TARGET = "cradle_module"
MADE = os.path.join(BUILD, "tools", "_live" + sysconfig.get_config_var("EXT_SUFFIX"))


class BuildModule(build_ext):
    def build_extension(self, extension):
        subprocess.run(["cmake", "--build", BUILD, "--target", TARGET, "--parallel", str(os.cpu_count())], check=True)
        path = self.get_ext_fullpath(extension.name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        shutil.copy(MADE, path)


def has_module():
    """Whether the build tree has the module for this Python, after configuring it if it has not been made yet."""
    if not (shutil.which("cmake") and os.path.exists(os.path.join(TREE, "CMakePresets.json"))):
        return False
    if os.path.exists(MADE):
        return True
    python = getattr(sys, "_base_executable", sys.executable)  # an environment may be gone at the next build
    words = ["cmake", "--preset", "release", f"-DPython_EXECUTABLE={python}"]
    if not os.path.exists(os.path.join(BUILD, "CMakeCache.txt")):
        words += ["-DCRADLE_TESTS=OFF", "-DCRADLE_BENCH=OFF"]
        words += [] if shutil.which("ninja") else ["-G", "Unix Makefiles"]
    if subprocess.run(words, cwd=TREE, stdout=subprocess.DEVNULL).returncode != 0:
        return False
    listed = subprocess.run(["cmake", "--build", BUILD, "--target", "help"], capture_output=True, text=True).stdout
    return TARGET in listed


if has_module():
    setup(ext_modules=[Extension("cradle._live", [])], cmdclass={"build_ext": BuildModule})
else:
    print("cradle: without the compiled module (no CMake, compiler, pybind11 or source tree)", file=sys.stderr)
    setup()
