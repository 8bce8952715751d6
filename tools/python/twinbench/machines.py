"""Benches of one's own that have a machine: axes that are sent along lines and circles or turn on and on, and instruments on it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Callable, Mapping

import numpy as np

from . import _core
from .scenario import Scenario

Shown = Mapping[str, float] | str
At = Callable[[float], np.ndarray]


@dataclass
class AxisState:
    """What the controller says about one axis: metres of a linear one, radians of a rotary one."""

    commanded: float
    encoder: float
    moving: bool = False
    in_position: bool = True
    referenced: bool = True  # False: it has lost its origin
    limit: int = 0  # -1, +1: stands on the lower, upper limit switch
    fault: str = ""  # in the controller's words


class _Way:
    """Where all axes are along a path, by the bench's clock."""

    def __init__(self, at: At, end_s: float, triggers_s: np.ndarray | tuple = (), speed_rad_s: Callable[[float], float] | None = None):
        self.at, self.end_s = at, end_s
        self.triggers_s = np.asarray(triggers_s, dtype=float)
        self.speed_rad_s = speed_rad_s or (lambda t_s: 0.0)  # of an axis that turns on and on


class MachineBench:
    """A bench of the kinds turntable_autocollimator, hob_transmission, circular_motion, freeform_five_axis and, at rest, encoder_comparison.

    As it is, its clock is a count, its axes go exactly where they are sent and its memory never runs full: a simulation needs `show` alone.
    For real instruments override what you have. Coordinates are SI - metres, radians; times s from when the bench was made. What a
    method raises ends the run; readings made before are kept by it.

    axes: (name, is rotary) one after the other, `columns`: what instruments may show, both as the scenario's kind of bench has them.
    """

    traverse_m_s = 0.1
    traverse_rad_s = math.radians(10.0)

    def __init__(self, scenario: Scenario):
        self.bench = scenario.bench
        self.axes, self._travel, start, self.columns = _core.machine_parts(scenario._core)
        self.setup = 0  # what is mounted
        self.tooth, self.tooth_rad = 0, 0.0  # where the multi-tooth table is seated, where there is one
        self.direction = 1  # of the last arc, -1 clockwise
        self._now_s = 0.0
        self._to = np.array(start)
        self._rest(self._to)
        self._armed, self._lines, self._looked_s = 0, 0, 0.0

    # --- to be overridden ---

    def show(self, at: np.ndarray) -> Shown:
        """What the instruments show with the axes there: {column: value in its unit}, or the name of a status, "no_light"."""
        raise NotImplementedError("show(at)")

    def count(self, at: np.ndarray) -> float:
        """Lines of the encoder that the instruments count, with the axes there. Only where they latch at lines (hob_transmission)."""
        raise NotImplementedError("count(at)")

    # --- the devices ---

    def now_s(self) -> float:
        """The bench's clock; never goes back."""
        return self._now_s

    def wait(self, seconds: float) -> None:
        self._now_s += seconds

    def travel(self) -> list[tuple[float | None, float | None]]:
        """Soft limits, one pair an axis; None: there is none. Moves beyond are refused before the bench is asked."""
        return self._travel

    def start_move(self, to: list[float], feed_m_s: float) -> None:
        """A straight move of all axes; returns at once. feed_m_s: 0: as fast as the machine goes."""
        begin, end, now_s = self.where(), np.array(to), self.now_s()
        rotary = np.array([is_rotary for _, is_rotary in self.axes])
        way_m, turn_rad = np.linalg.norm((end - begin)[~rotary]), np.abs((end - begin)[rotary]).max(initial=0.0)
        takes_s = max(way_m / (feed_m_s or self.traverse_m_s), turn_rad / self.traverse_rad_s)
        self._go(_Way(lambda t_s: begin + (end - begin) * (t_s - now_s) / takes_s, now_s + takes_s) if takes_s else None, end)

    def start_arc(
        self, axes: tuple[int, int], centre_m: tuple[float, float], sweep_rad: float, feed_m_s: float, triggers: int,
        first_trigger_rad: float, trigger_step_rad: float,
    ) -> None:
        """A circle of two linear axes about a centre, from where they stand; returns at once. Counter-clockwise is positive. At `triggers`
        places of the path, the first so far behind the start, the instruments are latched if they are armed."""
        begin, now_s = self.where(), self.now_s()
        radius = begin[list(axes)] - centre_m
        speed_rad_s = (feed_m_s or self.traverse_m_s) / float(np.hypot(*radius))
        self.direction = int(math.copysign(1, sweep_rad))

        def at(t_s: float) -> np.ndarray:
            there, turned = begin.copy(), self.direction * speed_rad_s * (t_s - now_s)
            c, s = math.cos(turned), math.sin(turned)
            there[list(axes)] = centre_m + np.array([c * radius[0] - s * radius[1], s * radius[0] + c * radius[1]])
            return there

        latch_s = now_s + (first_trigger_rad + trigger_step_rad * np.arange(triggers)) / speed_rad_s
        end_s = now_s + abs(sweep_rad) / speed_rad_s
        self._go(_Way(at, end_s, latch_s), at(end_s))

    def start_turning(self, axis: int, speed_rad_s: float, ramp_s: float) -> None:
        """Lets an axis turn on and on: goes over to the speed within ramp_s; returns at once. 0 brings it to rest."""
        begin, now_s = self.where(), self.now_s()
        before_rad_s = self._way.speed_rad_s(now_s)

        def at(t_s: float) -> np.ndarray:
            there, in_ramp_s = begin.copy(), min(t_s - now_s, ramp_s)
            there[axis] += 0.5 * (before_rad_s + speed(now_s + in_ramp_s)) * in_ramp_s + speed_rad_s * (t_s - now_s - in_ramp_s)
            return there

        def speed(t_s: float) -> float:
            share = min((t_s - now_s) / ramp_s, 1.0) if ramp_s else 1.0
            return before_rad_s + share * (speed_rad_s - before_rad_s)

        end_s = math.inf if speed_rad_s else now_s + ramp_s
        self._go(_Way(at, end_s, speed_rad_s=speed), at(now_s + ramp_s))

    def settles(self, within_s: float) -> bool:
        """Lets at most that time pass; True as soon as the path has ended and every axis is in position."""
        left_s = self._way.end_s - self.now_s()
        self.wait(min(max(left_s, 0.0), within_s))
        return left_s <= within_s

    def state(self) -> list[AxisState]:
        """One entry an axis."""
        moving = self._way.end_s > self.now_s()
        return [AxisState(float(to), float(at), moving, not moving) for to, at in zip(self._to, self.where())]

    def stop(self) -> None:
        """Brings all axes to rest where they are; returns at once."""
        self._rest(self.where())

    def home(self) -> None:
        """Finds the origins again; returns when it has."""
        self.stop()

    def read(self) -> Shown:
        """Reads the resting machine now."""
        return self.show(self.where())

    def look(self) -> Shown:
        """What `read` would show, on the way to a reading: where something is brought to zero by it."""
        return self.read()

    def arm(self, samples: int, lines: int) -> None:
        """Empties the memory; the next `samples` are latched, at every so many lines or, with 0, at the path's triggers."""
        self._armed, self._lines, self._looked_s = samples, lines, self.now_s()

    def latched(self) -> tuple[list[tuple[float, Shown]], bool]:
        """(time_s, what was shown) of those latched since the last look, and whether some were lost."""
        until_s = self.now_s()
        due_s = self._line_times(until_s) if self._lines else self._way.triggers_s
        due_s = due_s[(due_s > self._looked_s) & (due_s <= until_s)][: self._armed]
        self._armed, self._looked_s = self._armed - len(due_s), until_s
        return [(float(t_s), self.show(self._way.at(t_s))) for t_s in due_s], False

    def clear(self) -> None:
        """Takes off what is mounted, so that the machine may go anywhere."""

    def mount(self, setup: int, what: str) -> None:
        """what: in words, for whoever does it."""
        if any(axis.moving for axis in self.state()):
            raise RuntimeError("nothing is mounted while an axis moves")
        self.setup = setup

    def index_to(self, tooth: int, angle_rad: float) -> None:
        """Lifts the multi-tooth table, turns it and seats it at a tooth; returns when it is seated."""
        self.tooth, self.tooth_rad = tooth, angle_rad

    # --- of use to `show` ---

    def where(self) -> np.ndarray:
        """Where the axes are now."""
        return self._way.at(min(self.now_s(), self._way.end_s))

    # --- within ---

    def _go(self, way: _Way | None, to: np.ndarray) -> None:
        self._to = to
        if way is None:
            return self._rest(to)
        self._way = way

    def _rest(self, at: np.ndarray) -> None:
        self._to = at = np.array(at, dtype=float)
        self._way = _Way(lambda t_s: at, -math.inf)

    def _line_times(self, until_s: float) -> np.ndarray:
        """When the count passes whole multiples of the lines between two samples, since the last look."""
        counts = [self.count(self._way.at(t_s)) / self._lines for t_s in (self._looked_s, until_s)]
        first, last = math.floor(min(counts)) + 1, math.floor(max(counts))
        marks = np.arange(first, last + 1)
        return np.sort([self._time_of(mark, self._looked_s, until_s) for mark in marks])

    def _time_of(self, mark: float, from_s: float, to_s: float) -> float:
        """By bisection, to a hundredth of a nanosecond."""
        rises = self.count(self._way.at(to_s)) > self.count(self._way.at(from_s))
        while to_s - from_s > 1e-11:
            half_s = 0.5 * (from_s + to_s)
            if half_s in (from_s, to_s):
                break
            if (self.count(self._way.at(half_s)) / self._lines >= mark) == rises:
                to_s = half_s
            else:
                from_s = half_s
        return to_s
