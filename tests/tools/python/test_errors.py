"""Whatever is wrong with a file is one cradle.Error of status 4 that names it and says what to do."""
import os
import shutil
import subprocess
import time
import unittest

import h5py

import cradle
import cradle.errors
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


class Arguments(unittest.TestCase):
    """Whatever is wrong with an argument is one cradle.Error, at once, that names it and speaks of Python."""

    def refused(self, wrong, call):
        with self.assertRaises(cradle.Error) as raised:
            call()
        self.assertEqual(raised.exception.status, 2, raised.exception.message)
        self.assertRegex(raised.exception.message, wrong)
        self.assertRegex(raised.exception.message, r"\(found .*\): |character 0")

    def test_of_simulations(self):
        sim = cradle.Simulation("collapse3")
        for wrong, call in (
                ("scene", lambda: cradle.Simulation(5)), ("scene", lambda: cradle.Simulation(None)),
                ("scene", lambda: cradle.Simulation(b"fig2")), ("scene", lambda: cradle.Simulation(["fig2"])),
                ("set:", lambda: cradle.Simulation("fig2", 5)),
                *(("threads:", lambda n=n: cradle.Simulation("fig2", threads=n)) for n in (-1, 2 ** 40, 1.5, "two")),
                ("restitution:", lambda: cradle.Simulation("collapse3", restitution=0.5)),
                *(("step:", lambda n=n: sim.step(n)) for n in (-1, 1.5, "3", None)),
                ("a time", lambda: sim.advance("soon")), ("a time", lambda: sim.advance([1])),
                ("every: not a function", lambda: sim.every(1, 3)), ("on_collision:", lambda: sim.on_collision(5)),
                ("every: too many calls", lambda: sim.every(1e-300, print)),
                ("every: no positive", lambda: sim.every(0, print)),
                ("every: no positive", lambda: sim.every(-1, print)),
                ("save:", lambda: sim.save(5)), ("load:", lambda: cradle.Simulation.load(None))):
            self.refused(wrong, call)
        sim.step(2 ** 64)  # more than there are
        self.assertTrue(sim.over)
        self.refused("write:", lambda: sim.write(5))

    def test_events_that_fill_the_memory_are_warned_of(self):
        from cradle import simulation
        self.addCleanup(setattr, simulation, "MOST_EVENTS", simulation.MOST_EVENTS)
        self.addCleanup(setattr, simulation, "PART", simulation.PART)
        simulation.MOST_EVENTS, simulation.PART = 100, 7
        whole, parts = (cradle.Simulation("fig2", small.SHOCK | {"output.events": events}) for events in (False, True))
        whole.advance()
        with self.assertWarnsRegex(RuntimeWarning, "events so far take .* GB of memory: .*on_collision"):
            parts.advance()
        self.assertEqual((parts.collisions, parts.decimals("energy"), parts.time),
                         (whole.collisions, whole.decimals("energy"), whole.time))

    def test_of_commands(self):
        for wrong, call in (
                ("scene", lambda: cradle.run(5)), ("scene", lambda: cradle.check(5)),
                ("set:", lambda: cradle.run("fig2", 5)),
                ("output", lambda: cradle.run("collapse3", output=5)), ("open", lambda: cradle.open(5)),
                ("character 0", lambda: cradle.run("collapse3", {"title": "a\0b"})),
                ("resume", lambda: cradle.resume(5))):
            self.refused(wrong, call)

    def test_messages_name_arguments(self):
        cradle.run("collapse3", output="other.h5").close()
        for call in (lambda: cradle.run("collapse3", {"law.restitution": 0.06}, output="other.h5"),
                     lambda: live.write("other.h5")):
            live = cradle.Simulation("collapse3", {"law.restitution": 0.06})
            live.advance()
            with self.assertRaisesRegex(cradle.Error, "give another output, or force=True") as raised:
                call()
            self.assertNotIn("--", raised.exception.message)
        cradle.run("collapse3", {"law.restitution": 0.06}, output="other.h5", force=True).close()
        with self.assertRaisesRegex(cradle.Error, r"^set law.restitution: out of range \(found 7\)"):
            cradle.run("collapse3", {"law.restitution": 7})
        self.assertEqual(cradle.errors.in_python("`cradle run --force`, or --until"), "`cradle run --force`, or until")

    def test_pipes_and_devices_are_no_results(self):
        os.mkfifo("pipe.h5")
        for path in ("pipe.h5", "/dev/zero", "a\0b"):
            with self.assertRaises(cradle.Error) as raised:
                cradle.open(path)
            self.assertEqual(raised.exception.status, 4)


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
