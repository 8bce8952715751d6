#!/usr/bin/env python3
"""Writes ball_bar.csv beside it: a ball bar of 100 mm on a machining centre, one circle each way. Shares nothing with the program.

Hidden: the angle from +X to +Y is 40 microradian (8.25 arcsec) too large, X has 4 um of backlash and moves 12 um/m too far, Y 5 um/m too
little; the ball stands (15, -9) um off the centre. Noise of the bar 0.1 um.
"""
import math
import pathlib
import random

RADIUS_UM = 100000.0
draw = random.Random(100)


def deviation_um(angle, direction):
    x, y = RADIUS_UM * math.cos(angle), RADIUS_UM * math.sin(angle)
    along = math.remainder(direction * angle, math.pi)  # X turns round at 0 and at 180 deg
    since = RADIUS_UM * (1.0 - math.cos(along if along >= 0.0 else along + math.pi))
    sense = -1.0 if y * direction > 0.0 else 1.0
    behind = sense * (2.0 - min(since, 4.0))
    return math.hypot(15.0 + x * (1.0 + 12e-6) - 40e-6 * y + behind, -9.0 + y * (1.0 - 5e-6)) - RADIUS_UM + draw.gauss(0.0, 0.1)


rows = ["Ball bar, XY plane; made by ball_bar.py, which says what is hidden here", "Radius [mm];100", "Feed [mm/min];1000", "Direction;Angle [deg];Deviation [um]"]
for direction, name in [(1, "CCW"), (-1, "CW")]:
    for step in range(360):
        angle_deg = step + 0.3 if direction > 0 else 359.7 - step
        rows.append(f"{name};{angle_deg:.1f};{deviation_um(math.radians(angle_deg), direction):.2f}")
(pathlib.Path(__file__).parent / "ball_bar.csv").write_text("\n".join(rows) + "\n")
