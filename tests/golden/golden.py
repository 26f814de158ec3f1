"""Compares the bits of results with golden.txt, for changes that are to keep them all.

  CRADLE_PROGRAM=PROGRAM /usr/bin/python3 golden.py [--part 1/2] [--against OTHER] [--write]

--part K/N checks every N-th row, from the K-th on. --against says in what results that differ are other than those of
the program OTHER. --write makes the checksums anew, of bits that change on purpose.
"""
import argparse
import hashlib
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

import h5py

HERE = pathlib.Path(__file__).resolve().parent
TABLE = HERE / "golden.txt"
WRITERS = ("run", "ensemble", "sweep", "merge", "certify", "trust", "threshold", "words")
LACKING = {"float128": "float128", "mpfr": r"mpfr|certify|trust|threshold|words|initial\.word"}  # in some builds
# Rows whose last digits are those of a library, which this was when they were made: arithmetic and roots.
OF_LIBRARY = {"Boost 1_74": "cpp_bin_float", "compiler: 12": "float128"}


def call(program, folder, *words):
    return subprocess.run([program, *words], cwd=folder, capture_output=True, text=True)


def run(program, row, folder):
    """Runs the commands of a row in a new folder that has the scenes; the last one, and all that was printed."""
    shutil.copytree(HERE, folder, ignore=shutil.ignore_patterns("golden.*"))
    printed = ""
    for command in row.split(" ; "):
        words, before = [], ""
        for word in shlex.split(command):
            words += ["--set"] * bool(re.match(r"[a-z_.]+(\[\d\])?=", word) and not before.startswith("--")) + [word]
            before = word
        if words[0] in (*WRITERS, "resume"):
            words += ["--quiet"]
        if words[0] in WRITERS and "-o" not in words:
            words += ["-o", "out.h5"]
        done = call(program, folder, *words)
        if words[0] != "trust":  # which prints how long its runs took
            printed += re.sub(r"\b[\d.]+ s\b", "", done.stdout)  # of computing
    return done, printed


def checksums(program, row):
    """The status of a row, checksums of the numbers (with names, types and shapes) and of the texts (those in
    attributes, and what is printed or exported) of its results, and its message if there is one."""
    with tempfile.TemporaryDirectory() as parent:
        folder = pathlib.Path(parent, "row")
        done, printed = run(program, row, folder)
        numbers, texts = hashlib.blake2b(digest_size=6), hashlib.blake2b(printed.encode(), digest_size=3)

        def add(name, item):
            if isinstance(item, h5py.Dataset):
                assert item.dtype != object, f"{name} holds pointers"
                numbers.update(f"{name} {item.dtype.str} {item.shape} ".encode() + item[()].tobytes())
            for key, value in item.attrs.items():
                if isinstance(value, str) or key in ("identity", "format_version"):
                    texts.update(f"{name}.{key} {value}\n".encode() if key != "cradle_version" else b"")
                else:
                    numbers.update(f"{name}.{key} {value.dtype.str} {value.shape} ".encode() + value.tobytes())

        for file in sorted(folder.rglob("*"), key=lambda file: (str(file.parent), file.name)):
            if file.suffix == ".h5":
                with h5py.File(file, locking=False) as result:
                    add("", result)
                    result.visititems(add)
            elif file.is_file() and file.parent != folder:
                texts.update(re.sub(rb"# cradle_version.*", b"", file.read_bytes()))
        return [str(done.returncode), numbers.hexdigest(), texts.hexdigest()], done.stderr


def difference(program, other, row):
    """What `cradle diff` says of the results of two programs."""
    with tempfile.TemporaryDirectory() as parent:
        for name, which in (("other", other), ("this", program)):
            run(which, row, pathlib.Path(parent, name))
        files = sorted(file.name for file in pathlib.Path(parent, "this").glob("*.h5"))
        return "".join(call(program, parent, "diff", f"other/{file}", f"this/{file}").stdout for file in files)


def uncovered(program, rows):
    """Keys of scenes, and the words that may stand for their values, that are in no row and in no scene here."""
    text = "\n".join([*rows, *(scene.read_text("utf-8") for scene in HERE.glob("*.toml"))])
    text = text.replace(" = ", "=").replace('"', "")
    for key, kind in re.findall(r"^(\S+)  \((.*)\)$", call(program, HERE, "scenes", "--keys").stdout, re.M):
        choices = re.sub("^(one of|list of texts) ", "", kind.split(",")[0]).split(" | ")
        for value in choices if len(choices) > 1 else ():
            if not re.search(rf"{key}=(\[[^\]]*\b)?{value}(?=[\s,\]]|$)", text):
                yield f"{key}={value}"
        if not re.search(rf"\b{key}(\.\w+)?=", text):
            yield key


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--part", default="1/1")
    parser.add_argument("--against")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    program = os.path.realpath(os.environ["CRADLE_PROGRAM"])
    first, step = map(int, options.part.split("/"))
    lines = TABLE.read_text("utf-8").splitlines()
    rows = {number: line.split(" ", 3) for number, line in enumerate(lines) if line and not line.startswith("#")}
    types = call(program, HERE, "--version").stdout
    left_out = "|".join(rows for name, rows in (LACKING | OF_LIBRARY).items() if name not in types) or "$^"
    wrong = []
    for number, (*expected, row) in list(rows.items())[first - 1::step]:
        if re.search(left_out, row):
            continue
        found, message = checksums(program, row)
        if found[0] == "2":
            wrong.append(f"golden.txt:{number + 1}: refused: {row}\n{message}")
        elif options.write:
            rows[number] = [*found, row]
            lines[number] = " ".join(rows[number])
        elif found != expected:
            what = " and ".join(name for name, a, b in zip(("status", "numbers", "texts"), found, expected) if a != b)
            wrong.append(f"golden.txt:{number + 1}: {what} differ ({' '.join(found)}): {row}\n{message}")
            if options.against:
                wrong.append(difference(program, os.path.realpath(options.against), row))
    if options.write:
        TABLE.write_text("\n".join(lines) + "\n", "utf-8")
    threads = {}
    for *sums, row in rows.values():
        threads.setdefault(re.sub(r" --threads \d+", "", row), []).append(sums)
    wrong += [f"other bits on other threads: {row}" for row, sums in threads.items() if sums != sums[:1] * len(sums)]
    wrong += [f"in no row: {missing}" for missing in uncovered(program, [row for *_, row in rows.values()])]
    if wrong:
        print("\n".join(wrong))
        print(f"{len(wrong)} mistakes. Bits that should have stayed: --against OTHER, a program that has them, says "
              "what differs. Bits that change on purpose: --write, and the commit says which and why.")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
