#!/usr/bin/env python3
"""Writes spindle_probe.csv beside it: two radial probes, an axial one and a tilt meter at an artefact on a spindle, eight turns. Shares nothing with the program.

Hidden: the artefact stands 9 um off the axis; the axis errs by 0.6 um twice and 0.25 um five times per turn in x, 0.4 um three times in y, 0.3 um
once and 0.2 um twice along itself, and tilts by 1.1 arcsec twice about x and 0.8 arcsec four times about y. Each turn is off by a different amount of 0.05 um three and
a half times per turn in x. Noise 0.01 um, 0.02 arcsec.
"""
import math
import pathlib
import random

TURNS, ROWS = 8, 180
draw = random.Random(23)
rows = ["Spindle with sphere, eight turns; made by spindle_probe.py, which says what is hidden here",
        "spindle angle [deg]\tsensor X [um]\tsensor Y [um]\taxial [um]\ttilt X [arcsec]\ttilt Y [arcsec]"]
for k in range(TURNS * ROWS):
    deg = 360.0 * k / ROWS
    a = math.radians(deg)
    x = 9.0 * math.cos(a + 0.7) + 0.6 * math.cos(2 * a) + 0.25 * math.sin(5 * a) + 0.05 * math.cos(3.5 * a) + draw.gauss(0.0, 0.01)
    y = 9.0 * math.sin(a + 0.7) + 0.4 * math.cos(3 * a + 0.3) + draw.gauss(0.0, 0.01)
    z = 0.3 * math.cos(a) + 0.2 * math.sin(2 * a) + draw.gauss(0.0, 0.01)
    rx = 2.0 + 1.1 * math.cos(2 * a) + draw.gauss(0.0, 0.02)
    ry = -1.0 + 0.8 * math.sin(4 * a) + draw.gauss(0.0, 0.02)
    rows.append(f"{deg:.1f}\t{x:.4f}\t{y:.4f}\t{z:.4f}\t{rx:.4f}\t{ry:.4f}")
(pathlib.Path(__file__).parent / "spindle_probe.csv").write_text("\n".join(rows) + "\n")
