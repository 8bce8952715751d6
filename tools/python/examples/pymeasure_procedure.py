"""Instruments of PyMeasure as a bench, and its calibration as a PyMeasure procedure: stops, rows in the results file, an abort.

    python3 pymeasure_procedure.py      an axis and an encoder of this file; give Calibration your own
"""

import math
import os
import random
import tempfile

import twinbench as tb

try:
    from pymeasure.experiment import IntegerParameter, Procedure, Results, Worker
except ModuleNotFoundError as missing:
    raise ModuleNotFoundError("this example needs PyMeasure: apt install python3-pymeasure, or pip install pymeasure", name=missing.name) from missing


class Axis:
    """As pymeasure.instruments.newport.ESP300().x: `position` [deg] is set, `wait_for_stop` waits."""

    position = 0.0

    def wait_for_stop(self):
        pass


class Encoder:
    """Under test: an error of order 3, 20 arcsec, and noise of 0.1 arcsec."""

    def __init__(self, axis):
        self._axis = axis

    @property
    def angle(self):
        error_arcsec = 20.0 * math.cos(3.0 * math.radians(self._axis.position)) + random.gauss(0.0, 0.1)
        return self._axis.position + error_arcsec / 3600.0


class Calibration(Procedure):
    """Compares an encoder with the axis that turns it; `run` has the readings and the results."""

    stops_per_turn = IntegerParameter("Stops a turn", default=24, minimum=8, maximum=3600)
    DATA_COLUMNS = ["reference_deg", "measured_deg"]

    def startup(self):
        self.axis = Axis()
        self.encoder = Encoder(self.axis)

    def execute(self):
        scenario = tb.Scenario.from_toml(
            f'bench = "encoder_comparison"\n[encoder_procedure]\nturns = 1.0\nstops_per_turn = {self.stops_per_turn}\n')
        try:
            self.run = tb.drive(Bench(self), scenario)
        except tb.BenchError:
            if not self.should_stop():
                raise


class Bench(tb.AngleBench):
    """What the procedure of twinbench asks, by the instruments of a procedure of PyMeasure."""

    def __init__(self, procedure):
        self._procedure = procedure

    def take(self, time_s, reference_rad, velocity_rad_s, direction):
        procedure = self._procedure
        if procedure.should_stop():
            raise RuntimeError("the procedure was aborted")  # ends the run
        for at_deg in (math.degrees(reference_rad) - direction, math.degrees(reference_rad)):  # from its side, by one degree
            procedure.axis.position = at_deg
            procedure.axis.wait_for_stop()
        read_deg = procedure.axis.position, procedure.encoder.angle
        procedure.emit("results", dict(zip(procedure.DATA_COLUMNS, read_deg)))
        return tuple(map(math.radians, read_deg))


if __name__ == "__main__":
    calibration = Calibration()
    worker = Worker(Results(calibration, os.path.join(tempfile.mkdtemp(), "calibration.csv")))
    worker.start()
    worker.join(timeout=600)
    print(calibration.run.summary)
