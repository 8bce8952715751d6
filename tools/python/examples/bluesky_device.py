"""A simulated calibration as a Bluesky device, and a key of its scenario as one that is moved.

    python3 bluesky_device.py           scans the wavelength; each event has the table's errors by position
"""

import time
from concurrent.futures import ThreadPoolExecutor

import twinbench as tb
from twinbench.units import unit_of


class Status:
    """bluesky.protocols.Status of work that another thread does meanwhile."""

    _threads = ThreadPoolExecutor(1)

    def __init__(self, work, *arguments):
        self._future = self._threads.submit(work, *arguments)

    done = property(lambda self: self._future.done())
    success = property(lambda self: self.done and self._future.exception() is None)

    def add_callback(self, callback):
        self._future.add_done_callback(lambda _: callback(self))

    def exception(self, timeout=0.0):
        return self._future.exception(timeout)


class Calibration:
    """Triggerable and Readable: a trigger simulates the scenario, a reading is a part of its results, an array a column."""

    parent = None

    def __init__(self, name, scenario, of=("separation", "target")):
        self.name, self.scenario, self._of, self._run = name, tb.Scenario.of(scenario).changed({}), of, None

    def trigger(self):
        return Status(self._simulate)

    def read(self):
        return {f"{self.name}_{column}": {"value": values, "timestamp": self._when_s} for column, values in self._errors().items()}

    def describe(self):
        return {f"{self.name}_{column}": {"source": f"twinbench:{self.scenario.bench}", "dtype": "array", "shape": list(values.shape),
                                          "units": unit_of(column) or ""} for column, values in self._errors().items()}

    def _simulate(self):
        self._run, self._when_s = tb.run(self.scenario), time.time()

    def _errors(self):
        if self._run is None:
            self._simulate()
        part = self._run.results
        for name in self._of:
            part = part[name]
        return {column: values for column, values in part.items() if hasattr(values, "shape")}


class Key:
    """Movable and Readable: a key of a calibration's scenario, in the unit of its name."""

    parent = None

    def __init__(self, calibration, key):
        self.name, self._scenario, self._key = key.replace(".", "_"), calibration.scenario, key

    position = property(lambda self: self._scenario[self._key])

    def set(self, value):
        return Status(self._scenario.__setitem__, self._key, float(value))

    def read(self):
        return {self.name: {"value": self.position, "timestamp": time.time()}}

    def describe(self):
        return {self.name: {"source": f"twinbench:{self._key}", "dtype": "number", "shape": [], "units": unit_of(self._key) or ""}}


if __name__ == "__main__":
    try:
        from bluesky import RunEngine
        from bluesky.plans import scan
    except ModuleNotFoundError as missing:
        raise SystemExit("this example needs Bluesky: pip install bluesky") from missing

    bench = Calibration("target", tb.SCENARIOS / "rotary_4dof.toml")
    RunEngine()(scan([bench], Key(bench, "laser.wavelength_nm"), 649.9, 650.1, 3), lambda name, document: print(name, list(document)))
