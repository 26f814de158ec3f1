"""cradle.Simulation: the bytes of `cradle run` however a run is advanced, stopped, saved and loaded, in every scalar
type; its state is that of snapshots; functions are called when they should be, their exceptions and Ctrl-C arrive and
change nothing; other threads run; nothing is kept alive."""
import copy
import filecmp
import gc
import itertools
import os
import pickle
import shutil
import signal
import sys
import tempfile
import threading
import time
import unittest
import warnings
import weakref
from unittest import mock

import cradle
import numpy as np
import small
from cradle import compiled, program

if small.live():
    raise unittest.SkipTest(small.live())

EVENTS = {"output.events": True}
WIDE = {"initial.particles": 40, "run.until": 12, "output.snapshots": [5, 12], "output.profiles.times": [],
        "output.series.points": 7, **EVENTS}
# A name for each scene: the bundled one, and its settings.
SCENES = {
    "events": ("fig2", small.SHOCK | EVENTS),
    "segments": ("fig2", {"initial.particles": 4000, "run.until": 600, "output.snapshots": [300]}),
    "positions": ("fig2", small.SHOCK | {"run.coordinates": "absolute", "run.precision": "long double"}),
    "wet": ("fig6", {"initial.particles": 200, "run.until": 40}),
    "sticky": ("cooling", {"initial.particles": 200, "run.until": 40}),
    "collapse": ("collapse3", {}),
    "walls": ("classics/heat_conduction", {"run.until": 800, "output.series.every": 100, "output.averages.from": 100,
                                           "output.histograms": ["closing_speed", "gap"],
                                           "output.counting.every": 10}),
    "gravity": ("classics/heat_conduction", {"run.until": 50, "gravity.acceleration": -0.1, "output.series.every": 5,
                                             "output.averages": {}}),
    "double-double": ("fig2", WIDE | {"run.precision": "double-double"}),
    "mpfr": ("fig2", WIDE | {"run.precision": "mpfr", "run.digits": 50}),
    "float128": ("fig2", WIDE | {"run.precision": "float128"}),
    "cpp_bin_float": ("fig2", WIDE | {"run.precision": "cpp_bin_float"}),
}


def shock(**more):
    return cradle.Simulation("fig2", set=small.SHOCK | more)


class Files(small.Case):
    def test_a_run_that_is_stopped_can_be_written(self):
        sim = shock(**EVENTS)
        sim.every(30, mock.Mock(side_effect=KeyboardInterrupt))
        with self.assertRaises(KeyboardInterrupt):
            sim.advance()
        self.refused(2, "not at its end .*stop the run here", sim.write, "stopped.h5")
        sim.stop()
        self.assertEqual(sim.outcome, "interrupted")
        with sim.write("stopped.h5") as stopped, cradle.open(small.shock()) as whole:
            self.assertEqual(stopped.outcome, "interrupted")
            for name in stopped.events:
                found = stopped.events[name].values
                np.testing.assert_array_equal(found, whole.events[name].values[:len(found)])
            self.assertEqual(len(stopped.events.left), sim.collisions)
            recorded = len(stopped.series.time)
            self.assertLess(0, recorded)
            np.testing.assert_array_equal(stopped.series.energy.values, whole.series.energy.values[:recorded])
            self.assertEqual([table.attributes["time"] for table in stopped.snapshots], [20])
        for call in (sim.stop, sim.advance):
            self.refused(2, "the run is over", call)

    def test_have_the_bytes_of_cradle_run(self):
        for name, (scene, settings) in SCENES.items():
            with self.subTest(name), warnings.catch_warnings():
                warnings.simplefilter("ignore", RuntimeWarning)  # that collisions are uncertain
                with cradle.run(scene, set=settings, output="run.h5", progress=False, force=True) as run:
                    sim = cradle.Simulation(scene, set=settings, threads=2)
                    sim.step(7)
                    self.assertEqual(sim.collisions, 7)
                    half = sim.time + 0.37 * (sim.until - sim.time)
                    if name != "collapse":
                        sim.advance(half)
                        self.assertEqual(sim.time, half)
                    sim.save("half.checkpoint")
                    sim.step(11)
                    for other in (sim, cradle.Simulation.load("half.checkpoint", threads=1)):
                        other.advance()
                        self.assertEqual((other.outcome, other.collisions),
                                         (run.outcome, run.series.collisions[-1] if name != "sticky" else
                                          other.collisions))
                        with other.write("live.h5", force=True) as live:
                            self.assertEqual(live.status, run.status)
                        self.assertTrue(filecmp.cmp("run.h5", "live.h5", shallow=False))


