"""What docs/python.md shows first, and the adapters: PyMeasure's own classes where it is installed, the least of QCoDeS and Bluesky that they use."""

import importlib.util
import os
import pathlib
import re
import sys
import tempfile
import threading
import types
import unittest

import numpy as np
import twinbench as tb
from test_package import SCENARIOS, needs_pages, small

EXAMPLES = SCENARIOS.parent / "tools/python/examples"


def example(name: str, fakes: dict[str, dict] | None = None) -> types.ModuleType:
    """The example as a module, with these modules in place of a library's."""
    for module, members in (fakes or {}).items():
        sys.modules[module] = types.ModuleType(module)
        vars(sys.modules[module]).update(members)
    try:
        spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module
    finally:
        for fake in fakes or {}:
            del sys.modules[fake]


class Parameter:
    """qcodes.parameters.Parameter, called to get and to set; validates arrays as QCoDeS does."""

    def __init__(self, name, instrument=None, label="", unit="", get_cmd=None, set_cmd=None, vals=None):
        assert name.isidentifier(), name
        self.name, self.unit, self._get, self._set, self._vals = name, unit, get_cmd, set_cmd, vals

    def __call__(self, *value):
        if value:
            return self._set(*value)
        got = self._get()
        if self._vals:
            assert isinstance(got, np.ndarray) and got.shape == tuple(n() for n in self._vals.shape), self.name
        return got


class ParameterWithSetpoints(Parameter):
    def __init__(self, name, *, vals, setpoints, **kwargs):
        super().__init__(name, vals=vals, **kwargs)
        self.setpoints = setpoints


class Arrays:
    def __init__(self, *, shape):
        self.shape = shape


class Instrument:
    def __init__(self, name):
        self.name = name

    def add_parameter(self, name, parameter_class=Parameter, **kwargs):
        assert not hasattr(self, name), name
        setattr(self, name, parameter_class(name, instrument=self, **kwargs))


class QCoDeS(unittest.TestCase):
    def test_a_key_is_set_and_errors_follow(self):
        fakes = {"qcodes": {}, "qcodes.instrument": {"Instrument": Instrument}, "qcodes.validators": {"Arrays": Arrays},
                 "qcodes.parameters": {"ParameterWithSetpoints": ParameterWithSetpoints}}
        scenario = small("rotary_4dof")
        bench = example("qcodes_instrument", fakes).Calibration("bench", scenario, ["laser.wavelength_nm", "seed"])
        self.assertEqual((bench.laser_wavelength_nm.unit, bench.ez.unit, bench.position.unit), ("nm", "arcsec", "deg"))
        expected = tb.run(scenario).results["separation"]["target"]
        np.testing.assert_array_equal(bench.ez(), expected["ez_arcsec"])
        np.testing.assert_array_equal(bench.ez.setpoints[0](), expected["position_deg"])
        bench.seed(3)
        self.assertEqual(bench.seed(), 3)
        np.testing.assert_array_equal(bench.u_ez(), tb.run(scenario.changed({"seed": 3})).results["separation"]["target"]["u_ez_arcsec"])
        self.assertNotEqual(scenario.seed, 3)

    @unittest.skipIf(importlib.util.find_spec("qcodes"), "QCoDeS is there")
    def test_without_the_library_it_is_said_what_is_missing(self):
        with self.assertRaisesRegex(ModuleNotFoundError, "needs QCoDeS: pip install qcodes"):
            example("qcodes_instrument")


class Bluesky(unittest.TestCase):
    def waited(self, status):
        """As RunEngine waits."""
        done = threading.Event()
        status.add_callback(lambda _: done.set())
        self.assertTrue(done.wait(60.0))
        self.assertTrue(status.done)
        return status

    def test_a_point_of_a_scan_is_moved_triggered_and_read(self):
        module = example("bluesky_device")
        scenario = small("rotary_4dof")
        bench = module.Calibration("target", scenario)
        key = module.Key(bench, "laser.wavelength_nm")
        self.assertTrue(self.waited(key.set(650.1)).success)
        self.assertEqual(key.read()["laser_wavelength_nm"]["value"], 650.1)
        self.assertEqual(key.describe()["laser_wavelength_nm"]["units"], "nm")
        self.assertTrue(self.waited(bench.trigger()).success)
        read, described = bench.read(), bench.describe()
        self.assertEqual(set(read), set(described))
        for name, entry in read.items():
            self.assertEqual(list(entry["value"].shape), described[name]["shape"])
        expected = tb.run(scenario.changed({"laser.wavelength_nm": 650.1})).results["separation"]["target"]["ez_arcsec"]
        np.testing.assert_array_equal(read["target_ez_arcsec"]["value"], expected)
        self.assertEqual(described["target_ez_arcsec"]["units"], "arcsec")

    def test_what_fails_is_in_the_status(self):
        module = example("bluesky_device")
        status = self.waited(module.Key(module.Calibration("target", small("rotary_4dof")), "laser.wavelength_nm").set(-1.0))
        self.assertFalse(status.success)
        self.assertIsInstance(status.exception(), tb.InputError)


class Documentation(unittest.TestCase):
    @needs_pages
    def test_its_first_lines_run_as_they_stand(self):
        code = re.search("```python\n(.*?)```", (SCENARIOS.parent / "docs/python.md").read_text(), re.S)[1]
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                pathlib.Path("scenarios").symlink_to(SCENARIOS)
                exec(code, {})
                self.assertGreater(pathlib.Path("page.html").stat().st_size, 100_000)
            finally:
                os.chdir(before)


@unittest.skipUnless(importlib.util.find_spec("pymeasure"), "PyMeasure is not there")
class PyMeasure(unittest.TestCase):
    def test_a_worker_runs_the_calibration_and_keeps_its_rows(self):
        from pymeasure.experiment import Results, Worker

        calibration = example("pymeasure_procedure").Calibration(stops_per_turn=12)
        with tempfile.TemporaryDirectory() as folder:
            worker = Worker(Results(calibration, f"{folder}/rows.csv"))
            worker.start()
            worker.join(timeout=60)
            self.assertEqual(calibration.status, calibration.FINISHED)
            third = calibration.run.results["harmonics"]["device"][2]
            self.assertAlmostEqual(third["amplitude_arcsec"], 20.0, delta=4.0 * third["u_amplitude_arcsec"])
            rows = [line for line in pathlib.Path(folder, "rows.csv").read_text().splitlines() if not line.startswith("#")]
            self.assertEqual(rows[0], "reference_deg,measured_deg")
            self.assertEqual(len(rows) - 1, calibration.run.readings.count)

    def test_an_abort_ends_it(self):
        calibration = example("pymeasure_procedure").Calibration(stops_per_turn=12)
        calibration.emit, calibration.should_stop = lambda *_: None, lambda: True
        calibration.startup()
        calibration.execute()
        self.assertFalse(hasattr(calibration, "run"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
