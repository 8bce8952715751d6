"""A simulated calibration as a QCoDeS instrument: keys of the scenario are set, errors by position are measured as arrays.

    python3 qcodes_instrument.py        keeps ez against position in the database, at three wavelengths
"""

from functools import partial

import twinbench as tb
from twinbench.units import unit_of

try:
    from qcodes.instrument import Instrument
    from qcodes.parameters import ParameterWithSetpoints
    from qcodes.validators import Arrays
except ModuleNotFoundError as missing:
    raise ModuleNotFoundError("this example needs QCoDeS: pip install qcodes", name=missing.name) from missing


class Calibration(Instrument):
    """Parameters: the keys ("laser.wavelength_nm" is `laser_wavelength_nm`), `position` [deg], and the errors and their u at each."""

    def __init__(self, name, scenario, keys=(), of=("separation", "target"), **kwargs):
        super().__init__(name, **kwargs)
        self.scenario, self._of, self._run = tb.Scenario.of(scenario).changed({}), of, None
        for key in keys:
            self.add_parameter(key.replace(".", "_"), label=key, unit=unit_of(key) or "", get_cmd=partial(self.scenario.__getitem__, key),
                               set_cmd=partial(self._set, key))
        errors = [column for column, values in self.errors().items() if len(values) == self.positions() and column != "position_deg"]
        shape = Arrays(shape=(self.positions,))
        self.add_parameter("position", unit="deg", get_cmd=partial(self._column, "position_deg"), vals=shape)
        for column in errors:
            self.add_parameter(column.removesuffix(f"_{unit_of(column)}"), unit=unit_of(column) or "", parameter_class=ParameterWithSetpoints,
                               setpoints=(self.position,), get_cmd=partial(self._column, column), vals=shape)

    def errors(self):
        """That part of the results; the scenario is simulated when it is asked for first."""
        self._run = self._run or tb.run(self.scenario)
        part = self._run.results
        for name in self._of:
            part = part[name]
        return part

    def positions(self):
        return len(self.errors()["position_deg"])

    def _column(self, name):
        return self.errors()[name]

    def _set(self, key, value):
        self.scenario[key], self._run = value, None


if __name__ == "__main__":
    from qcodes.dataset import Measurement, load_or_create_experiment

    load_or_create_experiment("twinbench", sample_name="rotary_4dof")
    bench = Calibration("bench", tb.SCENARIOS / "rotary_4dof.toml", ["laser.wavelength_nm"])
    measurement = Measurement()
    measurement.register_parameter(bench.laser_wavelength_nm)
    measurement.register_parameter(bench.ez, setpoints=(bench.laser_wavelength_nm,))
    with measurement.run() as saver:
        for wavelength_nm in (649.9, 650.0, 650.1):
            bench.laser_wavelength_nm(wavelength_nm)
            saver.add_result((bench.laser_wavelength_nm, wavelength_nm), (bench.ez, bench.ez()))