class State(small.Case):
    def test_that_of_snapshots_and_series(self):
        sim = shock()
        with cradle.open(small.shock()) as run:
            for snapshot in run.snapshots:
                sim.advance(snapshot.time)
                for name in ("x", "v", "m", "gap", "closing_speed", "index"):
                    np.testing.assert_array_equal(getattr(sim, name), snapshot[name].values)
                self.assertFalse(sim.x.flags.writeable)
                self.assertEqual(sim.index.dtype, np.int64)
            self.assertEqual((sim.time, sim.energy, sim.collisions),
                             (60, run.series.energy[-1], run.series.collisions[-1]))

    def test_all_digits_of_wide_types(self):
        settings = WIDE | {"run.precision": "mpfr", "run.digits": 50, "output.events": False}
        sim = cradle.Simulation("fig2", set=settings)
        other = cradle.Simulation("fig2", set=settings | {"run.digits": 30})  # two numbers of digits, in turn
        with cradle.run("fig2", set=settings, output="mpfr.h5", progress=False) as run:
            for k, snapshot in enumerate(run.exact.snapshots.values()):
                sim.advance(run.snapshots[k].time)
                other.advance(run.snapshots[k].time)
                for name in ("x", "gap"):
                    self.assertEqual(sim.decimals(name), snapshot[name].values.tolist())
            self.assertEqual(sim.decimals("energy"), run.exact.series.energy[-1])
        self.assertLess(len(other.decimals("energy")), len(sim.decimals("energy")))
        self.assertAlmostEqual(float(sim.mpmath("energy") - other.mpmath("energy")), 0, delta=1e-25)
        self.assertAlmostEqual(float(sim.mpmath("x")[0]), sim.x[0])
        self.refused(2, "no such quantity", sim.decimals, "y")

    def test_collision_by_collision(self):
        sim = shock()
        with cradle.open(small.shock()) as run:
            for k in range(40):
                sim.step()
                left = run.events.left[k]
                self.assertEqual((sim.collisions, sim.time), (k + 1, run.events.time[k]))
                where = sim.index.tolist().index(left)
                self.assertEqual(sim.gap[where], 0)
                self.assertLessEqual(sim.closing_speed[where], 0)
        sim.step(10**9)
        self.assertEqual((sim.time, sim.outcome), (60, "reached the end"))

    def test_documented(self):
        self.assertEqual(cradle.Simulation.x.__doc__, "positions in l, shape (n,)")
        for name, member in vars(cradle.Simulation).items():
            if isinstance(member, property):
                self.assertTrue(member.__doc__, name)

    def test_name_and_seed(self):
        with cradle.open(small.shock()) as run:
            sim = cradle.Simulation(run, seed=7)
        self.assertEqual((sim.name, sim.scene["initial"]["seed"]), ("fig2", 7))

    def test_shown(self):
        sim = cradle.Simulation("fig2", set=small.SHOCK | {"title": "<b>"})
        self.assertRegex(repr(sim), r"^<simulation fig2: t = 0 of 60, 0 collisions, energy 25; double; in progress>$")
        self.assertIn("<td style='text-align:left'>in progress</td>", sim._repr_html_())
        self.assertLessEqual({"advance", "step", "gap", "closing_speed", "on_collision"}, set(dir(sim)))


