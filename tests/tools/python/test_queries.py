"""check, theory, scenes, new, diff and export as functions: what the program prints, as Python objects."""
import os

import numpy as np

import cradle
import small
from cradle import program


class Queries(small.Case):
    def test_scenes_are_titles_by_name_and_texts(self):
        titles = cradle.scenes()
        self.assertEqual(titles["collapse_times"], "collapse times of the inelastic shock")
        self.assertIn("classics/domino", titles)
        self.assertEqual(cradle.check(cradle.scenes("fig2")), cradle.check("fig2"))
        self.refused(2, "no bundled scene of this name .found no_such.: see `cradle scenes`", cradle.scenes, "no_such")

    def test_check_has_effective_values_and_cost(self):
        checked = cradle.check("fig2", set={"law": {"cutoff": None}, "run": {"until": 100}}, seed=7)
        self.assertEqual((checked["law.restitution"], checked["run.until"], checked["initial.seed"]), (0.999, 100, 7))
        self.assertEqual(checked["law.type"], "inelastic")
        self.assertEqual(checked["run.coordinates"], "gaps", "defaults too")
        self.assertEqual((checked["law.cutoff"], checked["run.collapse"]), (0, "stop"), "unset: the default")
        self.assertGreater(checked.collisions, 1000)
        self.assertAlmostEqual(checked.seconds, checked.collisions / 2e7, delta=0.1 * checked.seconds)
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
