"""Pictures as functions: those of the program to the byte, into given axes, with messages for what is not there."""
import filecmp
import inspect
import os
import subprocess
import unittest

import matplotlib
import matplotlib.pyplot as plt
import numpy as np

import cradle
import small
from cradle import program


class Pictures(unittest.TestCase):
    def test_are_those_of_the_program_to_the_byte(self):
        for make in small.ALL:
            for extension in (".png", ".svg"):
                made = cradle.plot.save(make(), "ours" + extension)
                printed = subprocess.run([program.find(), "plot", make(), "-o", "theirs" + extension], check=True,
                                         capture_output=True, text=True).stdout.split()
                self.assertEqual([name.replace("ours", "theirs") for name in made], printed)
                for ours, theirs in zip(made, printed):
                    self.assertTrue(filecmp.cmp(ours, theirs, shallow=False), ours)

    def test_every_function_draws_what_is_named(self):
        for make in small.ALL:
            with cradle.open(make()) as result:
                for name in cradle.plot.names(result):
                    figure = getattr(cradle.plot, name)(result)
                    self.assertGreater(len(figure.axes), 0, name)
                    plt.close(figure)

    def test_the_module_is_the_main_picture_and_completes_to_pictures(self):
        figure = cradle.plot(small.shock())
        main = cradle.plot.shock(small.shock())
        self.assertEqual(cradle.plot.names(small.shock())[0], "shock")
        self.assertEqual([len(ax.lines) for ax in figure.axes], [len(ax.lines) for ax in main.axes])
        self.assertEqual(len(cradle.plot(small.shock(), "energy").axes), len(cradle.plot.energy(small.shock()).axes))
        with self.assertRaisesRegex(cradle.Error, "no domino picture"):
            cradle.plot(small.shock(), "domino")
        plt.close("all")
        self.assertEqual(set(dir(cradle.plot)), {"names", "save", *cradle.plot.PICTURES})

    def test_all_have_a_text_and_the_same_arguments(self):
        for name in cradle.plot.PICTURES:
            function = getattr(cradle.plot, name)
            self.assertIn("matplotlib figure", function.__doc__)
            self.assertEqual(list(inspect.signature(function).parameters), ["result", "axes", "theory"])

    def test_the_exact_displacement_is_that_of_jepsen(self):
        from cradle.drawing.correlations import displacement, exact
        for time, square in ((1, 0.5297), (3, 2.170), (5, 3.787), (10, 7.788), (20, 15.77)):
            self.assertAlmostEqual(displacement(time) / square, 1, delta=2e-4)
        self.assertAlmostEqual(displacement(1e-4), 1e-8, delta=2e-12)
        self.assertAlmostEqual(displacement(1e6), (2 / np.pi) ** 0.5 * 1e6, delta=100)
        with cradle.open(small.tagged()) as result:
            squares, products = exact(result, [1e-3, 20.0])
            self.assertAlmostEqual(products[0], 0.99, delta=0.003)  # 1 - 1/N, and less by the first collisions
            self.assertAlmostEqual(squares[1], displacement(20) - 4, delta=1e-9)
        with cradle.open(small.shock()) as result:
            self.assertIsNone(exact(result, [1.0]))

    def test_draw_into_given_axes(self):
        figure, axes = plt.subplots(2, 2)
        given = cradle.plot.energy(small.shock(), axes=axes[:, 1])
        self.assertIs(given, figure)
        self.assertEqual(len(axes[0, 0].get_lines()), 0)
        self.assertGreater(len(axes[0, 1].get_lines()), 0)
        self.assertGreater(len(axes[1, 1].get_lines()), 0)
        with self.assertRaisesRegex(cradle.Error, r"found 3\): give 2"):
            cradle.plot.energy(small.shock(), axes=axes.ravel()[:3])
        plt.close(figure)

    def test_leave_the_settings_of_the_caller(self):
        before = dict(matplotlib.rcParams)
        matplotlib.rcParams["lines.linewidth"] = 7
        try:
            plt.close(cradle.plot.energy(small.shock()))
            self.assertEqual(matplotlib.rcParams["lines.linewidth"], 7)
        finally:
            matplotlib.rcParams.update(before)

    def test_of_another_kind_are_refused_by_name(self):
        with self.assertRaises(cradle.Error) as raised:
            cradle.plot.scenarios(small.shock())
        self.assertEqual(raised.exception.status, 2)
        self.assertIn("found shock", raised.exception.message)

    def test_places_that_cannot_be_written(self):
        for output, status in (("no/such.png", 4), ("it.gif", 2)):
            with self.assertRaises(cradle.Error) as raised:
                cradle.plot.save(small.shock(), output)
            self.assertEqual(raised.exception.status, status)
        self.assertFalse(os.path.exists("it.gif"))

    def test_zones_and_scenarios_with_too_little_in_them(self):
        # The zone has not fallen to u_crit; points have fewer replicas than shares are drawn of.
        cradle.run("fig6", output="early.h5", set={
            "initial.particles": 400, "run.until": 100, "output.zone.from": 50, "output.series.points": 20,
            "output.snapshots": [], "output.profiles.times": []}).close()
        self.assertIn("zone", cradle.plot.names("early.h5"))
        cradle.plot.save("early.h5", "early.png")
        cradle.sweep("scenarios", output="few.h5", replicas=2, set={"initial.particles": 200, "run.until": 100}).close()
        self.assertEqual(cradle.plot.names("few.h5")[0], "regimes")
        cradle.plot.save("few.h5", "few.png")
