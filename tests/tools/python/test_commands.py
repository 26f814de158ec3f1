"""cradle.run and its like: the program's results to the byte, its messages and statuses as exceptions, its progress;
check, theory, scenes, new, diff and export: what the program prints, as Python objects."""
import contextlib
import filecmp
import io
import os
import signal
import subprocess
import sys
import time
from unittest import mock

import numpy as np

import cradle
import small
from cradle import program
from cradle.scene import parse_toml, scene_text


class Runs(small.Case):
    def test_a_run_has_the_bytes_of_the_command_line(self):
        words = small.set_words(small.SHOCK | {"output.events": "true"})
        subprocess.run([program.find(), "run", "fig2", "--quiet", "-o", "line.h5", *words], check=True)
        self.assertTrue(filecmp.cmp("line.h5", small.shock(), shallow=False))

    def test_scenes_are_names_files_texts_dicts_and_results(self):
        with cradle.run("fig5", output="name.h5") as first:
            small.written("fig5.toml", first.scene_text.encode())
            energy = first.series.energy.values.tolist()
            for other in ("fig5", "fig5.toml", first.scene_text, first.scene, first):
                with cradle.run(other, output="again.h5") as again:
                    self.assertEqual(again.series.energy.values.tolist(), energy)
                if not small.live():
                    sim = cradle.Simulation(other)
                    sim.advance()
                    self.assertEqual(sim.energy, energy[-1])

    def test_a_scene_without_a_file_finds_its_particles_in_the_working_folder(self):
        small.written("particles.csv", b"x,v\n0,1\n1,0\n")
        law, listed = "law = { type = 'inelastic', restitution = 1 }\nrun.until = 2\n", "file = 'particles.csv'"
        for scene in (parse_toml(law + "initial = { type = 'list', " + listed + " }"),
                      law + "[initial]\ntype = 'list'\n" + listed + "\n"):
            with cradle.run(scene, output="listed.h5", force=True) as result:
                self.assertEqual(result.series.collisions[-1], 1)

    def test_dicts_become_the_scene_that_they_came_from(self):
        scene = {"title": 'a "scene"\t\x7f', "law": {"type": "wet", "loss": 1e-4},
                 "run": {"until": 10, "events": True}, "output": {"snapshots": [1, 2.5], "series": {"points": 5}}}
        self.assertEqual(parse_toml(scene_text(scene)), scene)

    def test_collapse_is_a_result_with_its_status(self):
        with cradle.run("collapse3") as result:
            self.assertEqual((result.status, result.path), (3, "collapse3.h5"))
            self.assertIn("inelastic collapse", result.text)
            self.assertAlmostEqual(result.collapse["time"], 12 / 7, delta=1e-15)

    def test_bad_input_has_the_message_and_status_of_the_program(self):
        for status, message, call, *arguments in ((4, "^no_such_scene: no such scene", cradle.run, "no_such_scene"),
                                                  (2, "law.restitution", cradle.run, "fig2", {"law.restitution": 2}),
                                                  (2, "law.loss", cradle.run, {"law": {"type": "wet"}}),
                                                  (2, "replicas: not a whole number", cradle.ensemble, "fig2", 0)):
            self.assertNotIn("Traceback", self.refused(status, message, call, *arguments).message)

    def test_lost_order_carries_what_there_is(self):
        error = self.refused(5, "", cradle.run, "collapse3", {"run.coordinates": "absolute"}, output="lost.h5")
        with error.result as result:
            self.assertEqual(result.outcome, "resolution exhausted")
            self.assertGreater(len(result.series.time), 2)

    def test_what_the_program_says_on_the_way_is_a_warning_at_the_line_of_the_call(self):
        with self.assertWarnsRegex(RuntimeWarning, "outside the run are left out") as caught:
            cradle.run("fig5", {"run.until": 5}, output="said.h5")
        self.assertEqual(caught.filename, __file__)

    def test_a_run_without_a_known_end_says_so_while_it_runs(self):
        def interrupt(share, text):
            raise KeyboardInterrupt

        with self.assertWarnsRegex(RuntimeWarning, "how many follow is not known") as caught:
            with self.assertRaises(KeyboardInterrupt):
                cradle.run("cooling", small.ENDLESS | {"law.restitution": 0.9, "law.cutoff": 1e-300},
                           output="endless.h5", progress=interrupt)
        self.assertEqual(caught.filename, __file__)

    def test_resume_goes_further(self):
        with cradle.run("fig2", set=small.SHOCK, output="further.h5") as result:
            collisions = result.series.collisions[-1]
        with cradle.resume("further.h5", until=80) as result:
            self.assertEqual(result.series.time[-1], 80)
            self.assertGreater(result.series.collisions[-1], collisions)

    def test_a_star_import_keeps_open_and_completion_shows_what_is_for_users(self):
        names = {}
        exec("from cradle import *", names)
        self.assertNotIn("open", names)
        self.assertIs(names["run"], cradle.run)
        self.assertIn("open", dir(cradle))
        self.assertFalse({"importlib", "annotations", "TYPE_CHECKING"} & set(dir(cradle)))

    def test_without_the_program(self):
        with cradle.open(small.shock()) as result, mock.patch.dict(os.environ, CRADLE_PROGRAM="/no/such/cradle"):
            self.refused(4, "CRADLE_PROGRAM", cradle.run, "fig2")
            with self.assertWarnsRegex(UserWarning, "without predictions"):
                cradle.plot.energy(result)


