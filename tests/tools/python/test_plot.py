"""Pictures as functions: those of the program to the byte, into given axes, with messages for what is not there."""
import filecmp
import functools
import inspect
import os
from types import SimpleNamespace

import matplotlib
import matplotlib.pyplot as plt
import numpy as np

import cradle
import small
from cradle import program
from cradle.drawing import cold, measured, particles, pictures, scenarios, settings, style, walls

COOLING = {"initial.particles": 200, "run.until": 200, "output.snapshots": [], "output.series.points": 40,
           "output.series.spacing": "linear"}


class Pictures(small.Case):
    def tearDown(self):
        plt.close("all")

    def test_are_those_of_the_program_to_the_byte(self):
        for extension in (".png", ".svg"):  # test_report compares those of all kinds of results
            made = cradle.plot.save(small.shock(), "ours" + extension)
            printed = program.call(["plot", small.shock(), "-o", "theirs" + extension]).stdout.split()
            self.assertEqual([name.replace("ours", "theirs") for name in made], printed)
            for ours, theirs in zip(made, printed):
                self.assertTrue(filecmp.cmp(ours, theirs, shallow=False), ours)

    def test_the_module_is_the_main_picture_and_completes_to_pictures(self):
        figure = cradle.plot(small.shock())
        main = cradle.plot.shock(small.shock())
        self.assertEqual(cradle.plot.names(small.shock())[0], "shock")
        self.assertEqual([len(ax.lines) for ax in figure.axes], [len(ax.lines) for ax in main.axes])
        self.assertEqual(len(cradle.plot(small.shock(), "energy").axes), len(cradle.plot.energy(small.shock()).axes))
        self.refused(2, "no domino picture", cradle.plot, small.shock(), "domino")
        self.refused(2, "found shock", cradle.plot.scenarios, small.shock())
        self.assertEqual(set(dir(cradle.plot)), {"names", "save", *cradle.plot.PICTURES})

    def test_all_have_a_text_and_the_same_arguments(self):
        for name in cradle.plot.PICTURES:
            function = getattr(cradle.plot, name)
            self.assertIn("matplotlib figure", function.__doc__)
            self.assertEqual(list(inspect.signature(function).parameters), ["result", "axes", "theory"])

    def test_the_exact_displacement_is_that_of_jepsen(self):
        displacement, exact, many = measured.displacement, measured.exact_correlations, 10 ** 8
        for time, square in ((1, 0.5297), (3, 2.170), (5, 3.787), (10, 7.788), (20, 15.77)):
            self.assertAlmostEqual(displacement(time, many) / square, 1, delta=2e-4)
        self.assertAlmostEqual(displacement(1e-4, many), 1e-8, delta=2e-12)
        self.assertAlmostEqual(displacement(1e4, many), (2 / np.pi) ** 0.5 * 1e4, delta=3)
        with cradle.open(small.tagged()) as result:
            _, products = exact(result, [1e-3])
            self.assertAlmostEqual(products[0], 0.99, delta=0.003)  # 1 - 1/N, and less by the first collisions
        with cradle.open(small.shock()) as result:
            self.assertIsNone(exact(result, [1.0]))

    def test_the_exact_displacement_is_that_of_a_ring_however_small(self):
        # In the end places are random, beside a centre of mass at rest. That of one of N is -sum (1 - j/N) g_j, of gaps
        # with variances (N - 1)/(N + 1) and covariances -1/(N + 1): of the variance (N - 1)/12, the square twice that.
        for particles in (1, 2, 3, 8, 100):
            self.assertAlmostEqual(measured.displacement(9.0 * particles, particles), (particles - 1) / 6, delta=1e-8)
        ring = {"law": {"type": "inelastic", "restitution": 1}, "run": {"until": 6}, "output": {
            "series": {"points": 2}, "correlations": {"every": 0.5, "longest": 4}}, "initial": {
                "type": "ring", "positions": "poisson", "particles": 8, "length": 4, "variance": 2, "masses": [3]}}
        with cradle.ensemble(ring, 1000, output="ring.h5", force=True) as result:
            lag = np.asarray(result.correlations["lag"])[1:]
            for name, exact in zip(("msd", "vacf"), measured.exact_correlations(result, lag)):
                mean, error = (values[1:] for values in measured.with_error(result.correlations, name))
                self.assertLess(np.abs((mean - exact) / error).max(), 4.5, name)  # of 16 numbers: once in 1e4 seeds

    def test_the_blast_has_the_energy_and_the_mass_that_it_should(self):
        xi, density, velocity, temperature = cold.solution(20000)
        np.testing.assert_allclose((density[-1], velocity[-1], temperature[-1]), (2, 1 / 2, 1 / 4), rtol=1e-12)

        def integral(values):  # the energy density is finite at the centre
            return values[0] * xi[0] + np.diff(xi) @ (values[1:] + values[:-1]) / 2
        self.assertAlmostEqual(9 / 4 / integral(density * (velocity ** 2 + temperature)), cold.AMPLITUDE, delta=1e-5)
        self.assertAlmostEqual(integral(density), 1, delta=1e-5)

    def test_dominoes_and_splashes_have_the_published_numbers(self):
        for k, ratio, delay in ((1, 1, 0), (2, 4.236068, 0.381966), (3, 9.097835, 0.445042), (4, 15.581719, 0.467911)):
            row = SimpleNamespace(scene={"initial": {"masses": [ratio, 1]}})
            self.assertEqual(cold.order(row), k)
            self.assertAlmostEqual(float(cold.delay_of(row)), delay, delta=5e-7)
        self.assertEqual(cold.order(SimpleNamespace(scene={"initial": {"masses": [2, 1]}})), 0)
        self.assertAlmostEqual(cold.ENERGY, 3 * cold.FRONT - 2, delta=2e-6)

    def test_the_energy_of_a_splash_is_that_of_the_particles_beyond_the_origin(self):
        scene = {"initial.particles": 100, "run.until": 60, "output.series.points": 2, "output.snapshots": [20, 40, 60],
                 "output.profiles.times": [20, 40, 60], "output.profiles.range": [0, 200]}
        with cradle.run("classics/splash", scene, output="splash.h5") as result:
            self.assertTrue(cold.is_splash(result))
            time, energy = cold.energies(result)
            np.testing.assert_allclose(time, [20, 40, 60])
            direct = [sum(s["m"] * s["v"] ** 2 * (s["x"] > 0)) / 2 for s in result.snapshots]
            np.testing.assert_allclose(energy, direct, rtol=1e-12)  # sums of some hundred terms, h = 1.1e-16 each

    def test_half_of_the_replicas_collapse_between_two_numbers(self):
        self.assertAlmostEqual(scenarios.half([(6, 0, 10), (10, 2, 10), (14, 6, 10), (18, 10, 10)]), 13)
        self.assertTrue(np.isnan(scenarios.half([(6, 5, 10), (10, 9, 10)])))  # the crossing is not among them
        self.assertTrue(np.isnan(scenarios.half([(6, 0, 10), (10, 4, 10)])))
        self.assertAlmostEqual(scenarios.critical_number(7 - 4 * 3 ** 0.5), 3)

    def test_heights_are_over_the_floor(self):
        ball = {"law": {"type": "inelastic", "restitution": 0.5}, "run": {"until": 1}, "gravity": {"acceleration": -2},
                "initial": {"type": "list", "x": [4], "v": [0]}, "output": {"series": {"times": [0, 1]}},
                "walls": {"left": {"position": 1, "restitution": 0.5, "motion": "sine", "amplitude": 0.1,
                                   "frequency": 3}}}
        with cradle.run(ball, output="ball.h5") as result:
            np.testing.assert_allclose(walls.heights(result, 1), [3, 2], rtol=1e-12)

    def test_a_path_is_known_before_the_first_collision_and_after_the_last(self):
        def at(time, x, v):
            return {"time": time, "index": np.array([0]), "x": np.array([x]), "v": np.array([v]), "m": np.array([2.0])}
        events = {"left": [0, 0, 7], "right": [1, 1, 8], "time": [1, 3, 3.5]}  # the third one is of others
        legs = particles.legs_of(SimpleNamespace(events=events, snapshots=[at(0, 5.0, 1.0), at(4, 9.0, 2.0)]))
        self.assertEqual(legs, {0: [((0, 1), (5, 6), 2, True), ((1, 3), (6, 7), 2, False), ((3, 4), (7, 9), 2, True)]})

    def test_a_ring_that_loses_no_energy_is_not_beside_the_sticky_gas(self):
        self.assertIn("energy", cradle.plot.names(small.tagged()))
        self.assertNotIn("cooling", cradle.plot.names(small.tagged()))
        figure = cradle.plot.ensemble(small.tagged_ensemble())
        self.assertEqual([text for ax in figure.axes for text in ax.get_legend_handles_labels()[1]], [])
        axes = cradle.plot.energy(small.tagged()).axes[0]
        self.assertAlmostEqual(np.mean(axes.get_ylim()) / axes.get_lines()[0].get_ydata()[0], 1)

    def test_the_sticky_gas_is_drawn_from_the_first_clusters_to_the_last_ten(self):
        cooling = {"initial.particles": 200, "run.until": 500, "output.snapshots": [], "output.series.points": 200}
        with cradle.ensemble("cooling", 2, cooling, output="cooling.h5") as result:
            lines = {line.get_label(): line for line in cradle.plot.ensemble(result).axes[0].get_lines()}
        energy = lines["sticky gas"].get_ydata()
        clusters = energy[np.isfinite(energy)] * 1.32825736 / 0.22137623
        self.assertTrue(190 < clusters.max() < 200 and 10 <= clusters.min() < 10.5, clusters)

    def test_laws_count_the_time_from_the_start(self):
        # Nothing but axes of time depends on run.start: both pictures have the same lines, or shifted ones.
        blast = {"initial.particles": 400, "run.until": 60, "output.profiles.range": [-80, 80]}
        for make, scene, given, shifted in (
                (cradle.run, "fig1", {"initial.left.particles": 100, "initial.right.particles": 300, "run.until": 80},
                 {"output.snapshots": [0, 40, 80], "output.profiles.times": [0, 40, 80]}),
                (cradle.run, "fig4", {"initial.particles": 40, "law.restitution": 0.9, "run.until": 16}, {}),
                (cradle.run, "cooling", COOLING, {}),
                (cradle.run, "cooling", COOLING | {"law.type": "inelastic", "law.restitution": 0.9}, {}),
                (functools.partial(cradle.ensemble, replicas=2), "cooling", COOLING, {}),
                (functools.partial(cradle.sweep, vary={"initial.variance": [1, 2]}), "cooling", COOLING, {}),
                (cradle.run, "classics/blast", blast, {"output.profiles.times": [30, 60]}),
                (cradle.run, "classics/domino", {"run.until": 20, "initial.speed": 2}, {}),
                (cradle.run, "classics/splash", {"initial.particles": 200, "run.until": 1000,
                                                 "output.profiles.range": [0, 200]},
                 {"output.profiles.times": [200, 500, 1000]}),
                (cradle.run, "fig11", {"initial.particles": 2000, "run.until": 1900, "output.series.points": 400},
                 {"output.masses": [1900]}),
                (functools.partial(cradle.sweep, vary={"law.cutoff": [1e-3, 1e-2]}), "beyond",
                 {"initial.particles": 400, "law.restitution": 0.97, "run.until": 420, "output.snapshots": [],
                  "output.series.every": "", "output.series.points": 85}, {}),
                (functools.partial(cradle.sweep, vary={"law.restitution": [0.5]}, replicas=10), "collapse_times",
                 {"initial.particles": 40, "law.cutoff": 0, "run.until": 100}, {})):
            drawn = []
            for start in (0, 64):
                times = {key: [start + time for time in value] for key, value in shifted.items()}
                until = start + given["run.until"]
                own = given | times | {"run.start": start, "run.until": until, "output.series.spacing": "linear"}
                with make(scene, set=own, output="late.h5", force=True) as result:
                    shift = start / style.Units.of(result).t
                    drawn.append({(name, panel, k): line.get_xydata().T
                                  for name, draw in cradle.plot.drawings(result).items()
                                  for panel, ax in enumerate(draw().axes)
                                  for k, line in enumerate(ax.get_lines())})
                plt.close("all")
            self.assertEqual(drawn[0].keys(), drawn[1].keys())
            for line, (x, y) in drawn[0].items():
                late, value = drawn[1][line]
                with self.subTest(scene=scene, line=line):
                    np.testing.assert_allclose(value, y, rtol=1e-6, atol=1e-9)
                    moved = late - shift if np.allclose(late[-1:] - shift, x[-1:], atol=1e-6) else late
                    np.testing.assert_allclose(moved, x, rtol=1e-6, atol=1e-6)

    def test_laws_are_of_the_masses_of_the_scene(self):
        rows = {"initial.left.particles": 99, "initial.right.particles": 99, "initial.centre.mass": 0,
                "initial.perturbation": 0, "run.until": 80, "output.series.points": 41, "output.snapshots": [40, 80],
                "output.profiles.times": [40, 80]}
        for masses, difference in (([1], "0"), ([2], "0"), ([2, 2], "0"), ([1, 3], None)):
            with cradle.run("fig1", rows | {"initial.masses": masses}, output="rows.h5", force=True) as result:
                legend = cradle.plot.sticky(result).axes[2].get_legend()
            self.assertEqual(legend.get_title().get_text(), f"largest difference {difference}" if difference else "")
            self.assertEqual(len(legend.get_texts()), 3 if difference else 2, masses)
        ratios = []
        for masses in ([1], [2]):
            with cradle.run("cooling", COOLING | {"initial.masses": masses}, output="ring.h5", force=True) as result:
                ratios.append([line.get_ydata() for ax in cradle.plot.cooling(result).axes[1:] for line in ax.lines])
        for one, two in zip(*ratios):
            np.testing.assert_allclose(two, one, rtol=1e-12)
        with cradle.run("cooling", COOLING | {"initial.random_masses": [1, 2]}, output="ring.h5",
                        force=True) as result:
            self.assertEqual(len(cradle.plot.cooling(result).axes), 2)  # no ratio to a law

    def test_what_is_exact_of_equal_masses_is_drawn_of_no_others(self):
        def scene(**initial):
            return SimpleNamespace(scene={"initial": initial})
        for initial, mass, mean in (({}, 1, 1), ({"masses": [2, "2.0"]}, 2, 2), ({"masses": [1, 3]}, None, 2),
                                    ({"random_masses": [1, 2]}, None, 1.5), ({"m": [1, 4, 1]}, None, 2),
                                    ({"x": [1, 2], "m": [4, 4]}, 4, 4)):
            self.assertEqual((settings.mass_of(scene(**initial)), settings.mean_mass(scene(**initial))), (mass, mean))
        hot = {"law": {"type": "inelastic", "restitution": 1}, "run": {"until": 50}, "walls": {
            "left": {"position": 0, "temperature": 2}, "right": {"position": 6, "temperature": 1}},
               "output": {"averages": {"every": 1, "from": 10, "bins": 3}}}
        currents, falling = [], {"gravity": {"acceleration": -0.1}}
        for m, more in (([1] * 5, {}), ([4] * 5, {}), ([1, 4, 1, 4, 1], {}), ([1] * 5, falling)):
            start = {"type": "list", "x": [0.9, 2.3, 3.1, 4.2, 5.6], "v": [0.3, 1, 0.1, -1.1, 0], "m": m}
            with cradle.run(hot | more | {"initial": start}, output="hot.h5", force=True) as result:
                currents.append(measured.exact_current(result))
        self.assertAlmostEqual(currents[0] / currents[1], 2)  # as of speeds
        self.assertEqual(currents[2:], [None, None])
        counted = {"law": {"type": "inelastic", "restitution": 1}, "run": {"until": 5},
                   "output": {"histograms": ["closing_speed"]}}
        for masses, labels in (({}, ["equilibrium"]), ({"masses": [2]}, ["equilibrium"]),
                               ({"random_masses": [1, 9]}, [])):
            with cradle.run(counted | {"initial": {"type": "ring", "particles": 20} | masses}, output="counted.h5",
                            force=True) as result:
                axes = cradle.plot.histograms(result).axes[0]
            self.assertEqual([line.get_label() for line in axes.lines if line.get_label()[0] != "_"], labels)

    def test_snapshots_that_are_left_out_are_counted(self):
        for times, said in ((range(10, 50, 5), ""), (range(10, 60, 5), "8 of 10 snapshots")):
            with cradle.run("fig2", small.SHOCK | {"output.snapshots": list(times)}, output="many.h5",
                            force=True) as result:
                self.assertEqual(cradle.plot.shock(result).axes[0].get_title("right"), said)

    def test_an_ensemble_of_a_gas_has_no_front(self):
        gas = {"law": {"type": "inelastic", "restitution": 0.9}, "initial": {"type": "gas", "particles": 20},
               "run": {"until": 20, "stop_gap": 1e-9}}
        with cradle.ensemble(gas, 2, output="gases.h5") as result:
            self.assertIn("front_right", result.series)
            self.assertEqual([ax.get_ylabel()[:6] for ax in cradle.plot.ensemble(result).axes], ["energy", "collis"])

    def test_trust_shows_where_collisions_cease_to_be_right(self):
        with cradle.open(small.trust()) as result:
            ends = [run["collisions_right_until"] for run in result.trust[:-1] if not run["right_to_end"]]
            lines = [line.get_xdata() for line in cradle.plot.trust(result).axes[0].get_lines()]
        self.assertEqual([x[0] for x in lines if len(x) == 2], ends)

    def test_a_spread_that_was_counted_is_drawn_where_bins_resolve_it(self):
        with cradle.ensemble("fig2", 4, small.SHOCK | {"output.profiles.times": []}, output="spread.h5",
                             spread=["energy=24:25:100000", "particles=0:100:9"]) as result:
            axes = {ax.get_ylabel()[:6]: ax for ax in cradle.plot.ensemble(result).axes}
        self.assertEqual({name for name, ax in axes.items()
                          if "half of the replicas" in ax.get_legend_handles_labels()[1]}, {"energy"})
        self.assertEqual([name for name, ax in axes.items() if "bins are wider" in ax.get_title("right")], ["partic"])
        self.assertIn("4 replicas, bands", axes["energy"].get_title("right"))
        self.assertIn("4 replicas, 0 at the end,", cradle.plot.ensemble(small.ensemble()).axes[0].get_title("right"))

    def test_paths_end_at_the_seam_of_a_ring_and_a_ball_has_its_height(self):
        ring = {"law": {"type": "inelastic", "restitution": 1}, "run": {"until": 9},
                "initial": {"type": "list", "x": [0], "v": [1], "length": 4}, "output": {"snapshots": list(range(9))}}
        ball = {"law": {"type": "inelastic", "restitution": 1}, "run": {"until": 1},
                "initial": {"type": "list", "x": [2], "v": [0], "m": [3]}, "gravity": {"acceleration": -1}}
        for scene, wanted in ((ring, [0, 1, 2, 3, np.nan, 0, 1, 2, 3, np.nan, 0]), (ball, [2, 1.5])):
            with cradle.run(scene, output="path.h5", force=True) as result:
                found = cradle.plot.particles(result).axes[0].get_lines()[0].get_ydata()
            np.testing.assert_allclose(found if scene is ring else found[[0, -1]], wanted, atol=1e-12)

    def test_draw_into_given_axes(self):
        figure, axes = plt.subplots(2, 2)
        given = cradle.plot.energy(small.shock(), axes=axes[:, 1])
        self.assertIs(given, figure)
        self.assertEqual([len(ax.get_lines()) > 0 for ax in axes.flat], [False, True, False, True])
        self.refused(2, r"found 3\): give 2", cradle.plot.energy, small.shock(), axes=axes.ravel()[:3])

    def test_are_drawn_for_dark_pages_too(self):
        for dark, colours in ((False, style.LIGHT), (True, style.DARK)):
            figure = cradle.plot.drawings(small.shock())["energy"](dark=dark)
            self.assertEqual(matplotlib.colors.to_hex(figure.get_facecolor()), colours["white"])
        self.assertEqual(matplotlib.colors.to_hex(style.BLUE), style.LIGHT[style.BLUE])  # after it

    def test_have_the_title_and_name_the_paper(self):
        figure = cradle.plot.shock(small.shock())
        texts = [text.get_text() for text in figure.findobj(matplotlib.text.Text)]
        self.assertIn("inelastic shock, Fig. 2", texts)
        self.assertTrue(any(text.startswith("front, Eqs. (4), (5)") for text in texts))
        self.assertTrue(any("Zaburdaev and Herminghaus" in text for text in texts))

    def test_no_axis_has_a_single_label(self):
        for low, high in ((2, 5), (0.9, 1.3), (3, 40), (1.01, 1.02), (1, 1e9)):
            figure, axes = plt.subplots()
            axes.set(yscale="log", ylim=(low, high))
            pictures.label_ticks(axes.yaxis)
            figure.canvas.draw()
            labels = [label.get_text() for label, place in zip(axes.get_yticklabels(), axes.get_yticks())
                      if low <= place <= high and label.get_text()]
            self.assertGreater(len(labels), 1, (low, high))

    def test_a_collapse_is_shown_against_the_time_that_is_left(self):
        with cradle.open(small.collapse()) as result:
            left = particles.time_to_collapse(result)
            # t_c = 12/7; doubles resolve the first differences, and the last one is 5/11 of the last interval: each
            # time to the next collision is 5/16 of the one before.
            np.testing.assert_allclose(left[:8], result.collapse["time"] - result.events["time"][:8], rtol=1e-9)
            self.assertAlmostEqual(left[-1] / result.events["interval"][-1], 5 / 11, delta=1e-9)
            figure = cradle.plot.particles(result)
            self.assertEqual([ax.get_xscale() for ax in figure.axes], ["linear", "log", "log"])

    def test_leave_the_settings_of_the_caller(self):
        with matplotlib.rc_context({"lines.linewidth": 7}):
            cradle.plot.energy(small.shock())
            self.assertEqual(matplotlib.rcParams["lines.linewidth"], 7)

    def test_none_warns_of_little_data_or_of_its_title(self):
        # run.sh makes the warnings of matplotlib errors.
        for name, scene, own in (("one", "cooling", {"initial.particles": 1, "run.until": 9, "output.snapshots": []}),
                                 ("start", "fig5", {"run.until": 0, "output.snapshots": [0]}),
                                 ("lags", "classics/diffusion", {"run.until": 0}),
                                 ("long", "fig5", {"title": "x" * 5000}), ("other", "fig5", {"title": "\u6f22 $ $"})):
            cradle.run(scene, own, output=name + ".h5").close()
            self.assertTrue(cradle.plot.save(name + ".h5", name + ".png"))
        self.assertIn("\ufffd \\$ \\$", cradle.plot("other.h5")._suptitle.get_text())
        self.assertLess(len(cradle.plot("long.h5")._suptitle.get_text()), 300)

    def test_kinds_that_cannot_be_written(self):
        self.refused(2, "", cradle.plot.save, small.shock(), "it.gif")
        self.assertFalse(os.path.exists("it.gif"))

    def test_zones_and_scenarios_with_too_little_in_them(self):
        # The zone has not fallen to u_crit; points have fewer replicas than shares are drawn of.
        cradle.run("fig6", output="early.h5", set={
            "initial.particles": 400, "run.until": 100, "output.zone.from": 50, "output.series.points": 20,
            "output.snapshots": [], "output.profiles.times": []}).close()
        figure = cradle.plot.zone("early.h5")
        labels = [line.get_label() for ax in figure.axes for line in ax.get_lines()]
        self.assertIn("right-movers", labels)
        self.assertFalse(any("Eq." in label for label in labels), labels)  # no model before there is a zone
        cradle.plot.save("early.h5", "early.png")
        cradle.sweep("scenarios", output="few.h5", replicas=2, set={"initial.particles": 200, "run.until": 100}).close()
        self.assertEqual(cradle.plot.names("few.h5")[0], "regimes")
        cradle.plot.save("few.h5", "few.png")
