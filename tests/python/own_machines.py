"""Benches with machines in some 30 lines each: closed forms that share nothing with the twin, with an error of their own to be found."""

import math
import tomllib

import numpy as np
import twinbench as tb

ARCSEC = math.radians(1.0 / 3600.0)


class Turntable(tb.MachineBench):
    """A turntable with an error of order 3 under a multi-tooth table with one of order 2; the autocollimator sees their sum."""

    def __init__(self, scenario):
        super().__init__(scenario)
        self.random = np.random.default_rng(scenario.seed)
        shifts = scenario["turntable_procedure.shifts_teeth"]
        self.begin_rad = [math.radians(shift) for shift in shifts]  # the tooth at which the mirror is seen with the turntable at 0

    @staticmethod
    def turntable_arcsec(angle_rad):
        return 4.0 * np.cos(3.0 * angle_rad + 0.3)

    @staticmethod
    def multitooth_arcsec(angle_rad):
        return 1.5 * np.sin(2.0 * angle_rad)

    def show(self, at):
        errors_rad = (self.turntable_arcsec(at[0]) + self.multitooth_arcsec(self.tooth_rad)) * ARCSEC
        yaw_rad = math.remainder(at[0] + self.tooth_rad - self.begin_rad[self.setup] + errors_rad, 2.0 * math.pi)
        if abs(yaw_rad) > 1000.0 * ARCSEC:
            return "no_light"
        x, y = self.random.normal([yaw_rad / ARCSEC, 0.0], 0.05)
        return {"autocollimator_x_arcsec": x, "autocollimator_y_arcsec": y, "temperature_degC": 20.0}


class HobbingMachine(tb.MachineBench):
    """A hob and a table that follows it with an error once a turn; both encoders count lines, the table's has an error of order 1 too."""

    def __init__(self, scenario):
        super().__init__(scenario)
        self.random = np.random.default_rng(scenario.seed)
        self.ratio = scenario["transmission.hob_starts"] / scenario["transmission.gear_teeth"]
        self.lines = scenario["table_encoder.lines"]
        self.heads_rad = np.radians(scenario["hob_procedure.heads_deg"])

    @staticmethod
    def chain_arcsec(table_rad):
        return 9.0 * np.cos(table_rad + 0.7) + 2.0 * np.sin(22.0 * table_rad)

    @staticmethod
    def ring_arcsec(ring_rad):
        return 5.0 * np.cos(ring_rad - 1.1)

    def table_rad(self, hob_rad):
        return hob_rad * self.ratio + self.chain_arcsec(hob_rad * self.ratio) * ARCSEC

    def encoder_rad(self, hob_rad):
        table_rad = self.table_rad(hob_rad)
        return table_rad + self.ring_arcsec(table_rad - self.heads_rad[self.setup]) * ARCSEC

    def count(self, at):
        return self.encoder_rad(at[0]) * self.lines / (2.0 * math.pi)

    def show(self, at):
        table_deg = math.degrees(self.encoder_rad(at[0])) + self.random.normal(0.0, 0.1 / 3600.0)
        return {"table_encoder_deg": table_deg, "hob_encoder_deg": math.degrees(at[0])}


class Circles(tb.MachineBench):
    """Two axes that are not square and one that is too long, under a ball bar with an encoder and on a grid plate."""

    squareness_rad, scale_x = 10.0 * ARCSEC, 20e-6

    def __init__(self, scenario):
        super().__init__(scenario)
        self.random = np.random.default_rng(scenario.seed)
        self.setups = scenario["circular_procedure.setups"]

    def show(self, at):
        x_m, y_m = at[0] * (1.0 + self.scale_x) - at[1] * self.squareness_rad, at[1]
        shown = {"temperature_degC": 20.0}
        if self.setups[self.setup]["instrument"] == "bar":
            length_um = 1e6 * math.hypot(x_m, y_m) - 1e3 * self.setups[self.setup]["radius_mm"]
            angle_deg = math.degrees(math.atan2(y_m, x_m))
            return shown | {"bar_um": self.random.normal(length_um, 0.1), "encoder_deg": self.random.normal(angle_deg, 1e-4)}
        x_mm, y_mm = self.random.normal([1e3 * x_m, 1e3 * y_m], 5e-5)
        return shown | {"grid_x_mm": x_mm, "grid_y_mm": y_mm}


class Shaft(tb.MachineBench):
    """An angle device with an error of order 3 on a shaft whose reference has none, read at stops."""

    def __init__(self, scenario):
        super().__init__(scenario)
        self.random = np.random.default_rng(scenario.seed)
        self.mounting_rad = np.radians(scenario["encoder_procedure.mounting_deg"])

    @staticmethod
    def device_arcsec(angle_rad):
        return 20.0 * np.cos(3.0 * angle_rad)

    def show(self, at):
        device_rad = at[0] - self.mounting_rad[self.setup]
        measured_rad = at[0] + self.device_arcsec(device_rad) * ARCSEC
        return {"reference_deg": math.degrees(at[0]), "measured_deg": self.random.normal(math.degrees(measured_rad), 1e-5)}