class Functions(small.Case):
    def test_collisions_are_the_events(self):
        sim, seen = shock(), []
        sim.on_collision(seen.append)
        sim.advance(40)
        also = []
        sim.on_collision(also.append)
        sim.advance()
        with cradle.open(small.shock()) as run:
            events = run.events
            self.assertEqual(len(seen), len(events.left))
            for name in cradle.Collision._fields:
                np.testing.assert_array_equal([getattr(c, name) for c in seen], events[name].values)
        self.assertEqual(seen[-len(also):], also)
        self.assertIsInstance(seen[0], cradle.Collision)

    def test_an_exception_arrives_and_the_run_continues(self):
        sim = shock(**EVENTS)
        for at in (3, 500, 501):
            fail = mock.Mock(side_effect=[None] * (at - sim.collisions) + [LookupError(f"at {at}")])
            sim.on_collision(fail)
            with self.assertRaisesRegex(LookupError, f"at {at}"):
                sim.advance()
            self.assertEqual(sim.collisions, at)
            sim.remove(fail)
        sim.advance()
        sim.write("after.h5").close()
        self.assertTrue(filecmp.cmp("after.h5", small.shock(), shallow=False))

    def test_in_segments_too(self):
        sim = cradle.Simulation("fig2", set={"initial.particles": 4000, "run.until": 600, "output.snapshots": []},
                                threads=2)
        fail = mock.Mock(side_effect=[None] * 99_999 + [LookupError])
        sim.on_collision(fail)
        with self.assertRaises(LookupError):
            sim.advance()
        self.assertEqual(sim.collisions, 99_999)
        self.assertLessEqual(sim.time, fail.call_args[0][0].time)

    def test_every(self):
        sim, times = shock(), []
        sim.every(0.1, lambda s: times.append((s.time, s.energy, len(s.gap))))
        sim.advance(2)
        sim.step(200)
        here = sim.time
        sim.advance(here + 1)
        self.assertEqual([t for t, _, _ in times], [float(f"{k / 10:.1f}") for k in range(1, len(times) + 1)])
        self.assertEqual(len(times), int((here + 1) * 10))
        fail = mock.Mock(side_effect=LookupError)
        sim.every(5, fail)
        with self.assertRaises(LookupError):
            sim.advance()
        self.assertAlmostEqual(sim.time, here + 6)
        sim.remove(fail)
        self.refused(2, "not a function of this simulation", sim.remove, fail)
        last = []
        sim.every(1, lambda s: last.append(s.over))
        sim.every(60 - sim.time, lambda s: last.append(s.outcome))
        sim.advance()
        self.assertEqual(last[-1], "reached the end")

    def test_every_counts_from_all_digits_of_the_time(self):
        sim, times = cradle.Simulation("fig2", WIDE | {"run.precision": "mpfr", "run.digits": 50}), []
        sim.advance("0.12345678901234567890123456789")
        sim.every(1, lambda s: times.append(s.decimals("time")))
        sim.advance(2)
        self.assertEqual(times[0][:31], "1.12345678901234567890123456789")

    def test_functions_cannot_advance_or_read_within_a_collision(self):
        sim = shock()
        sim.on_collision(lambda c: sim.time)
        self.refused(2, "the simulation is in a call", sim.advance)
        sim = shock()
        sim.every(1, lambda s: s.advance(2))
        self.refused(2, "in a call already", sim.advance)

    def test_a_constant_restitution_has_the_bits_of_the_law(self):
        settings = small.SHOCK | {"law.restitution": 0.9, "law.cutoff": 0, "run.until": 20, "output.snapshots": [],
                                  "output.profiles.times": []}
        law = mock.Mock(return_value=0.9)
        plain, own = cradle.Simulation("fig2", settings), cradle.Simulation("fig2", settings, restitution=law)
        for sim in (plain, own):
            sim.advance(15)
        for name in ("time", "energy", "collisions", "x", "v", "gap", "closing_speed"):
            np.testing.assert_array_equal(getattr(plain, name), getattr(own, name))
        self.assertEqual(law.call_count, own.collisions)
        for call, path in ((own.save, "no.checkpoint"), (own.write, "no.h5")):
            self.refused(2, "a function cannot be", call, path)

    def test_a_restitution_that_fails(self):
        answers, count = {10: 1.5, 20: float("nan"), 30: "none", 40: 0.5}, itertools.count(1)

        def law(w):
            return answers.get(next(count), 0.95)
        sim = cradle.Simulation("fig2", set=small.SHOCK, restitution=law)
        for said, made in (("1.5", 9), ("nan", 18), ("restitution: not a number .found 'none'.", 27)):
            with self.assertRaisesRegex(cradle.Error, said):
                sim.advance(30)
            self.assertEqual(sim.collisions, made)
        sim.advance(30)
        self.assertLess(sim.energy, 25)
        for settings in ({"run.precision": "double-double"}, {"run.coordinates": "absolute"},
                         {"run.collapse": "merge", "run.merge_speed": 0.1}, {"initial.masses": [1, 20000]}):
            self.refused(2, "a function", cradle.Simulation, "fig2", small.SHOCK | settings, restitution=law)

    def test_a_restitution_of_elastic_particles_collapses_as_any(self):
        scene = {"law": {"type": "inelastic", "restitution": 1}, "run": {"until": 10, "stop_gap": "1e-20"},
                 "initial": {"type": "list", "x": [0, 1, 3], "v": [1, 0, -1]}}
        sim = cradle.Simulation(scene, restitution=lambda w: 0.01)
        sim.advance()
        self.assertEqual(sim.outcome, "a gap below run.stop_gap")


