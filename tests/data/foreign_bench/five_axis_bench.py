"""A five-axis machine with errors, which carries a probe over paraboloids on its X slide: exact chain, exact reflection, plain Python.

usage: five_axis_bench.py shown.json [controller=...] [device.kind@event ...]   (line_devices.py says which faults there are)

Devices: `controller` (esp_controller.py with five axes; with controller=linuxcnc axes X, Y, Z, A, B of linuxcnc_controller.py, with controller=HOST:PORT
those of a LinuxCNC which runs there and is none of the bench's devices), `probe` (the quadrants' voltages and the camera's spot), and `hand`
(which mounts the artefact). The probe's events are readings. Written to shown.json: the ports, and the machine's errors that are not zero.

Chain and probe are those of the bench freeform_five_axis (docs/theory.md), with frames as pairs of a rotation (three rows) and an origin.
"""
import math
import random
import sys

from linuxcnc_controller import controlled
from line_devices import Hand, ScpiDevice, show

ARCSEC = math.pi / 180.0 / 3600.0
PIVOT_MM, PITCH_MM, RADII_MM = 120.0, 40.0, (60.0, 90.0)
LENS_MM, SPOT_MM, GAP_MM, SUM_V, NOISE_V = 50.0, 0.25, 0.02, 5.0, 0.005
OBJECT_MM, IMAGE_MM, ALPHA, PIXEL_MM, CENTRE_PX, NOISE_PX = 60.0, 60.0, math.radians(30.0), 0.007, 1024.0, 0.02
MOUNTS = ((0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 60.0, 90.0), (5.0, -8.0, 120.0, 0.0))  # mm, mm, mm, deg
STANDS = ((12.0, -7.0, 9.0, 11.0, -14.0, 20.0), (-9.0, 15.0, 4.0, -6.0, 8.0, -17.0), (3.0, 3.0, -11.0, 18.0, 5.0, 9.0))  # um and arcsec beside them
CENTRES = {"x": (0.0, 150.0), "y": (0.0, 150.0), "z": (100.0, 100.0), "a": (0.0, 12.0), "b": (0.0, 12.0)}  # where t = 0, and from there to t = 1
ERRORS = {  # um or arcsec: c0, c1, c2, c3
    "x.tx": (0.0, 6.0, -2.0, 0.0), "x.tz": (0.0, 0.0, 3.5, 1.0), "x.rz": (0.0, 4.0, 0.0, 0.0),
    "y.tx": (0.0, 0.0, -2.5, 0.0), "y.ty": (0.0, -5.0, 0.0, 1.5), "y.rx": (0.0, 3.0, 1.0, 0.0),
    "z.tz": (0.0, 8.0, 0.0, 0.0), "z.ry": (0.0, -2.0, 1.5, 0.0),
    "a.tz": (0.0, 0.0, 4.0, 0.0), "a.rx": (0.0, 5.0, 0.0, -2.0), "b.ry": (0.0, -6.0, 2.0, 0.0), "b.tx": (0.0, 2.0, 0.0, 0.0),
}
SQUARENESS = {"syx": 9.0, "szx": -4.0, "szy": 6.0}  # arcsec; A and B stand as they should


def times(left, right):
    return tuple(tuple(sum(row[k] * right[k][column] for k in range(3)) for column in range(3)) for row in left)


def turned(rotation, vector):
    return tuple(sum(a * b for a, b in zip(row, vector)) for row in rotation)


def turned_back(rotation, vector):
    return turned(tuple(zip(*rotation)), vector)


