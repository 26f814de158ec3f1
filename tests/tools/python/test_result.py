"""What `cradle.open` gives: names, units, shapes and values of the file, read when they are used, and exact numbers."""
import importlib.util
import math
import os
import subprocess
import sys
import unittest
from fractions import Fraction
from unittest import mock

import h5py
import numpy as np

import cradle
import small


class Run(small.Case):
    def setUp(self):
        self.file = self.enterContext(h5py.File(small.shock(), "r"))  # with locks, which ours then has too
        self.result = self.enterContext(cradle.open(small.shock()))

    def test_columns_are_those_of_the_file_with_unit_and_description(self):
        energy = self.result.series.energy
        stored = self.file["series/energy"]
        self.assertEqual((energy.name, energy.unit, energy.shape), ("energy", "m l^2/t^2", (20,)))
        self.assertEqual(energy.description, stored.attrs["description"])
        np.testing.assert_array_equal(energy, stored[:])
        lost = self.file["series/energy_lost"][:]
        np.testing.assert_array_equal(energy + self.result.series["energy_lost"], stored[:] + lost)
        self.assertEqual(energy.max(), stored[:].max())
        self.assertEqual(list(self.result.series), list(self.file["series"]))

    def test_rows_are_read_alone(self):
        energy = self.result.series.energy
        self.assertEqual(energy[-1], self.file["series/energy"][-1])
        np.testing.assert_array_equal(energy[3:7], self.file["series/energy"][3:7])
        self.assertNotIn("values", energy.__dict__, "all was read for a few rows")
        np.testing.assert_array_equal(energy[::-1], self.file["series/energy"][:][::-1])
        np.testing.assert_array_equal(energy[[0, 5]], self.file["series/energy"][:][[0, 5]])
        with self.assertRaises(IndexError):
            energy[20]

    def test_snapshots_and_profiles_are_in_order_of_time(self):
        self.assertEqual(self.result.snapshots.times.tolist(), [20, 60])
        self.assertEqual(self.result.profiles.times.tolist(), [30, 60])
        snapshot = self.result.snapshots.at(60)
        self.assertEqual(snapshot.time, 60)
        self.assertEqual(len(snapshot.gap), len(snapshot.x) - 1)
        self.assertEqual(snapshot.gap.unit, "l")

    def test_times_are_exact_unless_the_nearest_is_wanted(self):
        self.refused(2, r'none at t = 55 \(the nearest is at t = 60\).*method="nearest"', self.result.snapshots.at, 55)
        self.refused(2, "not a method", self.result.snapshots.at, 60, "next")
        self.assertEqual(self.result.snapshots.at(55, method="nearest").time, 60)
        self.assertEqual(self.result.snapshots.at(60 * (1 + 2 ** -52)).time, 60)

    def test_paths_are_those_of_the_file(self):
        for path in ("series/energy", "snapshots/0001/gap", "events/left"):
            np.testing.assert_array_equal(self.result[path], self.file[path][:])
            self.assertIn(path, self.result)
        self.assertEqual(set(self.result.keys()), set(self.file))
        self.assertEqual(self.result["snapshots"].times.tolist(), [20, 60])
        self.assertNotIn("series/heat", self.result)
        with self.assertRaisesRegex(KeyError, "heat: not in .*, which has .*series"):
            self.result["heat"]

    def test_events_are_every_collision(self):
        self.assertEqual(len(self.result.events.time), int(self.result.series.collisions[-1]))

    def test_kinds_of_collisions_follow_from_the_policy_and_add_up_to_the_counts(self):
        for keys, speed, kind, count in (({"law.cutoff": 0.3}, 0.3, 1, "collisions_below_cutoff"),
                                         ({"run.collapse": "merge", "run.merge_speed": 0.1}, 0.1, 2, "merges")):
            keys = small.SHOCK | {"law.restitution": 0.9, "output.events": True} | keys
            with cradle.run("fig2", set=keys, output="kinds.h5", force=True) as result:
                found = result.events.kind == kind
                np.testing.assert_array_equal(found, result.events.closing_speed < speed)
                self.assertEqual(found.sum(), result.series[count][-1])
                self.assertTrue(0 < found.sum() < len(found))

    def test_scene_is_a_dict_and_a_text(self):
        self.assertEqual(self.result.scene["initial"]["particles"], 200)
        self.assertIn("[law]", self.result.scene_text)
        self.assertEqual((self.result.kind, self.result.outcome), ("run", "reached the end"))

    def test_what_is_not_there_is_empty_or_named(self):
        self.assertEqual((len(self.result.points), len(self.result.trust), len(self.result.replicas)), (0, 0, 0))
        self.assertEqual(self.result.collapse, {})
        with self.assertRaisesRegex(AttributeError, "heat: not in .* energy"):
            self.result.series.heat
        self.refused(2, "", self.result.masses.at, 1)

    def test_fractions_of_stored_numbers_are_exact(self):
        fractions = self.result.series.energy.fractions()
        self.assertEqual([float(value) for value in fractions], self.file["series/energy"][:].tolist())

    def installed(self, module, conversion):
        """Whether it is; checks the message for those who do not have it."""
        with mock.patch.dict(sys.modules, {module: None}):
            self.refused(4, f"{module} is missing .in {sys.executable}.*python3-{module}", conversion)
        return importlib.util.find_spec(module) is not None

    def test_xarray_where_it_is_installed(self):
        if not self.installed("xarray", self.result.series.to_xarray):
            return
        table = self.result.snapshots[0].to_xarray()
        self.assertEqual(table["gap"].attrs["units"], "l")
        self.assertEqual(table.sizes["between_index"], table.sizes["index"] - 1)
        with cradle.open(small.ensemble()) as ensemble:
            self.assertEqual(ensemble.series.to_xarray()["energy.mean"].dims, ("time",))

    def test_pandas_where_it_is_installed(self):
        if not self.installed("pandas", self.result.series.to_pandas):
            return
        frame = self.result.series.to_pandas()
        np.testing.assert_array_equal(frame["energy"], self.file["series/energy"][:])
        self.assertEqual(frame["collisions"].dtype, "uint64")
        self.assertEqual(frame.attrs["units"]["energy"], "m l^2/t^2")
        shots = self.result.snapshots.to_pandas()
        self.assertEqual(shots["time"].unique().tolist(), [20, 60])
        self.assertEqual(shots["gap"].isna().sum(), 2, "one gap fewer than particles in either")
        with cradle.open(small.ensemble()) as ensemble:
            np.testing.assert_array_equal(ensemble.series.to_pandas()["energy.mean"], ensemble.series.energy["mean"])
        with cradle.run("fig7", output="wet.h5", set={"initial.particles": 100, "run.until": 20, "output": {
                "zone": None, "snapshots": [], "profiles": None}}) as wet:
            if "heaviest" in wet.series:
                self.assertIn("heaviest.x[1]", wet.series.to_pandas())