class FiveAxes(tb.MachineBench):
    """A probe of laser, quadrant detector and triangulation over an array of paraboloids; the X slide sags."""

    sag_um = 30.0  # of the slide at the ends of its travel

    def __init__(self, scenario):
        super().__init__(scenario)
        self.s, self.random = tomllib.loads(scenario.toml()), np.random.default_rng(scenario.seed)
        self.mounts = self.s["freeform_procedure"]["mounts"]

    def facing(self, tip, normal, pitch_m):
        """Vertex and radius of the paraboloid of the array, of two kinds like a chessboard, that faces the beam."""
        found = []
        for parity, radius_m in enumerate(1e-3 * np.array(self.s["artefact"]["vertex_radius_mm"])):
            off = -radius_m * normal[:2] / normal[2]
            vertex = tip[:2] - off - (tip[2] - off @ off / (2.0 * radius_m)) * normal[:2] / normal[2]
            cell = np.rint(vertex / pitch_m)
            if cell.sum() % 2 == parity:
                found.append((np.linalg.norm(vertex - cell * pitch_m), cell * pitch_m, radius_m))
        return min(found, key=lambda one: one[0])[1:]

    def show(self, at):
        s, mount = self.s, self.mounts[self.setup]
        a, b, yaw = at[3], at[4], math.radians(mount.get("yaw_deg", 0.0))
        pivot_m, pitch_m = 1e-3 * s["machine"]["pivot_mm"], 1e-3 * s["artefact"]["pitch_mm"]
        turn_a = np.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]])
        turn_b = np.array([[math.cos(b), 0, math.sin(b)], [0, 1, 0], [-math.sin(b), 0, math.cos(b)]])
        home = np.array([[math.cos(yaw), math.sin(yaw), 0], [-math.sin(yaw), math.cos(yaw), 0], [0, 0, 1]])
        sag_m = 1e-6 * self.sag_um * (1e3 * at[0] / s["machine"]["x_half_mm"]) ** 2
        tip = turn_a @ turn_b @ [0, 0, -pivot_m] + [-at[0], at[1], at[2] + pivot_m + sag_m]
        tip = home @ (tip - 1e-3 * np.array([mount.get(f"{axis}_mm", 0.0) for axis in "xyz"]))
        tool = home @ turn_a @ turn_b
        vertex, radius_m = self.facing(tip, tool[:, 2], pitch_m)
        tip, beam, reach_m = tip - [*vertex, 0.0], -tool[:, 2], 0.0
        for _ in range(6):
            p = tip + reach_m * beam
            reach_m -= (p[2] - p[:2] @ p[:2] / (2 * radius_m)) / (beam[2] - p[:2] @ beam[:2] / radius_m)
        hit = tip + reach_m * beam
        up = np.array([*(-hit[:2] / radius_m), 1.0])
        back = tool.T @ (beam - 2 * (beam @ up) / (up @ up) * up)
        k, half_gap_m = math.sqrt(2.0) / (1e-3 * s["qpd"]["spot_radius_mm"]), 0.5e-3 * s["qpd"]["gap_mm"]
        balance = []
        for spot_m in 1e-3 * s["qpd"]["lens_mm"] * back[:2] / back[2]:
            above, below = math.erf(k * (spot_m - half_gap_m)), math.erf(k * (spot_m + half_gap_m))
            balance.append((0.5 * (above + below), 1.0 + 0.5 * (above - below)))
        (x, light_x), (y, light_y) = balance
        alpha, object_mm, image_mm = math.radians(s["ccd"]["alpha_deg"]), s["ccd"]["object_mm"], s["ccd"]["image_mm"]
        beta = math.atan2(object_mm * math.sin(alpha), image_mm * math.cos(alpha))
        spot_mm = image_mm * math.sin(alpha) / (1e-3 * object_mm * math.sin(beta) / reach_m + math.sin(alpha + beta))
        qpd_V = s["qpd"]["sum_V"] * np.array([x * light_y, y * light_x]) + self.random.normal(0.0, 1e-3 * s["qpd"]["noise_mV"], 2)
        ccd_px = s["ccd"]["centre_px"] + 1e3 * spot_mm / s["ccd"]["pixel_um"] + self.random.normal(0.0, s["ccd"]["noise_px"])
        return {"qpd_x_V": qpd_V[0], "qpd_y_V": qpd_V[1], "ccd_px": ccd_px, "temperature_degC": 20.0}