def about(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    return {"x": ((1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c)), "y": ((c, 0.0, s), (0.0, 1.0, 0.0), (-s, 0.0, c)),
            "z": ((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))}[axis]


STRAIGHT = about("x", 0.0)


def plus(one, other):
    return tuple(a + b for a, b in zip(one, other))


def chained(*frames):
    rotation, origin = STRAIGHT, (0.0, 0.0, 0.0)
    for each_rotation, each_origin in frames:
        origin = plus(origin, turned(rotation, each_origin))
        rotation = times(rotation, each_rotation)
    return rotation, origin


def shifted(*origin):
    return STRAIGHT, origin


def body(tx, ty, tz, rx, ry, rz):
    """um and arcsec."""
    rotation = times(about("z", rz * ARCSEC), times(about("y", ry * ARCSEC), about("x", rx * ARCSEC)))
    return rotation, (tx * 1e-3, ty * 1e-3, tz * 1e-3)


def body_of(axis, place):
    centre, half = CENTRES[axis]
    t = (place - centre) / half
    return body(*(sum(c * t**k for k, c in enumerate(ERRORS.get(f"{axis}.{error}", ()))) for error in ("tx", "ty", "tz", "rx", "ry", "rz")))


def tool_of(y, z, a, b):
    square = {name: value * ARCSEC for name, value in SQUARENESS.items()}
    along_y = turned(about("z", square["syx"]), (0.0, y, 0.0))
    along_z = turned(times(about("y", square["szx"]), about("x", square["szy"])), (0.0, 0.0, z))
    return chained(shifted(*along_y), body_of("y", y), shifted(*along_z), body_of("z", z), shifted(0.0, 0.0, PIVOT_MM),
                   (about("x", math.radians(a)), (0.0, 0.0, 0.0)), body_of("a", a), (about("y", math.radians(b)), (0.0, 0.0, 0.0)), body_of("b", b),
                   shifted(0.0, 0.0, -PIVOT_MM))


def artefact_of(x, set_up):
    at_x, at_y, at_z, yaw = MOUNTS[set_up]
    return chained(shifted(x, 0.0, 0.0), body_of("x", x), (about("z", math.radians(yaw)), (at_x, at_y, at_z)), body(*STANDS[set_up]))


def along_beam(tip, beam, cell):
    """From the tip to the cell's paraboloid, in the artefact's frame; and the surface's normal there."""
    radius = RADII_MM[sum(cell) % 2]
    x, y = tip[0] - cell[0] * PITCH_MM, tip[1] - cell[1] * PITCH_MM
    square = beam[0]**2 + beam[1]**2
    linear = x * beam[0] + y * beam[1] - radius * beam[2]
    constant = x * x + y * y - 2.0 * radius * tip[2]
    way = constant / (-linear + math.copysign(math.sqrt(linear**2 - square * constant), -linear))
    at_x, at_y = x + way * beam[0], y + way * beam[1]
    long = math.sqrt(at_x**2 + at_y**2 + radius**2)
    return way, (-at_x / long, -at_y / long, radius / long)


def seen(places, set_up):
    """What the probe would show without noise: V, V, V, px."""
    x, y, z, a, b = places
    tool_rotation, tip = tool_of(y, z, a, b)
    rotation, origin = artefact_of(x, set_up)
    tip = turned_back(rotation, plus(tip, (-origin[0], -origin[1], -origin[2])))
    beam = turned_back(rotation, turned(tool_rotation, (0.0, 0.0, -1.0)))
    flat = [tip[k] - beam[k] * tip[2] / beam[2] for k in range(2)]  # where it would meet the plane of the vertices
    cell = tuple(round(at / PITCH_MM) for at in flat)
    way, normal = along_beam(tip, beam, cell)
    into = sum(p * q for p, q in zip(beam, normal))
    reflected = tuple(p - 2.0 * into * q for p, q in zip(beam, normal))
    out = turned_back(tool_rotation, turned(rotation, reflected))
    u, v = (LENS_MM * out[k] / out[2] for k in range(2))
    return (*quadrants(u, v), camera(way))


def quadrants(u, v):
    def shares(spot):
        return [(1.0 - math.erf(math.sqrt(2.0) * (GAP_MM / 2.0 - sign * spot) / SPOT_MM)) / 2.0 for sign in (1, -1)]
    (right, left), (up, down) = shares(u), shares(v)
    return (SUM_V * (right - left) * (up + down), SUM_V * (up - down) * (right + left), SUM_V * (right + left) * (up + down))


def camera(way):
    beta = math.atan(OBJECT_MM * math.tan(ALPHA) / IMAGE_MM)
    return CENTRE_PX + IMAGE_MM * way * math.sin(ALPHA) / (OBJECT_MM * math.sin(beta) + way * math.sin(ALPHA + beta)) / PIXEL_MM


class Probe(ScpiDevice):
    name = "probe"
    identity = "FOREIGN OPTICS,SLOPE PROBE,3,1.0"

    def __init__(self, script, places, hand):
        super().__init__(script)
        self.places, self.hand = places, hand
        self.chance = random.Random(31)

    def do(self, word):
        if word != "MEAS:PROB?":
            return None
        self.happen()
        if self.hand.set_up is None:
            return "9.91E37,9.91E37,0,9.91E37"
        noise = (NOISE_V, NOISE_V, NOISE_V, NOISE_PX)
        return ",".join(f"{value + self.chance.gauss(0.0, u):.6f}" for value, u in zip(seen(self.places(), self.hand.set_up), noise))


def main():
    words = sys.argv[2:]
    controllers, places = controlled(words, "XYZAB")
    hand = Hand(words)
    show([*controllers, hand, Probe(words, places, hand)], {"errors": ERRORS, "squareness": SQUARENESS}, sys.argv[1])


main()