class Calls(small.Case):
    def endless(self):
        return cradle.Simulation("cooling", set=small.ENDLESS)

    def test_ctrl_c(self):
        for functions in (False, True):
            with self.subTest(functions):
                sim = self.endless()
                if functions:
                    sim.on_collision(lambda c: None)
                timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
                timer.start()
                with self.assertRaises(KeyboardInterrupt):
                    sim.advance()
                timer.join()
                self.assertGreater(sim.collisions, 0)
                twin = self.endless()
                twin.step(sim.collisions)
                self.assertEqual((twin.time, twin.energy), (sim.time, sim.energy))
                sim.step(10)

    def test_other_threads_run_and_may_not_use_it(self):
        sim = self.endless()
        refused = []

        def other():
            for _ in range(20):
                time.sleep(0.01)
                try:
                    sim.collisions
                except cradle.Error as error:
                    refused.append(error.message)
            os.kill(os.getpid(), signal.SIGINT)
        thread = threading.Thread(target=other)
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            sim.advance()
        thread.join()
        self.assertEqual(len(refused), 20)
        self.assertIn("the simulation is in a call", refused[0])

    def test_references(self):
        def observe(collision):
            self.assertEqual(len(collision), 5)

        def law(w):
            return 0.9
        before = [sys.getrefcount(f) for f in (observe, law)]
        sim = cradle.Simulation("fig2", set=small.SHOCK, restitution=law)
        sim.on_collision(observe)
        sim.advance(30)
        sim.on_collision(lambda c: sim)  # a circle
        here = weakref.ref(sim)
        del sim
        gc.collect()
        self.assertIsNone(here())
        self.assertEqual([sys.getrefcount(f) for f in (observe, law)], before)

    def test_refusals(self):
        sim = shock()
        sim.advance(30)
        for status, message, call, *arguments in (
                (2, "a time in the past .found 29", sim.advance, 29),
                (2, "a time after the end .found 61.: the end is run.until = 60", sim.advance, 61),
                (2, "not at its end .found t = 30", sim.write, "no.h5"),
                (4, "^no_such_scene: no such scene", cradle.Simulation, "no_such_scene"),
                (2, "law.restitution", cradle.Simulation, "fig2", {"law.restitution": 2}),
                (4, "not a checkpoint.*give a checkpoint$", cradle.Simulation.load, small.shock())):
            self.refused(status, message, call, *arguments)
        self.assertEqual(sim.time, 30)
        sim.advance()
        shutil.copy(small.tagged(), "others.h5")
        self.refused(2, "others.h5.*force", sim.write, "others.h5")
        for call, *arguments in ((sim.advance,), (sim.step,), (sim.save, "no.checkpoint")):
            self.refused(2, "the run is over .found reached the end at t = 60", call, *arguments)

    def test_the_program_says_how_a_checkpoint_continues(self):
        sim = shock()
        sim.advance(10)
        sim.save("said.checkpoint")
        said = program.call(["info", "said.checkpoint"]).stdout
        self.assertIn('cradle.Simulation.load("said.checkpoint") in Python continues from it', said)
        self.assertRegex(said, "t = 10, [0-9]+ collisions")
        self.refused(4, "a checkpoint, not a result.*Simulation.load", cradle.open, "said.checkpoint")

    def test_a_checkpoint_replaces_only_a_checkpoint(self):
        sim = shock()
        shutil.copy(small.shock(), "mine.h5")
        self.refused(2, "mine.h5: not a saved simulation .found something else.: give another output, or force=True",
                     sim.save, "mine.h5")
        self.assertTrue(filecmp.cmp(small.shock(), "mine.h5", shallow=False))
        for again in (True, False):
            sim.save("mine.h5", force=again)
        self.assertEqual(cradle.Simulation.load("mine.h5").time, 0)
        for copied in (copy.copy, copy.deepcopy, pickle.dumps):
            self.refused(2, "cannot be copied or pickled .found one at t = 0.: save", copied, sim)

    def test_what_is_lost_is_a_warning(self):
        settings = small.SHOCK | {"law.restitution": 0.3, "law.cutoff": 0, "run.coordinates": "absolute"}
        sim = cradle.Simulation("fig2", set=settings)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            sim.advance()
        self.assertEqual([w.category for w in caught], [RuntimeWarning])
        self.assertEqual(caught[0].filename, __file__)
        with sim.write("lost.h5") as live:
            self.assertEqual((live.status, live.outcome), (5, sim.outcome))

    def test_without_the_module(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.dict(sys.modules), \
                mock.patch.object(compiled.program, "find", lambda: os.path.join(folder, "cradle")), \
                mock.patch.object(compiled, "__file__", os.path.join(folder, "compiled.py")):
            del sys.modules[compiled.MODULE]
            self.refused(4, "module for live simulations is missing", cradle.Simulation, "fig2")
            for name, message in (("_live.cpython-27-other.so", "found _live.cpython-27-other.so"),
                                  ("_live" + compiled.importlib.machinery.EXTENSION_SUFFIXES[0], "cannot be loaded")):
                small.written(os.path.join(folder, name), b"")
                self.refused(4, message, cradle.Simulation, "fig2")
