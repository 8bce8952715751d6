#!/usr/bin/env python3
"""Writes face_table.csv beside it: a polygon of 12 faces without a certificate on a rotary table, in five clampings. Shares nothing with the program.

Hidden: the table errs by 2.4 arcsec once, 0.9 arcsec twice and 0.4 arcsec six times per turn; the faces by what FACES says. Each clamping has a
constant of its own. Noise 0.05 arcsec.
"""
import math
import pathlib
import random

FACES = [0.0, -1.2, 0.7, 2.1, -0.4, -1.9, 0.9, 1.5, -2.2, 0.3, 1.1, -0.9]
TURNED_DEG = [0, 30, 90, 210, 300]
STEP_DEG = 360 // len(FACES)
draw = random.Random(12)


def table_arcsec(angle_deg):
    a = math.radians(angle_deg)
    return 2.4 * math.sin(a + 0.5) + 0.9 * math.cos(2.0 * a) + 0.4 * math.cos(6.0 * a)


def reading_arcsec(angle_deg, clamping):
    face = (angle_deg + TURNED_DEG[clamping]) // STEP_DEG % len(FACES)
    return table_arcsec(angle_deg) + FACES[face] + 3.0 * math.sin(2.3 * clamping) + draw.gauss(0.0, 0.05)


rows = ["Polygon of 12 faces on a rotary table; made by face_table.py, which says what is hidden here",
        ";".join(["table angle [deg]"] + [f"polygon turned by {turned} deg [arcsec]" for turned in TURNED_DEG])]
for angle in range(0, 360, STEP_DEG):
    rows.append(";".join([f"{angle}"] + [f"{reading_arcsec(angle, k):.3f}" for k in range(len(TURNED_DEG))]))
(pathlib.Path(__file__).parent / "face_table.csv").write_text("\n".join(rows) + "\n")
