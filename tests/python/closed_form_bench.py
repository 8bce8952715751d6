"""A rotary bench of closed-form optics that shares nothing with the twin: rays as vectors, frames of the README's bench."""

import tomllib

import numpy as np
import twinbench as tb


class ClosedFormBench(tb.RotaryBench):
    def __init__(self, scenario_toml: str):
        super().__init__()
        s = tomllib.loads(scenario_toml)
        self.random = np.random.default_rng([s["seed"], s["repeat"]])
        self.offset_V = np.array(s["amplifier"]["offset_mV"]) / 1e3
        self.noise_V = np.hypot(s["amplifier"]["noise_mV"] / 1e3, 2e-3)  # and what the light brings

    # Errors of the tables, by their own angles [arcsec].
    @staticmethod
    def target_arcsec(angle_rad):
        return 6.0 * np.cos(angle_rad + 0.4) + 2.5 * np.sin(5.0 * angle_rad)

    @staticmethod
    def reference_arcsec(angle_rad):
        return 4.0 * np.sin(2.0 * angle_rad) + 1.5 * np.cos(7.0 * angle_rad + 1.0)

    def volts(self, target_rad, reference_rad, n_samples):
        errors_rad = np.radians((self.target_arcsec(target_rad) + self.reference_arcsec(reference_rad)) / 3600.0)
        turned_rad = target_rad + reference_rad + self.reseat_rad - self.clamp_rad + errors_rad
        yaw_rad = (turned_rad + np.pi) % (2.0 * np.pi) - np.pi
        spots = self.spots_m(yaw_rad, self.yaw_rad, self.tilt_rad)
        if spots is None or np.abs(spots).max() > 5e-3:
            return "no_light"
        return 2000.0 * spots + self.offset_V + self.noise_V * self.random.standard_normal((n_samples, 4))

    @staticmethod
    def spots_m(table_rad, yaw_rad, tilt_rad, l1=0.12, order=650e-9 * 600e3):
        """u and v on both PSDs: the light keeps its component along the grooves and gains m lambda rho across them."""
        c, s = np.cos(table_rad + yaw_rad), np.sin(table_rad + yaw_rad)
        groove = np.array([s * np.sin(tilt_rad), -c * np.sin(tilt_rad), np.cos(tilt_rad)])
        normal = np.array([-s * np.cos(tilt_rad), c * np.cos(tilt_rad), np.sin(tilt_rad)])
        across, beam = np.array([c, s, 0.0]), np.array([0.0, -1.0, 0.0])
        # The table turns the grating's point about its axis, 30 mm behind it; the goniometer turns it about the spot.
        point = np.array([-0.03 * np.sin(table_rad), 0.03 * (np.cos(table_rad) - 1.0), 0.0])
        spot = beam * (normal @ point) / (normal @ beam)
        found = []
        for m in (1, -1):
            along, lines = beam @ groove, beam @ across + m * order
            if along**2 + lines**2 >= 1.0:
                return None
            ray = along * groove + lines * across + np.sqrt(1.0 - along**2 - lines**2) * normal
            nominal = np.array([m * order, np.sqrt(1.0 - order**2), 0.0])
            u = np.array([nominal[1], -nominal[0], 0.0])
            if nominal @ ray <= 0.0:
                return None
            hit = spot + ray * (l1 - nominal @ spot) / (nominal @ ray)
            found += [u @ hit, hit[2]]
        return np.array(found)

    def autocollimator(self):
        if max(abs(self.yaw_rad), abs(self.tilt_rad)) > np.radians(410.0 / 3600.0):
            return None
        return self.yaw_rad, self.tilt_rad