class Progress(small.Case):
    def test_shares_rise_and_lines_are_the_programs(self):
        seen = []

        def show(share, text):
            seen.append((share, text))
            if len(seen) == 3:
                raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            cradle.run("cooling", set=small.ENDLESS, output="seen.h5", progress=show)
        shares = [share for share, _ in seen]
        self.assertEqual(shares, sorted(shares))
        self.assertTrue(all(0 <= share <= 1 for share in shares))
        for _, text in seen:
            self.assertRegex(text, r"^t = .* of 1e\+15, .* collisions, .* million/s(, .* left)?$")

    def test_a_terminal_is_left_as_it_was(self):
        terminal = io.StringIO()
        terminal.isatty = lambda: True
        with contextlib.redirect_stderr(terminal), program.shown(None) as show:
            show(0.5, "half")
        self.assertEqual(terminal.getvalue(), "\r\033[K[" + "#" * 15 + " " * 15 + "] half\r\033[K")

    def test_nothing_is_shown_without_a_terminal(self):
        with program.shown(False) as show:
            self.assertIsNone(show)

    def test_the_program_ends_with_the_python_that_called_it(self):
        code = f"import cradle; cradle.run('cooling', set={small.ENDLESS}, output='left.h5')"
        child = subprocess.Popen([sys.executable, "-c", code])
        while not os.path.exists("left.h5.part"):
            time.sleep(0.01)
        self.assertTrue(os.path.exists(".left.h5.cradle-lock"))
        child.kill()
        child.wait()
        while os.path.exists(".left.h5.cradle-lock"):  # which the program holds until it ends; else CTest ends the test
            time.sleep(0.01)

    def test_ctrl_c_interrupts_the_program_which_can_go_on(self):
        until = 10000
        while True:  # until the run is so long that the signal comes before its end; elastic particles never stop
            keys = small.ENDLESS | {"initial.particles": 1000, "run.until": until}
            code = f"import cradle; cradle.run('cooling', set={keys}, output='stopped.h5')"
            child = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True)
            while not os.path.exists("stopped.h5.part") and child.poll() is None:
                time.sleep(0.01)
            child.send_signal(signal.SIGINT)
            _, error = child.communicate()
            if not os.path.exists("stopped.h5"):
                break
            os.remove("stopped.h5")
            until *= 2
        self.assertIn("KeyboardInterrupt", error)
        with cradle.resume("stopped.h5") as result:
            self.assertEqual(result.outcome, "reached the end")


