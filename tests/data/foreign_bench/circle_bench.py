"""A machine of two axes that goes round circles under a bar that shows its length, in closed form.

usage: circle_bench.py shown.json [device.kind@event ...]   (line_devices.py says which faults there are)

Devices: `controller` (esp_controller.py with X and Y, which goes round at its feed at once and gives a pulse wherever it was told), and `bar`
(which latches itself at these pulses, and is also the hand that mounts it). The bar's events are looks at what it has latched; a fault of its
own is `lost`, a pulse latches nothing. Where the controller says X and Y, the tool is at X (1 + a) - s Y and Y (1 + b). Written to shown.json: the
ports, and a, b and s.
"""
import math
import random
import sys
import time

from esp_controller import MILLIMETRES, Axis, EspController
from line_devices import Hand, show

SCALE_UM_M, SQUARENESS_ARCSEC = (20.0, -10.0), 6.19
RADIUS_MM, NOISE_UM = 50.0, 0.05
MILLIMETRES_A_UM = 1e-3


class Way:
    """Round a centre, for both axes."""

    def __init__(self, centre, at, sweep_deg, feed_mm_s):
        self.centre, self.sweep = centre, math.radians(sweep_deg)
        self.radius = math.hypot(at[0] - centre[0], at[1] - centre[1])
        self.begin = math.atan2(at[1] - centre[1], at[0] - centre[0])
        self.takes_s = abs(self.sweep) * self.radius / feed_mm_s
        self.begin_s = time.monotonic()

    def done(self):
        return min((time.monotonic() - self.begin_s) / self.takes_s, 1.0)

    def at(self, share):
        angle = self.begin + share * self.sweep
        return self.centre[0] + self.radius * math.cos(angle), self.centre[1] + self.radius * math.sin(angle)


class RoundAxis(Axis):
    way, number = None, 0

    def place(self):
        return self.way.at(self.way.done())[self.number] if self.way else super().place()

    def go(self, to):
        self.begin, self.way = self.place(), None
        super().go(to)

    def stop(self):
        at = self.place()
        self.way = None
        super().stop()
        self.begin = self.end = round(at, 6)

    def go_round(self, way):
        self.way, self.end = way, way.at(1.0)[self.number]
        self.begin_s, self.takes_s, self.settles = way.begin_s, way.takes_s, True


class RoundController(EspController):
    def __init__(self, script):
        super().__init__(script, [RoundAxis(MILLIMETRES), RoundAxis(MILLIMETRES)])
        self.axes[1].number = 1
        self.feed, self.pulses, self.next_pulses = 1.0, (), ()

    def _do(self, axis, word, rest):
        numbers = [float(number) for number in rest.split(",")] if word in ("HV", "XT", "HC") else []
        if word == "HV":
            self.feed = numbers[0]
        elif word == "XT":
            self.next_pulses = [math.radians(numbers[1] + k * numbers[2]) for k in range(int(numbers[0]))]
        elif word == "HC":
            way = Way(numbers[:2], [each.place() for each in self.axes], numbers[2], self.feed)
            self.pulses, self.next_pulses = [angle / abs(way.sweep) for angle in self.next_pulses], ()
            own = self.happen()
            way.takes_s *= 100.0 if own == "freeze" else 1.0
            for each in self.axes:
                each.go_round(way)
                each.settles = own != "unsettled"
        else:
            return super()._do(axis, word, rest)
        return None


class Bar(Hand):
    name = "bar"
    identity = "FOREIGN BALL BARS,DBB,150,1"

    def __init__(self, script, controller):
        super().__init__(script)
        self.controller, self.chance, self.wanted = controller, random.Random(61), 0

    def shown_um(self, place):
        x = place[0] * (1.0 + 1e-6 * SCALE_UM_M[0]) - math.radians(SQUARENESS_ARCSEC / 3600.0) * place[1]
        y = place[1] * (1.0 + 1e-6 * SCALE_UM_M[1])
        return f"{(math.hypot(x, y) - RADIUS_MM) / MILLIMETRES_A_UM + self.chance.gauss(0.0, NOISE_UM):.4f}"

    def do(self, word):
        if word == "NOW?":
            return self.shown_um([axis.place() for axis in self.controller.axes])
        if word.startswith("LATCH "):
            self.wanted, self.latched = int(word.split()[1]), 0
            return True
        if word == "LATCHED?":
            way = self.controller.axes[0].way
            passed = [share for share in self.controller.pulses if way and share <= way.done()][: self.wanted]
            samples = [self.shown_um(way.at(share)) for share in passed[self.latched:]]
            self.latched = len(passed)
            lost = bool(samples) and self.happen() == "lost"
            return ",".join([str(len(samples[lost:])), "0"] + samples[lost:])
        return super().do(word)


def main():
    controller = RoundController(sys.argv[2:])
    show([controller, Bar(sys.argv[2:], controller)], {"scale_mismatch_um_m": SCALE_UM_M[0] - SCALE_UM_M[1], "squareness_arcsec": SQUARENESS_ARCSEC}, sys.argv[1])


main()
