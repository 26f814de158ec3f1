"""Whatever is wrong with a file is one cradle.Error of status 4 that names it and says what to do."""
import os
import shutil
import subprocess
import time
from unittest import mock

import h5py
import numpy as np

import cradle
import cradle.errors
import small
from cradle import program, simulation
from small import read, written


class Files(small.Case):
    def refused(self, path, wrong, call=cradle.open, **keys):
        error = super().refused(4, wrong, call, path, **keys)
        self.assertTrue(error.message.startswith(path), error.message)
        self.assertNotIn("\n", error.message)
        self.assertRegex(error.message, r"\): .*|: .*", "what to do")
        self.assertIsNone(error.__cause__)
        self.assertTrue(error.__suppress_context__ or error.__context__ is None, "a traceback from inside")

    def test_what_is_no_result(self):
        os.makedirs("folder.h5")
        os.mkfifo("pipe.h5")
        for path, wrong in (("nothing.h5", "No such file"), ("folder.h5", "directory"), ("pipe.h5", "FIFO or device"),
                            ("/dev/zero", "FIFO or device")):
            self.refused(path, wrong)
        for path, content, wrong in (("empty.h5", b"", "empty file"), ("foreign.h5", b"not HDF5 at all", "no HDF5"),
                                     ("head.h5", b"\x89HDF\r\n\x1a\n", "cannot be read|can be read")):
            self.refused(written(path, content), wrong)
        for path, about, wrong in (("other.h5", {}, "no result"),
                                   ("later.h5", {"format_version": 7, "scene": ""}, "later version"),
                                   ("earlier.h5", {"format_version": 1, "scene": ""}, "earlier version")):
            with h5py.File(path, "w") as file:
                file["x"] = [1.0, 2.0]
                file.attrs.update(about)
            self.refused(path, wrong)
        for call, made in ((cradle.plot.save, {"output": "foreign.png"}), (cradle.report, {})):
            self.refused("foreign.h5", "no HDF5", call, **made)
        for made in ("foreign.png", "foreign.html", "foreign.html.part"):
            self.assertFalse(os.path.exists(made))

    def test_every_damage_is_found(self):
        whole = read(small.shock(), "rb")
        for cut in [len(whole) * k // 16 for k in range(1, 16)] + [len(whole) - 1]:
            self.refused(written("cut.h5", whole[:cut]), "damaged|read")
        for place in range(8, len(whole) - 24, len(whole) // 37):  # the first eight bytes say that it is HDF5
            flipped = whole[:place] + bytes([whole[place] ^ 16]) + whole[place + 1:]
            self.refused(written("flipped.h5", flipped), "damaged")

    def test_damage_is_found_in_large_files_on_request(self):
        whole = bytearray(read(small.shock(), "rb"))
        whole[len(whole) // 2] ^= 1
        cradle.open(written("large.h5", whole), check=False).close()  # its length is right
        self.refused("large.h5", "damaged", check=True)

    def test_columns_of_a_closed_file(self):
        with cradle.open(small.shock()) as result:
            energy, other = result.series.energy, result.series
        for call in (lambda: energy.values, lambda: energy[3], lambda: other["time"].unit):
            super().refused(4, "", call)

    def test_pictures_of_a_result_that_lacks_groups(self):
        # Changed on purpose: h5py drops the seal, and what is missing is reported by name.
        shutil.copy(small.shock(), "lacking.h5")
        with h5py.File("lacking.h5", "r+") as file:
            del file["snapshots/0001/v"]
        with cradle.open("lacking.h5") as result:
            self.assertFalse(result.sealed)
            self.refused("lacking.h5", "lacks data", lambda _: cradle.plot.shock(result))

    def test_places_that_cannot_be_written(self):
        for call, of, output in ((cradle.run, "fig5", "no/such.h5"), (cradle.report, small.shock(), "no/such.html"),
                                 (cradle.plot.save, small.shock(), "no/such.png")):
            super().refused(4, "no/such", call, of, output=output)


class Arguments(small.Case):
    """Whatever is wrong with an argument is one cradle.Error, at once, that names it and speaks of Python."""

    def refused(self, wrong, call, *arguments, **keys):
        error = super().refused(2, wrong, call, *arguments, **keys)
        self.assertRegex(error.message, r"\(found .*\): |character 0")

    def test_of_simulations(self):
        sim = cradle.Simulation("collapse3")
        for wrong, call, *bad in (
                ("scene", cradle.Simulation, 5, None, b"fig2", ["fig2"]),
                ("threads:", lambda count: cradle.Simulation("fig2", threads=count), -1, 2 ** 40, 1.5, "two"),
                ("step: not a number of collisions", sim.step, -1, 1.5, "3", None),
                ("not a time", sim.advance, "soon", [1], float("inf"))):
            for argument in bad:
                self.refused(wrong, call, argument)
        for wrong, call, *arguments in (
                ("set:", cradle.Simulation, "fig2", 5), ("every: not a function", sim.every, 1, 3),
                ("every: too many calls", sim.every, 1e-300, print), ("every: no positive time", sim.every, 0, print),
                ("every: no positive", sim.every, -1, print), ("on_collision:", sim.on_collision, 5),
                ("save:", sim.save, 5), ("load:", cradle.Simulation.load, None)):
            self.refused(wrong, call, *arguments)
        self.refused("restitution:", cradle.Simulation, "collapse3", restitution=0.5)
        self.refused("initial.seed", cradle.Simulation, "collapse3", seed="")
        sim.step(2 ** 64)  # more than there are
        self.assertTrue(sim.over)
        self.refused("write:", sim.write, 5)

    @mock.patch.multiple(simulation, MOST_EVENTS=100, PART=7)
    def test_events_that_fill_the_memory_are_warned_of(self):
        whole, parts = (cradle.Simulation("fig2", small.SHOCK | {"output.events": events}) for events in (False, True))
        whole.advance()
        with self.assertWarnsRegex(RuntimeWarning, "events so far take .* GB of memory: .*on_collision"):
            parts.advance()
        self.assertEqual((parts.collisions, parts.decimals("energy"), parts.time),
                         (whole.collisions, whole.decimals("energy"), whole.time))

    def test_of_commands(self):
        endless = {"law": {}}
        endless["law"]["law"] = endless
        for wrong, call, *arguments in (
                ("scene", cradle.run, 5), ("scene", cradle.check, 5), ("set:", cradle.run, "fig2", 5),
                ("open", cradle.open, 5), ("character 0", cradle.run, "collapse3", {"title": "a\0b"}),
                ("resume", cradle.resume, 5), ("open", cradle.open, "a\0b"), ("set:", cradle.run, "fig2", {5: {}}),
                ("set:", cradle.run, "fig2", endless), ("set:", cradle.run, "fig2", {"initial.seed": 10 ** 5000}),
                ("scene", cradle.run, endless), ("scene", cradle.run, {"title": "\ud800"}),
                ("points:", cradle.sweep, "fig2", None, None), ("new:", cradle.new, None), ("new:", cradle.new, b"x"),
                *(("vary:", call, "fig2", bad) for call in (cradle.sweep, cradle.threshold) for bad in ("a=1", 5)),
                ("diff:", cradle.diff, 3, small.shock()), ("export:", cradle.export, 3, "csv")):
            self.refused(wrong, call, *arguments, **{"points": 5} if wrong == "points:" else {})
        super().refused(2, "rtol: nothing is given", cradle.diff, small.shock(), small.shock(), rtol="")
        self.refused("output", cradle.run, "collapse3", output=5)
        self.refused("output", cradle.report, small.shock(), output=5)
        with cradle.open(small.shock()) as result:
            for time in (None, float("nan"), "soon"):
                self.refused("at: not a time", result.snapshots.at, time, "nearest")
            self.assertEqual(result.snapshots.at("20").time, 20)
        for force in ("x", 1.5, -1, np.True_):
            cradle.run("collapse3", {"law.restitution": 0.05}, output="forced.h5", force=force).close()
            cradle.run("collapse3", {"law.restitution": 0.06}, output="forced.h5", force=force).close()
        cradle.run("collapse3", {"law.restitution": 0.06}, output="forced.h5", force=None).close()
        self.refused(r"run: no such argument \(found restitution\): .*set={'law.restitution'", cradle.run, "fig2",
                     restitution=0.9)

    def test_messages_name_arguments(self):
        other = {"scene": "collapse3", "set": {"law.restitution": 0.06}}
        cradle.run("collapse3", output="other.h5").close()
        live = cradle.Simulation(**other)
        live.advance()
        for call in (lambda: cradle.run(**other, output="other.h5"), lambda: live.write("other.h5")):
            error = super().refused(2, "give another output, or force=True", call)
            self.assertNotIn("--", error.message)
        cradle.run(**other, output="other.h5", force=True).close()
        self.refused(r"^set law.restitution: out of range \(found 7\)", cradle.run, "collapse3", {"law.restitution": 7})
        self.assertEqual(cradle.errors.in_python("`cradle run --force`, or --until"), "`cradle run --force`, or until")


class InProgress(small.Case):
    def start(self, *words):
        """A call of the program that is ended with the test."""
        running = subprocess.Popen([program.find(), *words], stderr=subprocess.DEVNULL)
        self.addCleanup(running.wait)
        self.addCleanup(running.terminate)
        return running

    def test_of_a_run_what_is_recorded_so_far(self):
        keys = small.ENDLESS | {"initial.particles": 200_000, "run.until": "1e7", "output.series.every": 1}
        running = self.start("run", "cooling", "-o", "way.h5", "--quiet", "--threads", "1", *small.set_words(keys))
        while running.poll() is None:
            time.sleep(0.05)
            try:
                with cradle.open("way.h5.part") as result:
                    if len(result.series.get("time", ())) < 2:
                        continue
                    self.assertTrue(result.in_progress)
                    self.assertEqual(result.outcome, "in progress")
                    self.assertLess(result.series.time[-1], 1e7)
                    page = cradle.report(result, "way.html")
                    self.assertEqual(program.call(["plot", "way.h5.part"]).stdout.split()[0], "way.png")
                    break
            except cradle.Error as error:  # not there yet, or over
                self.assertEqual(error.status, 4)
        else:
            self.fail("the run has ended")
        self.assertIn("in progress", read(page))

    def test_journals_of_replicas_and_checkpoints_are_named(self):
        running = self.start("ensemble", "fig2", "--replicas", "1000000000", "-o", "a.h5")
        while not os.path.exists("a.h5.part") and running.poll() is None:
            time.sleep(0.01)
        running.terminate()
        running.wait()
        written("a.h5.checkpoint", b"CRADLEC4" + bytes(100))
        written("b.h5.part", b"CRADLER2" + bytes(100))
        written("half.h5.part", b"CRADLEJ4" + bytes(5))
        for name, wrong in (("a.h5.part", "resume a.h5"), ("a.h5.checkpoint", "checkpoint"),
                            ("b.h5.part", "found format 2, here 4"), ("half.h5.part", "half.h5.part")):
            self.refused(4, wrong, cradle.open, name)