class Others(unittest.TestCase):
    def test_ensembles_have_statistics_and_replicas(self):
        with cradle.open(small.ensemble()) as result:
            self.assertEqual(result.kind, "ensemble")
            energy = result.series.energy
            known = np.asarray(energy["count"]) > 0
            # A mean of four equal numbers is three additions and a division: each rounds by half an ulp.
            self.assertTrue(np.all((energy["min"] * (1 - 2.0 ** -51) <= energy["mean"])[known]))
            self.assertEqual(result.replicas.index.values.tolist(), [0, 1, 2, 3])
            self.assertEqual(result.profiles.times.tolist(), [2, 4])
            np.testing.assert_array_equal(result["series/energy/mean"], energy["mean"])
            self.assertTrue({"series", "profiles", "replicas"} <= set(result.keys()))

    def test_correlations_and_places_of_runs_and_ensembles(self):
        with cradle.open(small.tagged()) as run, cradle.open(small.tagged_ensemble()) as ensemble:
            self.assertEqual(run.correlations.attributes["particles"], 100)
            self.assertEqual(run.correlations.lag[4], 1)
            self.assertEqual(run.correlations.msd.unit, "l^2")
            self.assertGreater(run.correlations.vacf_sem[0], 0)
            self.assertEqual(ensemble.correlations.lag.values.tolist(), run.correlations.lag.values.tolist())
            self.assertGreater(ensemble.correlations.msd.sem[1], 0)
            self.assertEqual(run.structure.times.tolist(), [10, 40])
            self.assertEqual(len(run.structure.at(10).s), len(run.structure_average.k))
            self.assertEqual(ensemble.structure.at(40).s.mean.shape, run.structure_average.k.shape)
            self.assertEqual(len(run.pair_distribution_average.pair_distribution_sem), 50)
            self.assertAlmostEqual(run.pair_distribution_average.distance[0], 0.1)
            self.assertEqual(len(ensemble.pair_distribution), 1)
            self.assertEqual(set(cradle.plot.names(run)) & {"correlations", "structure_factor", "pair_distribution"},
                             {"correlations", "structure_factor", "pair_distribution"})

    def test_sweeps_have_points(self):
        with cradle.open(small.sweep()) as result:
            self.assertEqual(len(result.points), 6)
            self.assertEqual(len(result.sweep["law.restitution"]), 6)
            point = result.points[1]
            self.assertEqual((point.kind, point.label), ("point", "law.restitution=0.5 initial.speed=1"))
            self.assertTrue(point.sealed)
            self.assertEqual(repr(point), "<point law.restitution=0.5 initial.speed=1: 2 replicas; series>")
            self.assertEqual(point.series.energy.mean[0], 40 / 2)  # N u0^2 / 2 with u0 = 1

    def test_proofs_enclose_the_energy_in_exact_numbers(self):
        with cradle.open(small.collapse()) as result:
            self.assertEqual((result.certificate.verdict, result.certificate.attributes["collisions"]), ("proved", 322))
            low, high = result.enclosure("energy")
            self.assertIsInstance(low[0], Fraction)
            # All particles first fly freely: the energy is 1, and the bounds are tighter than 1e-300.
            self.assertLess(low[0], 1)
            self.assertGreater(high[0], 1)
            self.assertLess(high[0] - low[0], Fraction(1, 10 ** 300))
            text = str(result.exact.series.energy_low[0])
            self.assertEqual(Fraction(text), low[0])
            low, high = result.enclosure("front_left")
            self.assertTrue(math.isnan(low[0]) and math.isnan(high[0]))  # before the first collision
            self.assertLess(low[-1], high[-1])
            with self.assertRaisesRegex(cradle.Error, "no bounds of x in its series: it has those of .*energy"):
                result.enclosure("x")

    @unittest.skipUnless(importlib.util.find_spec("mpmath"), "no mpmath (Debian: python3-mpmath)")
    def test_mpmath_keeps_all_digits(self):
        import mpmath
        with cradle.open(small.collapse()) as result:
            low = result.exact.series.energy_low
            with mpmath.workdps(450):
                self.assertEqual(mpmath.nstr(low.mpmath()[0], 390), mpmath.nstr(mpmath.mpf(str(low[0])), 390))
            self.assertEqual(mpmath.mp.dps, 15)

    def test_wide_runs_have_all_their_digits(self):
        # Particles that meet at t = 1 and part with a tenth of their closing speed, 0.2.
        scene = {"law": {"type": "inelastic", "restitution": 0.1},
                 "initial": {"type": "list", "x": [0, 2], "v": [1, -1]},
                 "run": {"until": 4, "precision": "mpfr", "digits": 80},
                 "output": {"series": {"points": 2}, "snapshots": [4], "events": True}}
        with cradle.run(scene, output="wide.h5") as result:
            self.assertLess(abs(result.exact.series.energy.fractions()[1] - Fraction(1, 100)), Fraction(1, 10 ** 79))
            gap = result.exact.snapshots["0000"].gap.fractions()[0]
            self.assertLess(abs(gap - Fraction(6, 10)), Fraction(1, 10 ** 79))
            self.assertGreater(abs(Fraction(result.snapshots.at(4).gap[0]) - Fraction(6, 10)), Fraction(1, 10 ** 20))
            self.assertEqual(float(result.exact.events.closing_speed.fractions()[0]), 2)

    def test_trust_has_a_table_for_each_precision(self):
        with cradle.open(small.trust()) as result:
            self.assertEqual(result.kind, "trust")
            self.assertEqual([table.precision for table in result.trust][-1], "mpfr, 50 digits")

    def test_threshold_has_the_values_that_were_tried(self):
        with cradle.open(small.threshold()) as result:
            self.assertEqual(result.kind, "threshold")
            about = result.threshold.attributes
            self.assertEqual((about["low_digits"], about["high_digits"]), ("0.071796", "0.071797"))
            self.assertEqual((about["low_proved"], about["high_proved"]), (1, 1))
            self.assertEqual(result.threshold.value_digits[0], "0.05")

    def test_sequence_of_collisions(self):
        with cradle.run("collapse3", set={"output.word": "ab"}, output="sequence.h5") as result:
            self.assertEqual(result.sequence.letters[0], "ab")
            self.assertEqual(result.sequence.attributes["periods"], result.sequence.repeats[0])
            self.assertEqual(result.sequence.attributes["follows"], 1)

    def test_every_kind_has_a_short_text(self):
        for make in small.ALL:
            with cradle.open(make()) as result:
                self.assertLess(len(repr(result)), 200)
                repr(result.series)


class Laziness(unittest.TestCase):
    def test_import_loads_nothing_heavy(self):
        code = "import cradle, sys; print([m for m in ('numpy', 'h5py', 'matplotlib') if m in sys.modules])"
        out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
        self.assertEqual(out, "[]\n")

    def test_opening_reads_no_columns(self):
        # A gigabyte, sparse on the disk.
        path = "large.h5"
        with h5py.File(path, "w") as file:
            file.attrs["format_version"], file.attrs["scene"] = 2, ""
            file.create_dataset("series/energy", shape=(1 << 27,), dtype="f8")
            file["series/energy"][-1] = 2.0
        self.assertGreater(os.path.getsize(path), 1 << 30)
        with cradle.open(path) as result:
            self.assertEqual(len(result.series.energy), 1 << 27)
            self.assertEqual(result.series.energy[-1], 2.0)
            self.assertNotIn("values", result.series.energy.__dict__)