class Queries(small.Case):
    def test_scenes_are_titles_by_name_and_texts(self):
        titles = cradle.scenes()
        self.assertEqual(titles["collapse_times"], "collapse times of the inelastic shock")
        self.assertIn("classics/domino", titles)
        self.assertEqual(cradle.check(cradle.scenes("fig2")), cradle.check("fig2"))
        self.refused(2, "no bundled scene of this name .found no_such.: see `cradle scenes`", cradle.scenes, "no_such")

    def test_check_has_effective_values_and_cost(self):
        checked = cradle.check("fig2", set={"law": {"cutoff": None}, "run": {"until": 100},
                                            "output.series.points": 2}, seed=7)
        self.assertEqual((checked["law.restitution"], checked["run.until"], checked["initial.seed"]), (0.999, 100, 7))
        self.assertEqual(checked["law.type"], "inelastic")
        self.assertEqual(checked["run.coordinates"], "gaps", "defaults too")
        self.assertEqual((checked["law.cutoff"], checked["run.collapse"]), (0, "stop"), "unset: the default")
        self.assertGreater(checked.collisions, 1000)
        self.assertAlmostEqual(checked.seconds, checked.collisions / 2e7, delta=0.1 * checked.seconds)
        self.assertGreater(cradle.check("fig2", set={"run.until": 100}).seconds, 2 * checked.seconds, "more samples")
        self.assertGreater(checked.megabytes, 0)
        collapsed = cradle.check("fig2", set={"law.restitution": 0.99})
        self.assertIn("until inelastic collapse", repr(collapsed))
        self.assertAlmostEqual(collapsed.seconds, collapsed.collisions / 6e7, delta=0.1 * collapsed.seconds)
        self.assertEqual(repr(cradle.check("fig2")) + "\n", program.call(["check", "fig2"]).stdout)
        self.refused(2, "law.restitution: out of range", cradle.check, "fig2", {"law.restitution": 2})

    def test_theory_is_a_table_of_what_is_printed(self):
        table = cradle.theory("fig2")
        self.assertEqual(table.columns, ["quantity", "equation", "form", "t", "value"])
        turned = table.value[(table.quantity == "maximal_front") & (table.form == "continuous")]
        np.testing.assert_allclose(turned, [386.4477], rtol=1e-6)
        curve = (table.quantity == "energy") & (table.form == "continuous")
        self.assertEqual(table.t[curve][0], 0)
        self.assertTrue(np.isnan(table.t[table.quantity == "maximal_front"]).all())
        self.assertEqual(table.t.unit, "t")
        self.assertEqual(len(cradle.theory("classics/domino").value), 0)

    def test_new_writes_a_scene_that_runs(self):
        path = cradle.new("mine.toml", {"law": {"type": "wet", "loss": 0.01}, "initial": {"type": "rows"},
                                        "run": {"until": 3}})
        self.assertEqual(path, "mine.toml")
        self.assertEqual(cradle.check(path)["law.loss"], 0.01)
        self.assertEqual(cradle.check(cradle.new())["run.until"], 1500)
        self.refused(4, "there already", cradle.new, "mine.toml")

    def test_diff_lists_places_and_is_false_for_the_same(self):
        with cradle.open(small.shock()) as one:
            self.assertFalse(cradle.diff(one, small.shock()))
            with cradle.run("fig2", set=small.SHOCK | {"law.restitution": 0.99, "output.events": True},
                            output="other.h5") as other:
                found = cradle.diff(one, other)
        self.assertTrue(found)
        places = [difference.place for difference in found]
        self.assertIn("series/energy", places)
        self.assertIn("@scene", places)
        self.assertRegex(dict(found)["series/energy"], r"first in row \d+: .* relative\); \d+ of 20 numbers differ")
        first, second = repr(found).splitlines()[:2]
        self.assertRegex(first, f"^{len(found)} differences: [0-9]+ numbers compared$")
        self.assertEqual(second, "scene: law.restitution = 0.999 against 0.99")
        self.assertFalse([d for d in cradle.diff(one.path, other.path, rtol=1e9) if d.place == "series/energy"])
        self.refused(4, "", cradle.diff, small.shock(), "no_such.h5")

    def test_export_returns_the_files(self):
        with cradle.open(small.shock()) as result:
            files = cradle.export(result, "csv")
        self.assertIn("csv/series.csv", files)
        self.assertTrue(all(map(os.path.exists, files)))


class Settings(small.Case):
    def value(self, key, set):
        return cradle.check("fig2", set=set).get(key)

    def test_nested_tables_leave_other_keys(self):
        for set in ({"law": {"restitution": 0.9}}, {"law.restitution": 0.9}):
            self.assertEqual(self.value("law.restitution", set), 0.9)
            self.assertEqual(self.value("law.cutoff", set), self.value("law.cutoff", {}))
        self.assertEqual(self.value("output.profiles.bins", {"output": {"profiles": {"bins": 7}}}), 7)
        self.assertEqual(self.value("output.snapshots", {"output": {"snapshots": {"from": 0, "until": 2, "every": 1}}}),
                         [0, 1, 2])

    def test_booleans_of_numpy(self):
        for set in ({"output.events": np.bool_(True)}, {"output": {"events": np.array(True)}}):
            self.assertIs(self.value("output.events", set), True)
        with cradle.run({"law": {"type": "sticky"}, "initial": {"type": "rows"}, "run": {"until": 1},
                         "output": {"events": np.bool_(True)}}, output="events.h5") as result:
            self.assertIn("left", result.events)

    def test_none_unsets_a_key(self):
        self.assertEqual(self.value("law.cutoff", {"law.cutoff": None}), 0, "the default, not the scene's 1e-5")
        self.assertEqual(cradle.check({"law": {"type": "sticky", "restitution": None}, "run": {"until": 1},
                                       "initial": {"type": "rows"}})["law.type"], "sticky")

    def test_a_table_under_a_dotted_key_replaces(self):
        self.assertIsNotNone(self.value("output.profiles.range", {"output.profiles.range": [-9, 9]}))
        self.assertIsNone(self.value("output.profiles.range", {"output.profiles": {"times": [10]}}))
