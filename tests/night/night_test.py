"""How the parts of the night judge, on answers made by hand."""

import math
import pathlib
import tempfile
import unittest

import ratios
import schema_walk
import walk_cases

WALKED = {"base": "hob", "key": "mesh.teeth", "value": "0", "kind": "in", "code": 0}
BROKEN = WALKED | {"fault": "crash", "detail": "ended by -11"}


class Ratios(unittest.TestCase):
    def test_fail_when_worse_by_more_than_15_percent_in_their_own_direction(self):
        for better, now, expected in (("lower", 1.14, False), ("lower", 1.16, True), ("lower", 0.5, False),
                                      ("higher", 0.86, False), ("higher", 0.84, True), ("higher", 2.0, False), ("", 0.1, False)):  # fmt: skip
            self.assertEqual(ratios.is_worse(better, now, 1.0), expected, (better, now))

    def test_are_formed_within_a_round_before_their_median_is_taken(self):
        row = {"of": "p a cpu_s", "over": "p b cpu_s"}
        rounds = [{"p a cpu_s": a, "p b cpu_s": b} for a, b in ((2.0, 1.0), (40.0, 10.0), (9.0, 3.0))]
        self.assertEqual(ratios.median_of(row, rounds), 3.0)  # of the medians it is 9 / 3, of the means 3.6
        self.assertEqual(ratios.median_of(row, [*rounds[:2], {"p a cpu_s": 1.0, "p b cpu_s": 1.0}]), 2.0)  # 2 / 1 of medians too
        self.assertIsNone(ratios.median_of(row, [{"p b cpu_s": 1.0}]))

    def test_are_told_row_by_row_beside_the_committed_ones(self):
        rows = [{"group": "Light", "what": what, "better": "lower", "of": f"p {of} x", "over": "", "avx2": committed}
                for what, of, committed in (("same", "a", "3.0"), ("slower", "a", "2.0"), ("gone", "b", "3.0"), ("new", "a", ""), ("other", "b", ""))]  # fmt: skip
        lines, worse = ratios.compare(rows, [{"p a x": 3.0}], "avx2")
        self.assertEqual([line.split(" ")[2] for line in lines[2:]], ["same", "slower", "gone", "new"])  # no kernel of this kind: "other"
        self.assertEqual([line.split(" ")[2] for line in worse], ["slower", "gone"])

    def test_come_from_what_a_benchmark_prints_with_times_in_seconds(self):
        line = {"name": "Circle/bullet/iterations:2", "cpu_time": 3.0, "real_time": 9.0, "time_unit": "ms", "rate": 7.0}
        self.assertEqual(ratios.figures_of({"benchmarks": [line, {"name": "x", "error_occurred": True}]}, "p"),
                         {"p Circle/bullet cpu_s": 0.003, "p Circle/bullet rate": 7.0})  # fmt: skip

    def test_replace_a_page_between_its_markers_only(self):
        page = "a\n<!-- measured: Light -->\nold\n<!-- end -->\nb\n<!-- measured: Runs -->\nc\n<!-- end -->\n"
        self.assertEqual(ratios.with_tables(page, {"Light": "new\n"}), page.replace("old", "new"))
        self.assertRaises(SystemExit, ratios.with_tables, page, {"Heat": "new\n"})


class Walk(unittest.TestCase):
    def test_stays_within_bounds_where_a_value_is_allowed_and_beyond_them_where_it_is_not(self):
        number = {"type": "number", "exclusiveMinimum": 0.0, "maximum": 5.0}
        for value, kind in walk_cases.values_of(number):
            if kind == "in":
                self.assertTrue(0.0 < float(value) <= 5.0, value)
            elif value not in ('"1"', "true"):
                self.assertFalse(0.0 < float(value) <= 5.0, value)
        whole = [value for value, kind in walk_cases.values_of({"type": "integer", "minimum": 3.0, "maximum": 9.0}) if kind == "in"]
        self.assertTrue({"3", "4", "9"} <= set(whole) <= set("3456789"), whole)

    def test_calls_a_fault_what_is_one(self):
        for kind, code, said, results, expected in (
            ("in", 0, "u = 0.3 um\n", {"u_um": [0.3, None]}, None),
            ("in", 0, "u = 0.1 um (inf degrees of freedom)\nnoise A 0.2  inf   48.8 %\n", {}, None),
            ("in", 0, "u = nan um\n", {}, "no number"),
            ("in", 0, "u = 1.2e22 um\n", {}, "no number"),
            ("in", 0, "fine\n", {"a": [{"u_um": -2e9}]}, "no number"),
            ("out", 0, "fine\n", {}, "taken"),
            ("out", 2, "twinbench: a.b is 7; expected a number\n", None, None),
            ("in", -11, "", None, "crash"),
            ("in", 134, "terminate\n", None, "crash"),
            ("in", "silent", "", None, "silent"),
            ("in", "long", "1 of 100 readings\n", None, None),
            ("in", 1, "twinbench: target: not in position after 121 s\n", None, None),
            ("in", 1, "twinbench: motion profile: the duration must be positive\n", None, "internal message"),
            ("in", 2, "twinbench: --set a.b=1: must be above c\n", None, None),
            ("in", 1, "twinbench: vector::_M_range_check\n", None, "internal message"),
        ):
            fault = schema_walk.fault_of(kind, code, said, results)
            self.assertEqual(fault[0] if fault else None, expected, (code, said, results))

    def test_fails_a_bench_with_more_faults_than_are_known_of_the_same_cases(self):
        known = [{"base": "hob", "key": "mesh.teeth", "value": "0"}]
        other = BROKEN | {"value": "7"}
        self.assertEqual(schema_walk.compare([BROKEN], known)[1], [])
        self.assertEqual(schema_walk.compare([BROKEN, other], known)[1], [other])
        self.assertEqual(schema_walk.compare([other], known)[1], [other])  # what is known was not walked
        self.assertIn("known_faults.csv: 1", schema_walk.page_of([WALKED], known)[0])

    def test_ends_what_says_nothing_and_leaves_what_talks_for_long(self):
        schema_walk.SILENT_s, schema_walk.LONG_s = 0.3, 0.4
        with tempfile.TemporaryDirectory() as folder:
            said = pathlib.Path(folder, "said.txt")
            self.assertEqual(schema_walk.spoken(["sleep", "9"], said), "silent")
            self.assertEqual(schema_walk.spoken(["sh", "-c", "while echo word; do sleep 0.05; done"], said), "long")
            self.assertEqual(schema_walk.spoken(["sh", "-c", "echo word; exit 2"], said), 2)

    def test_finds_the_quantity_that_is_furthest_from_the_truth(self):
        many = {"value": [1.0] * 8 + [None], "truth": [0.0] * 9, "u": [0.5] * 9}  # (1 / 0.5)^2
        few = {name: {"value": [v], "truth": [0.0], "u": [1.0]} for name, v in (("bar.a", 3.0), ("bar.b", 0.0))}  # (9 + 0) / 2
        self.assertEqual(schema_walk.largest_chi2({"values": {"target.ez": many}}), 4.0)
        self.assertEqual(schema_walk.largest_chi2({"values": {"target.ez": many} | few}), 4.5)
        self.assertEqual(schema_walk.largest_chi2({"values": {"a.b": {"value": [1.0], "truth": [0.0], "u": [0.0]}}}), math.inf)


if __name__ == "__main__":
    unittest.main()
