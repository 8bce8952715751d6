"""A motion controller that is spoken to in Newport's ESP commands, as docs/hardware.md needs them.

Places are in degrees, or in mm where an axis is linear, and in steps of a millionth. It knows no MS?, as the ESP301 does not.
"""
import math
import re
import time

from line_devices import Device

DEGREES, MILLIMETRES = "7", "2"
COMMAND = re.compile(r"^(\d*)(\*IDN|[A-Z]{2})(\?|[-+0-9.eE,]*)$")
NO_COMMAND, NO_AXIS, NO_PARAMETER, BEYOND_LOWER, BEYOND_UPPER, MOTOR_OFF = 6, 9, 38, 107, 106, 113
TEXTS = {0: "NO ERROR DETECTED", NO_COMMAND: "COMMAND DOES NOT EXIST", NO_AXIS: "AXIS NUMBER OUT OF RANGE",
         NO_PARAMETER: "COMMAND PARAMETER MISSING", BEYOND_LOWER: "AXIS-1 BELOW ITS TRAVEL", BEYOND_UPPER: "AXIS-1 ABOVE ITS TRAVEL",
         MOTOR_OFF: "AXIS-1 MOTOR NOT ENABLED"}
IDENTITY = "ESP301 Version 3.0.1 foreign"


class Axis:
    """A servo that goes from rest to rest along half a cosine, at most at SPEED, and settles for a moment."""

    SPEED = 3000.0  # a second; faster than 10 turns or 10 m is nobody
    SHORTEST_S = 0.01
    SETTLING_S = 0.005

    def __init__(self, unit=DEGREES):
        self.unit = unit
        self.begin = self.end = 0.0
        self.begin_s, self.takes_s = time.monotonic(), 0.0
        self.settles = self.motor_on = True
        self.origin = 0.0  # from where it counts

    def place(self):
        done = (time.monotonic() - self.begin_s) / self.takes_s if self.takes_s > 0.0 else 1.0
        share = 0.5 - 0.5 * math.cos(math.pi * min(done, 1.0))
        return self.begin + (self.end - self.begin) * share

    def go(self, to):
        self.begin, self.end = self.place(), to
        way = abs(self.end - self.begin)
        self.takes_s = max(self.SHORTEST_S, 0.5 * math.pi * way / self.SPEED)  # fastest in the middle
        self.begin_s = time.monotonic()
        self.settles = True

    def stop(self):
        self.begin = self.end = round(self.place(), 6)
        self.takes_s, self.settles = 0.0, True

    def lose_power(self):
        self.stop()
        self.origin, self.motor_on = self.place(), False

    def find_origin(self):
        self.origin = 0.0
        self.go(0.0)

    def is_done(self):
        return self.settles and time.monotonic() - self.begin_s >= self.takes_s + self.SETTLING_S


class EspController(Device):
    """Its events are moves. Faults of its own: `unsettled`, a move that ends where it should and is never called done; `restart`, it
    is switched off and on as the move begins: motors are off, and it counts from where the axes stand.
    """

    name = "controller"
    line_end = "\r\n"

    def __init__(self, script, axes=None):
        super().__init__(script)
        self.axes = axes or [Axis()]  # 1, 2, ...
        self.group = []
        self.lower, self.upper = -800.0, 800.0
        self.errors = []

    def obey(self, command):
        words = COMMAND.match(command.upper())
        if not words:
            return self._refuse(NO_COMMAND)
        number, word, rest = words.groups()
        if number and not 1 <= int(number) <= len(self.axes):
            return self._refuse(NO_AXIS)
        axis = self.axes[int(number or "1") - 1]
        if rest == "?":
            return self._tell(axis, word)
        if word in ("ST", "AB"):
            for each in [axis] if number else self.axes:
                each.stop()
            return None
        return self._do(axis, word, rest)

    def _refuse(self, error):
        self.errors.append(error)
        return None

    def _tell(self, axis, word):
        if word in ("VE", "*IDN"):
            return IDENTITY
        if word in ("TB", "TE"):
            error = self.errors.pop(0) if self.errors else 0
            return f"{error}, {int(time.monotonic() * 1e3)}, {TEXTS[error]}" if word == "TB" else str(error)
        numbers = {"TP": lambda: axis.place() - axis.origin, "PA": lambda: axis.end - axis.origin, "SL": lambda: self.lower,
                   "SR": lambda: self.upper}
        if word in numbers:
            return f"{numbers[word]():.6f}"
        if word == "TS":
            return chr(0x50 + sum(1 << k for k, each in enumerate(self.axes[:4]) if not each.is_done()))
        if word == "MD":
            return "1" if axis.is_done() else "0"
        return {"SN": axis.unit, "MO": str(int(axis.motor_on)), "ID": "FOREIGN-RV120"}.get(word) or self._refuse(NO_COMMAND)

    def _do(self, axis, word, rest):
        if word == "OR":
            axis.find_origin()
        elif word == "PA":
            return self._go([axis], rest.split(","))
        elif word == "MO":
            axis.motor_on = True
        elif word == "HN":
            self.group = [self.axes[int(number) - 1] for number in rest.split(",")]
        elif word == "HL":
            return self._go(self.group, rest.split(","))
        elif word == "HV":
            pass  # its axes are as fast as they are
        elif word != "SN":
            return self._refuse(NO_COMMAND)
        return None

    def _go(self, axes, words):
        """They arrive together."""
        if not all(axis.motor_on for axis in axes):
            return self._refuse(MOTOR_OFF)
        try:
            places = [round(float(word), 6) for word in words]
        except ValueError:
            places = []
        if len(places) != len(axes):
            return self._refuse(NO_PARAMETER)
        for to in places:
            if not self.lower <= to <= self.upper:
                return self._refuse(BEYOND_LOWER if to < self.lower else BEYOND_UPPER)
        for axis, to in zip(axes, places):
            axis.go(to + axis.origin)
        takes_s = max(axis.takes_s for axis in axes)
        own = self.happen()
        for axis in axes:
            axis.takes_s = 100.0 * takes_s if own == "freeze" else takes_s  # then they are on their way for long
            axis.settles = own != "unsettled"
        if own == "restart":
            for each in self.axes:
                each.lose_power()
        return None
