"""Folders, uncertainty, budget, compensation, certificate, page and import: beside the command line, byte by byte."""

import _thread
import json
import pathlib
import sys
import tempfile
import threading
import unittest
import warnings

import twinbench as tb
from test_package import SCENARIOS, command, needs_pages, small
from twinbench.values import plain, toml

LABORATORY = {
    "certificate": {"identifier": "T-1", "country": "DE", "begin": "2026-01-01", "end": "2026-01-02"},
    "laboratory": {"name": "Laboratory", "city": "Town", "country": "DE"},
    "person": {"name": "Somebody"},
    "customer": {"name": "Customer", "city": "Town", "country": "DE"},
    "item": {"name": "Table", "serial": "S-1"},
}


class BesideTheCommandLine(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = pathlib.Path(cls.scratch.name)
        pathlib.Path(cls.folder, "scenario.toml").write_text(small("rotary_4dof").toml())
        command("run", cls.folder / "scenario.toml", "-o", cls.folder / "run")
        cls.run_ = tb.Run.open(cls.folder / "run")

    def json_of(self, *arguments: str) -> dict:
        command(*arguments, "--json", self.folder / "answer.json")
        return json.loads((self.folder / "answer.json").read_text())

    def test_a_scenario_may_be_a_path(self):
        self.assertEqual(tb.run(self.folder / "scenario.toml").summary, self.run_.summary)

    def test_a_score(self):
        self.assertEqual(plain(dict(tb.score(self.run_))), self.json_of("score", self.folder / "run"))

    def test_an_uncertainty_budget_with_and_without_trials(self):
        printed = command("uncertainty", self.folder / "run")
        stated = tb.uncertainty(self.run_)
        self.assertEqual(stated.summary, printed)
        self.assertEqual(plain(dict(stated)), self.json_of("uncertainty", self.folder / "run"))
        quick = tb.run(small("rotary_4dof").changed({"procedure.positions": 6, "procedure.shifts": [0, 1], "procedure.sweep_points": 3})).save(self.folder / "quick")
        drawn = tb.uncertainty(quick, trials=1000, seed=3, threads=2)
        self.assertEqual(plain(dict(drawn)), self.json_of("uncertainty", self.folder / "quick", "--monte-carlo", "--trials", "1000", "--seed", "3"))

    def test_a_budget_of_sources(self):
        scenario = tb.Scenario(SCENARIOS / "stability.toml", {"procedure.stability_s": 60.0, "adc.samples": 100})
        pathlib.Path(self.folder, "stability.toml").write_text(scenario.toml())
        shares = tb.budget(scenario, of="stability.range")
        self.assertEqual(plain(dict(shares)), self.json_of("budget", self.folder / "stability.toml", "--of", "stability.range"))
        with self.assertRaisesRegex(tb.InputError, "no number there"):
            tb.budget(scenario, of="nothing")

    def test_a_budget_that_takes_long_is_interrupted(self):
        threading.Timer(0.3, _thread.interrupt_main).start()
        with self.assertRaises(KeyboardInterrupt):
            tb.budget(SCENARIOS / "stability.toml")

    def test_a_compensation_and_its_table(self):
        theirs = self.json_of("compensate", self.folder / "run", "--form", "linuxcnc", "-o", self.folder / "table.comp")
        made = tb.compensate(self.run_, form="linuxcnc")
        self.assertEqual(plain(dict(made)), theirs)
        self.assertEqual(made.table, (self.folder / "table.comp").read_text())

    def test_a_certificate(self):
        lines = [f"[{name}]\n" + "".join(f"{key} = {toml(value)}\n" for key, value in part.items()) for name, part in LABORATORY.items()]
        (self.folder / "laboratory.toml").write_text("".join(lines))
        theirs = self.json_of("certificate", self.folder / "run", "--with", self.folder / "laboratory.toml", "-o", self.folder / "certificate.xml")
        made = tb.certificate(self.run_, self.folder / "laboratory.toml")
        self.assertEqual(made.xml, (self.folder / "certificate.xml").read_text())
        self.assertEqual({**plain(dict(made)), "certificate": str(self.folder / "certificate.xml")}, theirs)
        self.assertTrue(made["simulated"])
        self.assertEqual(tb.certificate(self.run_, LABORATORY).xml, made.xml)
        with self.assertRaisesRegex(tb.InputError, "run.save"):
            tb.certificate(tb.run(small("encoder_comparison")), self.folder / "laboratory.toml")

    @needs_pages
    def test_a_page_with_the_truth(self):
        command("score", self.folder / "run", "--json", self.folder / "run/score.json")
        command("report", self.folder / "run", "-o", self.folder / "theirs.html")
        tb.report(self.run_, self.folder / "own.html")
        self.assertEqual((self.folder / "own.html").read_bytes(), (self.folder / "theirs.html").read_bytes())
        tb.report(tb.run(small("encoder_comparison")), self.folder / "own.html")  # in no folder; a page takes a page's place
        (self.folder / "mine.html").write_text("mine")
        with self.assertRaisesRegex(tb.InputError, "there already"):
            tb.report(self.run_, self.folder / "mine.html")

    def test_a_recording(self):
        csv = self.folder / "log.csv"
        csv.write_text("t;ref;dut\n" + "".join(f"{0.5 * k};{5.0 * k};{5.0 * k + 0.01 * (k % 3)}\n" for k in range(73)))
        columns = {"reference_deg": "ref", "measured_deg": "dut"}
        told = [part for name, column in columns.items() for part in ("--column", f"{name}={column}")]
        command("import", csv, "-o", self.folder / "imported", *told)
        with warnings.catch_warnings(record=True):
            imported = tb.import_recording(csv, columns=columns)
        theirs = tb.load(self.folder / "imported")
        self.assertEqual(imported.readings._core.csv_text(), theirs.readings._core.csv_text())
        self.assertEqual(imported.scenario.toml(), theirs.scenario.toml())
        self.assertEqual(imported.story, (self.folder / "imported/import.txt").read_text())
        imported.save(self.folder / "own")
        self.assertEqual((self.folder / "own/results.json").read_bytes(), (self.folder / "imported/results.json").read_bytes())
        self.assertIsNone(tb.Run.open(self.folder / "own").truth)


class Shown(unittest.TestCase):
    def test_objects_are_a_line_in_a_terminal_and_a_table_in_a_notebook(self):
        run = tb.run(small("encoder_comparison"))
        self.assertNotIn("harmonics", run._repr_html_())  # nothing is evaluated to be shown
        for shown in (run, run.readings, run.scenario, run.results, tb.uncertainty(run)):
            self.assertRegex(repr(shown), "^<twinbench.*>$")
            self.assertLess(len(repr(shown)), 200)
            self.assertRegex(shown._repr_html_(), "(?s)^<(pre|table|details)>.*>$")
        self.assertIn("<td>time_s</td><td>s</td>", run.readings._repr_html_())
        self.assertIn(run.summary.splitlines()[0], run._repr_html_())

    def test_frames_know_their_units(self):
        run = tb.run(small("rotary_4dof"))
        self.assertEqual(run.readings.frame().attrs["units"]["psd_a_x_V"], "V")
        units = tb.frame(run.results["separation"]["target"]).attrs["units"]
        self.assertEqual((units["u_ez_arcsec"], units["dy_um"], units["position_deg"]), ("arcsec", "um", "deg"))

    def test_units_are_read_off_names(self):
        from twinbench.units import unit_of

        for name, unit in (("scale_x_um_m", "um/m"), ("drift_urad_per_h", "urad/h"), ("feed_mm_min", "mm/min"), ("status", None), ("m", None)):
            self.assertEqual(unit_of(name), unit, name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
