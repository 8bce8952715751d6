"""Benches of one's own, driven by the procedures that drive the twin and real hardware."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass
class TableState:
    """What a table's controller says about it."""

    commanded_rad: float
    encoder_rad: float
    moving: bool = False
    in_position: bool = True
    referenced: bool = True  # False: it has lost its origin
    limit: int = 0  # -1, +1: stands on the lower, upper limit switch
    fault: str = ""  # in the controller's words


class _Table:
    """A table that turns at constant speed and knows where it is."""

    def __init__(self, speed_rad_s: float):
        self.speed_rad_s = speed_rad_s
        self.start_rad = self.end_rad = 0.0
        self.start_s = 0.0

    def end_s(self) -> float:
        return self.start_s + abs(self.end_rad - self.start_rad) / self.speed_rad_s

    def at(self, time_s: float) -> float:
        if time_s >= self.end_s():
            return self.end_rad
        return self.start_rad + math.copysign(self.speed_rad_s, self.end_rad - self.start_rad) * (time_s - self.start_s)

    def go(self, angle_rad: float, time_s: float) -> None:
        self.start_rad, self.start_s, self.end_rad = self.at(time_s), time_s, angle_rad


class RotaryBench:
    """A bench of the kind rotary_4dof: two tables, a converter with four channels, and what stands beside them.

    As it is, its clock is a count, its tables turn evenly and its surroundings are quiet: a simulation needs `volts` alone.
    For real instruments override what you have. Angles in rad, counter-clockwise positive from above, unwrapped;
    times in s from when the bench was made. What a method raises ends the run; readings made before are kept by it.
    """

    bench = "rotary_4dof"
    speed_rad_s = math.radians(10.0)
    rate_Hz = 250e3  # of scans
    range_V, bits = 10.0, 16  # of the converter: +- range_V

    def __init__(self) -> None:
        self._now_s = 0.0
        self._tables = {"target": _Table(self.speed_rad_s), "reference": _Table(self.speed_rad_s)}
        self.yaw_rad = self.tilt_rad = 0.0  # of the goniometer
        self.clamp_rad = self.reseat_rad = 0.0  # of the mounting

    # --- to be overridden ---

    def volts(self, target_rad: float, reference_rad: float, n_samples: int) -> Any:
        """What lies at the converter with the tables at these angles: n_samples x 4 [V], in the order psd_a_x, psd_a_y,
        psd_b_x, psd_b_y; or the name of a status: "no_light", "clipped_spot", "overrun"."""
        raise NotImplementedError("volts(target_rad, reference_rad, n_samples)")

    # --- the devices ---

    def now_s(self) -> float:
        """The bench's clock; never goes back."""
        return self._now_s

    def wait(self, seconds: float) -> None:
        self._now_s += seconds

    def start_move(self, table: str, angle_rad: float) -> None:
        """Starts a move of "target" or "reference"; returns at once."""
        self._tables[table].go(angle_rad, self.now_s())

    def settles(self, table: str, within_s: float) -> bool:
        """Lets at most that time pass; True as soon as the table stands in position."""
        left_s = self._tables[table].end_s() - self.now_s()
        self.wait(min(max(left_s, 0.0), within_s))
        return left_s <= within_s

    def state(self, table: str) -> TableState:
        moving = self._tables[table].end_s() > self.now_s()
        return TableState(self._tables[table].end_rad, self._tables[table].at(self.now_s()), moving, not moving)

    def stop(self, table: str) -> None:
        """Brings the table to rest where it is; returns at once."""
        self._tables[table].go(self._tables[table].at(self.now_s()), self.now_s())

    def home(self, table: str) -> None:
        """Finds the origin again; returns when it has."""
        self.start_move(table, 0.0)
        self.settles(table, math.inf)

    def acquire(self, n_samples: int, keep_raw: bool) -> Any:
        """A block: n_samples x 4 volts, or (volts, int16 codes) where counts are kept, or the name of a status."""
        angles = [self._tables[table].at(self.now_s()) for table in ("target", "reference")]
        volts = self.volts(*angles, n_samples)
        self.wait(n_samples / self.rate_Hz)
        if isinstance(volts, str):
            return volts
        step_V, last = 2.0 * self.range_V / 2**self.bits, 2 ** (self.bits - 1)
        codes = np.clip(np.rint(np.asarray(volts) / step_V), -last, last - 1)
        if np.isin(codes, (-last, last - 1)).any():
            return "saturated"
        return codes * step_V, codes.astype(np.int16)

    def autocollimator(self) -> tuple[float, float] | None:
        """Yaw and tilt of the grating [rad]; None: it sees nothing."""
        return self.yaw_rad, self.tilt_rad

    def temperature_degC(self) -> float:
        return 20.0

    def goniometer(self, yaw_rad: float, tilt_rad: float) -> None:
        """Turns the grating about the laser's spot; returns when it stands."""
        self.yaw_rad, self.tilt_rad = yaw_rad, tilt_rad

    def mount(self, setup: int, clamp_rad: float, reseat_rad: float) -> None:
        """Turns the grating back on the reference by clamp_rad and the reference on the target by reseat_rad."""
        if self.state("target").moving or self.state("reference").moving:
            raise RuntimeError("nothing is mounted while a table moves")
        self.clamp_rad, self.reseat_rad = clamp_rad, reseat_rad


class AngleBench:
    """A bench of the kind encoder_comparison: an angle device and the reference that it is compared with."""

    bench = "encoder_comparison"

    def take(self, time_s: float, reference_rad: float, velocity_rad_s: float, direction: int) -> tuple[float, float]:
        """Brings the shaft to the angle, speed and time of the schedule (a stop is approached in its direction).

        Returns what reference and device showed at that instant [rad].
        """
        raise NotImplementedError("take(time_s, reference_rad, velocity_rad_s, direction)")
