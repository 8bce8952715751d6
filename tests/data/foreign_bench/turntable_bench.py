"""A turntable under test, a multi-tooth table with a mirror on it and an autocollimator, in closed form for small angles.

usage: turntable_bench.py shown.json [controller=...] [polygon] [device.kind@event ...]   (line_devices.py says which faults there are)

Devices: `controller` (esp_controller.py; with controller=linuxcnc axis C of linuxcnc_controller.py, with controller=HOST:PORT that of a LinuxCNC
which runs there and is none of the bench's devices), `autocollimator` (x and y in microradians and the light), `indexer` (turns the
multi-tooth table, and is also the hand that mounts it). Written to shown.json: their ports, and what is hidden in the tables.

The turntable turns too far by T(phi), the multi-tooth table by R(tooth), and its axis leans by a tilt towards an azimuth on the
turntable. To first order the mirror's normal is then turned by

    a = phi + tooth - shift + T(phi) + R(tooth)        about the vertical,
    b = b0 - tilt * sin(azimuth + phi)                 upwards,

and an autocollimator whose crosshair is rolled by g shows x = a cos g + b sin g, y = b cos g - a sin g, and noise. With `polygon` one of some
faces stands on the turntable alone, and the indexer is only the hand that clamps it.
"""
import math
import random
import sys
import time

from linuxcnc_controller import controlled
from line_devices import Hand, ScpiDevice, show

ARCSEC_DEG = 1.0 / 3600.0
MICRORAD_ARCSEC = 1e-6 * 180.0 * 3600.0 / math.pi
TEETH, POSITIONS = 360, 6
ROLL_MRAD, NOISE_ARCSEC, SEATING_ARCSEC, RANGE_ARCSEC = 6.5, 0.05, 0.02, 300.0
TURNTABLE = ((1, 5.2, 0.7), (2, 1.9, 2.6))  # order, amplitude in arcsec, phase
# Tilt in arcsec, azimuth in deg, shift in teeth, b0 in arcsec; one a set-up.
SET_UPS = ((40.0, 25.0, 0, 3.0), (200.0, 25.0, 0, -7.0), (150.0, 140.0, 60, 1.0))
FACES, CLAMPED_DEG = 6, (0.0, 20.0, 40.0)


def turntable_arcsec(angle_deg):
    return sum(size * math.sin(order * math.radians(angle_deg) + phase) for order, size, phase in TURNTABLE)


def tooth_arcsec(tooth):
    """Every tooth has an error of its own: the fractions of multiples of an irrational number look like chance."""
    number = tooth % TEETH
    return 0.9 * math.cos(math.radians(number) - 1.1) + 1.2 * (math.modf(number * 0.6180339887)[0] - 0.5)


class Stand:
    """What lies between the axis and the autocollimator."""

    def __init__(self, place):
        self.place = place  # of the axis, in degrees
        self.set_up, self.tooth, self.seated_s = None, 0, 0.0
        self.seating_arcsec = 0.0
        self.seatings = {}  # by set-up and tooth: how often
        self.chance = random.Random()

    def is_seated(self):
        return time.monotonic() >= self.seated_s

    def seat(self, tooth):
        """Chance is that of this seating, whatever went wrong before."""
        self.tooth = tooth
        place = (self.set_up, tooth)
        self.seatings[place] = self.seatings.get(place, 0) + 1
        self.chance.seed(f"{place} {self.seatings[place]}")
        self.seating_arcsec = self.chance.gauss(0.0, SEATING_ARCSEC)
        self.seated_s = time.monotonic() + 0.03

    def normal_arcsec(self):
        tilt_arcsec, azimuth_deg, shift, upwards_arcsec = SET_UPS[self.set_up]
        turned_deg = self.place()
        left_deg = turned_deg + (self.tooth - shift) * 360.0 / TEETH
        left_deg -= 360.0 * round(left_deg / 360.0)
        about = left_deg / ARCSEC_DEG + turntable_arcsec(turned_deg) + tooth_arcsec(self.tooth) + self.seating_arcsec
        return about, upwards_arcsec - tilt_arcsec * math.sin(math.radians(azimuth_deg + turned_deg))

    def shown_arcsec(self):
        """Returns x and y, or None where the mirror is not seen."""
        if self.set_up is None or not self.is_seated():
            return None
        about, upwards = self.normal_arcsec()
        if max(abs(about), abs(upwards)) > RANGE_ARCSEC:
            return None
        roll = 1e-3 * ROLL_MRAD
        x = about * math.cos(roll) + upwards * math.sin(roll)
        y = upwards * math.cos(roll) - about * math.sin(roll)
        return [shown + self.chance.gauss(0.0, NOISE_ARCSEC) for shown in (x, y)]


class Polygon(Stand):
    """In the place of multi-tooth table and mirror: of FACES faces, the one that is nearest is seen."""

    def __init__(self, place):
        super().__init__(place)
        self.chance.seed(12)

    def normal_arcsec(self):
        turned_deg = self.place()
        beside_deg = turned_deg - CLAMPED_DEG[self.set_up]
        face = round(beside_deg * FACES / 360.0)
        return (beside_deg - face * 360.0 / FACES) / ARCSEC_DEG + turntable_arcsec(turned_deg) + 2.0 * math.sin(face % FACES * 2.4), 0.0


class Autocollimator(ScpiDevice):
    """Its events are readings."""

    name = "autocollimator"
    identity = "FOREIGN OPTICS,AC300,0007,2.1"

    def do(self, word):
        if word != "MEAS:ANGL?":
            return None
        self.happen()
        shown = self.stand.shown_arcsec()
        if shown is None:
            return "9.91E37,9.91E37,0.02"
        return ",".join(f"{value / MICRORAD_ARCSEC:+.6E}" for value in shown) + ",0.83"


class Indexer(Hand):
    """Its events are seatings."""

    name = "indexer"
    identity = "FOREIGN MECHANICS,HIRTH360,12,1.0"

    def do(self, word):
        if word == "SEAT?":
            return "1" if self.stand.is_seated() else "0"
        if word.startswith("SEAT "):
            self.happen()
            self.stand.seat(int(word.split()[1]))
            return True
        return super().do(word)

    def mount(self, set_up):
        self.stand.set_up = set_up


def main():
    words = sys.argv[2:]
    controllers, places = controlled(words, "C", "ABC")
    stand = (Polygon if "polygon" in words else Stand)(lambda: places()[0])
    positions = [k * 360.0 / POSITIONS for k in range(POSITIONS)]
    hidden = {"position_deg": positions, "turntable_arcsec": [turntable_arcsec(at) for at in positions],
              "multitooth_arcsec": [tooth_arcsec(k * TEETH // POSITIONS) for k in range(POSITIONS)], "roll_mrad": ROLL_MRAD}
    if "polygon" in words:
        hidden["turntable_arcsec"] = [turntable_arcsec(at) for at in range(0, 360, 360 // FACES // len(CLAMPED_DEG))]
    show([*controllers, Autocollimator(words, stand), Indexer(words, stand)], hidden, sys.argv[1])


main()
