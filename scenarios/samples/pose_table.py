#!/usr/bin/env python3
"""Writes pose_table.csv beside it: an R-test on a machine whose table turns about C and tilts about A, three balls. Shares nothing with the program.

Hidden: C stands (12, -7) um off the middle of A and is tilted by 9 arcsec about X and -3 arcsec about Y; A stands 8 um too far along Y and
5 um too low, and is turned by 4 arcsec about Y and -6 arcsec about Z; the angle from +X to +Y is 5 arcsec too large, Z leans by -4 arcsec
about Y and 3 arcsec about X. C's bearing moves by 3 um along X twice a turn (cosine) and by 2 um along Z three times (sine), and is wrong
by 4 arcsec once a turn (cosine). The balls stand some um off. Where C passes A is meant. Noise 0.2 um an axis.
"""
import math
import pathlib
import random

ARCSEC = math.pi / 180.0 / 3600.0
PIVOT = (250.0, -120.0, -400.0)  # where A and C cross in machine coordinates, mm; C 12 mm behind A
BALLS = {1: ((100.0, 0.0, 50.0), (20.0, -15.0, 10.0)), 2: ((-40.0, 60.0, 120.0), (-30.0, 5.0, 8.0)), 3: ((10.0, -80.0, 20.0), (4.0, 9.0, -12.0))}
draw = random.Random(54)


def turned(axis, angle, v):
    c, s = math.cos(angle), math.sin(angle)
    i, j = {"A": (1, 2), "B": (2, 0), "C": (0, 1)}[axis]
    w = list(v)
    w[i], w[j] = c * v[i] - s * v[j], s * v[i] + c * v[j]
    return w


def erring(v, um=(0.0, 0.0, 0.0), arcsec=(0.0, 0.0, 0.0)):
    for axis, angle in zip("ABC", arcsec):
        v = turned(axis, angle * ARCSEC, v)
    return [a + 1e-3 * b for a, b in zip(v, um)]


def ball_at(a, c, place, is_real):
    """In machine coordinates: from the ball outwards through C and A."""
    v = turned("C", c, place)
    if is_real:
        v = erring(v, (12.0 + 3.0 * math.cos(2.0 * c), -7.0, 2.0 * math.sin(3.0 * c)), (9.0, -3.0, 4.0 * math.cos(c)))
    v = turned("A", -a, [v[0], v[1] + 12.0, v[2]])  # this table tilts against the right-hand rule
    if is_real:
        v = erring(v, (0.0, 8.0, -5.0), (0.0, 4.0, -6.0))
    return v


rows = ["R-test, A and C of the table; made by pose_table.py, which says what is hidden here",
        "Ball;X [mm];Y [mm];Z [mm];A [deg];C [deg];dX [um];dY [um];dZ [um]"]
for number, (place, off) in BALLS.items():
    for a_deg in range(-90, 31, 30):
        for c_deg in range(0, 360, 30):
            a, c = math.radians(a_deg), math.radians(c_deg)
            sent = ball_at(a, c, place, False)
            stands = ball_at(a, c, [p + 1e-3 * d for p, d in zip(place, off)], True)
            x, y, z = sent
            tool = [x + ARCSEC * (-5.0 * y - 4.0 * z), y - ARCSEC * 3.0 * z, z]
            shift = [1e3 * (s - t) + draw.gauss(0.0, 0.2) for s, t in zip(stands, tool)]
            at = [v + p for v, p in zip(sent, PIVOT)]
            rows.append(f"{number};" + ";".join(f"{v:.4f}" for v in at) + f";{a_deg};{c_deg};" + ";".join(f"{v:.2f}" for v in shift))
(pathlib.Path(__file__).parent / "pose_table.csv").write_text("\n".join(rows) + "\n")
