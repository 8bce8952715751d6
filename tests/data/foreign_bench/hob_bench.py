"""The hob and the table of a gear hobbing machine with an encoder each, in closed form.

usage: hob_bench.py shown.json [device.kind@event ...]   (line_devices.py says which faults there are)

Devices: `controller` (of the hob, which turns on and on), `counters` (latch both encoders at lines of the table's, and are also the
hand that turns the ring round). Written to shown.json: their ports, and what is hidden in the machine.

The table follows the hob's angle h by the electronic gearbox, with a transmission error e, and its ring shows it with an error p
of its own, which turns with the place of the reading head: th = r h + e(r h), shown = th + p(th - head).
"""
import math
import random
import sys
import time

from esp_controller import DEGREES, EspController
from line_devices import Hand, show

ARCSEC_DEG = 1.0 / 3600.0
RATIO = 2.0 / 20.0  # starts of the hob over teeth of the gear
LINES, HOB_COUNTS = 18000, 1000000  # a turn
HEADS_DEG = (0.0, 100.0)  # one a set-up
TRANSMISSION = ((1, 7.4, 1.2), (2, 1.6, -0.4), (10, 2.3, 0.5))  # order, amplitude in arcsec, phase of the cosine
RING = ((1, 5.1, 2.2),)
HOB_NOISE_DEG = 2.0 * ARCSEC_DEG
MOST_IN_A_LINE = 50


def wave_deg(terms, angle_deg):
    return ARCSEC_DEG * sum(size * math.cos(order * math.radians(angle_deg) + phase) for order, size, phase in terms)


class TurningAxis:
    """Goes over from speed to speed in a straight line of time."""

    STOPPING_S = 0.05
    unit, origin, motor_on = DEGREES, 0.0, True

    def __init__(self):
        self.begin_s, self.begin_deg, self.from_deg_s, self.to_deg_s, self.ramp_s = time.monotonic(), 0.0, 0.0, 0.0, 0.0

    def _since_s(self):
        return time.monotonic() - self.begin_s

    def speed_deg_s(self):
        share = min(self._since_s() / self.ramp_s, 1.0) if self.ramp_s > 0.0 else 1.0
        return self.from_deg_s + (self.to_deg_s - self.from_deg_s) * share

    def place(self):
        since_s = self._since_s()
        ramped_s = min(since_s, self.ramp_s)
        gain = (self.to_deg_s - self.from_deg_s) / self.ramp_s if self.ramp_s > 0.0 else 0.0
        way_deg = self.from_deg_s * ramped_s + 0.5 * gain * ramped_s**2
        return self.begin_deg + way_deg + self.to_deg_s * (since_s - ramped_s)

    def go_over(self, to_deg_s, ramp_s):
        self.begin_deg, self.from_deg_s = self.place(), self.speed_deg_s()
        self.to_deg_s, self.ramp_s, self.begin_s = to_deg_s, ramp_s, time.monotonic()

    def stop(self):
        self.go_over(0.0, self.STOPPING_S)

    def is_done(self):
        return self.to_deg_s == 0.0 and self._since_s() >= self.ramp_s

    @property
    def end(self):
        return self.place()


class HobController(EspController):
    """Its events are changes of speed."""

    def __init__(self, script):
        super().__init__(script, [TurningAxis()])
        self.lower, self.upper = -1e6, 1e6

    def _do(self, axis, word, rest):
        if word != "XV":
            return super()._do(axis, word, rest)
        speed_deg_s, ramp_ms = (float(text) for text in rest.split(","))
        axis.go_over(speed_deg_s, 1e-3 * ramp_ms)
        self.happen()
        return None


class Chain:
    """From the hob's angle to what the encoders show, and back from a line of the table's."""

    def __init__(self):
        self.head_deg = None

    def table_shown_deg(self, hob_deg):
        table_deg = RATIO * hob_deg + wave_deg(TRANSMISSION, RATIO * hob_deg)
        return table_deg + wave_deg(RING, table_deg - self.head_deg)

    def hob_deg(self, shown_deg):
        """By iteration: an error changes by less than 2e-4 of the angle."""
        hob_deg = shown_deg / RATIO
        for _ in range(5):
            hob_deg += (shown_deg - self.table_shown_deg(hob_deg)) / RATIO
        return hob_deg


class Counters(Hand):
    """Its events are looks at the memory. A fault of its own: `lost`, a sample is gone and it says so."""

    name = "counters"
    identity = "FOREIGN COUNTING,IK2,4711,5"

    def __init__(self, script, axis, chain):
        super().__init__(script)
        self.axis, self.chain = axis, chain
        self.chance = random.Random(44)
        self.wanted, self.every, self.line, self.direction = 0, 1, 0, 1

    def mount(self, set_up):
        self.chain.head_deg = HEADS_DEG[set_up]

    def do(self, word):
        if (done := super().do(word)) or self.chain.head_deg is None:
            return done
        if word == "LATCHED?":
            return self._latched(self.happen() == "lost")
        if word == "NOW?":
            return self._sample(self.chain.table_shown_deg(self.axis.place()) * LINES / 360.0, self.axis.place())
        if word.startswith("LATCH "):
            self._arm(*(int(text) for text in word.split()[1].split(",")))
            return True
        return None

    def _arm(self, samples, every):
        self.wanted, self.every = samples, every
        self.direction = 1 if self.axis.speed_deg_s() >= 0.0 else -1
        at = self.chain.table_shown_deg(self.axis.place()) * LINES / 360.0 / every
        self.line = every * (math.floor(at) + 1 if self.direction > 0 else math.ceil(at) - 1)

    def _sample(self, line, hob_deg):
        shown_deg = hob_deg + self.chance.gauss(0.0, HOB_NOISE_DEG)
        return f"{line:.9g},{math.floor(shown_deg * HOB_COUNTS / 360.0)}"

    def _latched(self, lost):
        at_deg, samples = self.axis.place(), []
        while self.wanted > 0 and len(samples) < MOST_IN_A_LINE:
            hob_deg = self.chain.hob_deg(self.line * 360.0 / LINES)
            if self.direction * (at_deg - hob_deg) < 0.0:
                break
            samples.append(self._sample(self.line, hob_deg))
            self.line += self.direction * self.every
            self.wanted -= 1
        if lost and samples:
            samples.pop()
        return ",".join([str(len(samples)), "1" if lost else "0"] + samples)


def main():
    controller = HobController(sys.argv[2:])
    hidden = {"transmission": [{"order": k, "amplitude_arcsec": size, "phase_deg": math.degrees(phase)} for k, size, phase in TRANSMISSION],
              "ring": [{"order": k, "amplitude_arcsec": size, "phase_deg": math.degrees(phase)} for k, size, phase in RING]}
    show([controller, Counters(sys.argv[2:], controller.axes[0], Chain())], hidden, sys.argv[1])


main()
