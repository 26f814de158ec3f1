"""Whatever is wrong with a file is one cradle.Error of status 4 that names it and says what to do."""
import os
import shutil
import subprocess
import time
import unittest

import h5py

import cradle
import small
from cradle import program


class Files(unittest.TestCase):
    def refused(self, path, wrong, read=cradle.open):
        with self.assertRaises(cradle.Error) as raised:
            read(path)
        error = raised.exception
        self.assertEqual(error.status, 4, error.message)
        self.assertRegex(error.message, wrong)
        self.assertTrue(error.message.startswith(path), error.message)
        self.assertNotIn("\n", error.message)
        self.assertRegex(error.message, r"\): .*|: .*", "what to do")
        self.assertIsNone(error.__cause__)
        self.assertTrue(error.__suppress_context__ or error.__context__ is None, "a traceback from inside")

    def test_missing_foreign_and_empty_files_and_folders(self):
        os.makedirs("folder.h5", exist_ok=True)
        for name, content in (("empty.h5", b""), ("foreign.h5", b"not HDF5 at all"), ("head.h5", b"\x89HDF\r\n\x1a\n")):
            with open(name, "wb") as file:
                file.write(content)
        self.refused("nothing.h5", "No such file")
        self.refused("folder.h5", "directory")
        self.refused("empty.h5", "empty file")
        self.refused("foreign.h5", "no HDF5")
        self.refused("head.h5", "cannot be read|can be read")

    def test_hdf5_files_of_others(self):
        with h5py.File("other.h5", "w") as file:
            file["x"] = [1.0, 2.0]
        self.refused("other.h5", "no result")
        with h5py.File("later.h5", "w") as file:
            file.attrs["format_version"], file.attrs["scene"] = 7, ""
        self.refused("later.h5", "later version")
        with h5py.File("earlier.h5", "w") as file:
            file.attrs["format_version"], file.attrs["scene"] = 1, ""
        self.refused("earlier.h5", "earlier version")

    def test_every_damage_is_found(self):
        with open(small.shock(), "rb") as file:
            whole = file.read()
        cuts = [len(whole) * k // 16 for k in range(1, 16)] + [len(whole) - 1]
        for cut in cuts:
            with open("cut.h5", "wb") as file:
                file.write(whole[:cut])
            self.refused("cut.h5", "damaged|read")
        for place in range(8, len(whole), len(whole) // 37):  # the first eight bytes say that it is HDF5
            with open("flipped.h5", "wb") as file:
                file.write(whole[:place] + bytes([whole[place] ^ 16]) + whole[place + 1:])
            if place < len(whole) - 24:
                self.refused("flipped.h5", "damaged")

    def test_damage_is_found_in_large_files_on_request(self):
        with open(small.shock(), "rb") as file:
            whole = bytearray(file.read())
        whole[len(whole) // 2] ^= 1
        with open("large.h5", "wb") as file:
            file.write(whole)
        cradle.open("large.h5", check=False).close()  # its length is right
        self.refused("large.h5", "damaged", lambda path: cradle.open(path, check=True))

    def test_columns_of_a_closed_file(self):
        with cradle.open(small.shock()) as result:
            energy, other = result.series.energy, result.series
        for read in (lambda: energy.values, lambda: energy[3], lambda: other["time"].unit):
            with self.assertRaises(cradle.Error) as raised:
                read()
            self.assertEqual(raised.exception.status, 4)

    def test_pictures_and_reports_of_what_is_no_result(self):
        with open("junk.h5", "w") as file:
            file.write("junk")
        self.refused("junk.h5", "no HDF5", lambda path: cradle.plot.save(path, "junk.png"))
        self.refused("junk.h5", "no HDF5", lambda path: cradle.report(path))
        for made in ("junk.png", "junk.html", "junk.html.part"):
            self.assertFalse(os.path.exists(made))

    def test_pictures_of_a_result_that_lacks_groups(self):
        # Changed on purpose: h5py drops the seal, and what is missing is reported by name.
        shutil.copy(small.shock(), "lacking.h5")
        with h5py.File("lacking.h5", "r+") as file:
            del file["snapshots/0001/v"]
        with cradle.open("lacking.h5") as result:
            self.assertFalse(result.sealed)
            self.refused("lacking.h5", "lacks data", lambda _: cradle.plot.shock(result))


class InProgress(unittest.TestCase):
    def test_of_a_run_what_is_recorded_so_far(self):
        keys = small.ENDLESS | {"initial.particles": 200_000, "run.until": "1e7", "output.series.every": 1}
        words = [word for key, value in keys.items() for word in ("--set", f"{key}={value}")]
        running = subprocess.Popen([program.find(), "run", "cooling", "-o", "way.h5", "--quiet", *words])
        try:
            while running.poll() is None:
                try:
                    with cradle.open("way.h5.part") as result:
                        if len(result.series.get("time", ())) < 2:
                            continue
                        self.assertTrue(result.in_progress)
                        self.assertEqual(result.outcome, "in progress")
                        self.assertLess(result.series.time[-1], 1e7)
                        page = cradle.report(result, "way.html")
                        pictures = subprocess.run([program.find(), "plot", "way.h5.part"], capture_output=True,
                                                  text=True, check=True).stdout.split()
                        self.assertEqual(pictures[0], "way.png")
                        break
                except cradle.Error as error:  # not there yet, or over
                    self.assertEqual(error.status, 4)
            else:
                self.fail("the run has ended")
        finally:
            running.terminate()
            running.wait()
        with open(page, encoding="utf-8") as file:
            self.assertIn("in progress", file.read())

    def test_journals_of_replicas_and_checkpoints_are_named(self):
        running = subprocess.Popen([program.find(), "ensemble", "fig2", "--replicas", "1000000000", "-o", "a.h5"],
                                   stderr=subprocess.DEVNULL)
        while not os.path.exists("a.h5.part") and running.poll() is None:
            time.sleep(0.01)
        running.terminate()
        running.wait()
        for name, begin, wrong in (("a.h5.part", None, "resume a.h5"), ("a.h5.checkpoint", b"CRADLEC4", "checkpoint"),
                                   ("b.h5.part", b"CRADLER2", "found format 2, here 4")):
            if begin:
                with open(name, "wb") as file:
                    file.write(begin + bytes(100))
            with self.assertRaisesRegex(cradle.Error, wrong):
                cradle.open(name)

    def test_half_written_journals(self):
        with open("half.h5.part", "wb") as file:
            file.write(b"CRADLEJ4" + bytes(5))
        with self.assertRaises(cradle.Error) as raised:
            cradle.open("half.h5.part")
        self.assertEqual(raised.exception.status, 4)
        self.assertIn("half.h5.part", raised.exception.message)
