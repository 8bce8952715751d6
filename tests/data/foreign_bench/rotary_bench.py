"""Two rotary tables on each other with a grating, two position-sensitive detectors and a card, to first order.

usage: rotary_bench.py shown.json [device.kind@event ...]   (line_devices.py says which faults there are)

Devices: `controller` (axis 1 the lower table, 2 the upper), `adc` (the card, by the text protocol of iiod), `fixture` (the hand that mounts).
Written to shown.json: their ports, and what is hidden in the tables.

A grating that is turned by z about the vertical, by x about the way of the light along the bench, and that has moved by d towards it,
moves the spots of its two first orders, l away on either side, by

    across  -l (1 + 1 / cos g) z  -+ d sin g,     up  l (1 + cos g) x,     sin g = wavelength * lines.
"""
import math
import random
import socketserver
import struct
import sys
import time

from esp_controller import Axis, EspController
from line_devices import Device, ScpiDevice, mounted, show

ARCSEC = math.pi / 180.0 / 3600.0
POSITIONS = 6
SIN_ORDER = 650e-9 * 600e3
COS_ORDER = math.sqrt(1.0 - SIN_ORDER**2)
AWAY_M, VOLTS_A_METRE, NOISE_V = 0.12, 2000.0, 6e-3
STEP_V, SCANS_HZ = 10.0 / 32768, 62500
LOWER_Z, UPPER_Z = ((1, 9.0, 0.4), (2, 3.5, 2.0)), ((1, 6.0, 1.9), (2, 4.0, -0.7))  # order, arcsec, phase
LOWER_X = ((2, 5.0, 1.0),)
LOWER_D_UM = ((2, 2.0, 0.2),)
ABOVE_M = 0.13  # the spot on the grating above the lower table's origin


def wave(terms, angle_deg):
    return sum(size * math.sin(order * math.radians(angle_deg) + phase) for order, size, phase in terms)


class Stack:
    def __init__(self, axes):
        self.axes, self.seat_arcsec = axes, 0.0

    def volts(self):
        lower_deg, upper_deg = (axis.place() for axis in self.axes)
        step_deg = 360.0 / POSITIONS
        left_deg = (lower_deg + upper_deg + 0.5 * step_deg) % step_deg - 0.5 * step_deg  # the hand turned whole steps back
        z = (wave(LOWER_Z, lower_deg) + wave(UPPER_Z, upper_deg) + self.seat_arcsec) * ARCSEC + math.radians(left_deg)
        x = wave(LOWER_X, lower_deg) * ARCSEC
        d = wave(LOWER_D_UM, lower_deg) * 1e-6 - x * ABOVE_M
        turned, up = -AWAY_M * (1.0 + 1.0 / COS_ORDER) * z, AWAY_M * (1.0 + COS_ORDER) * x
        return [VOLTS_A_METRE * place for place in (turned - SIN_ORDER * d, up, turned + SIN_ORDER * d, up)]


class Fixture(ScpiDevice):
    name = "fixture"
    identity = "FOREIGN HANDS,2,0,1"

    def do(self, word):
        set_up = mounted(word)
        if set_up is None:
            return None
        self.stand.seat_arcsec = 7.0 * math.sin(1.0 + 2.0 * set_up)
        return True


class Iiod(socketserver.StreamRequestHandler):
    """As much of the text protocol as a client needs that reads blocks."""

    disable_nagle_algorithm = True

    def handle(self):
        self.mask = "0000001f"
        try:
            for line in self.rfile:
                words = line.decode("ascii", "replace").split()
                if words and not self._obey(words):
                    return
        except OSError:
            pass  # whoever asked has gone

    def _say(self, text):
        self.wfile.write(text.encode())

    def _obey(self, words):
        card, command = self.server.device, words[0].upper()
        if command == "VERSION":
            self._say("0.24.foreign\n")
        elif command == "PRINT":
            self._say(f"{len(card.XML)}\n{card.XML}\n")
        elif command == "READ":
            value = card.ATTRIBUTES.get(words[-1])
            self._say("-2\n" if value is None else f"{len(value) + 1}\n{value}\0\n")
        elif command == "WRITE":
            self.rfile.read(int(words[-1]))
            self._say("-1\n")
        elif command == "OPEN":
            self.mask = words[3]
            self._say("0\n")
        elif command in ("CLOSE", "SET", "TIMEOUT"):
            self._say("0\n")
        elif command == "READBUF":
            return self._deliver(int(words[2]))
        elif command == "EXIT":
            return False
        else:
            self._say("-22\n")
        return True

    def _deliver(self, length):
        card = self.server.device
        with self.server.lock:
            block, trouble = card.block(length), card.take_due()
        time.sleep(length / card.SCAN_BYTES / SCANS_HZ)
        if trouble == "mute":
            time.sleep(3600.0)
        self._say(f"{length}\n{self.mask}\n")
        self.wfile.write(block[: length // 2] if trouble == "drop" else block)
        return trouble != "drop"


class Card(Device):
    """Its events are blocks. A fault of its own: `gap`, scans are lost in the middle."""

    name = "adc"
    conversation = Iiod
    SCAN_BYTES = 16  # four codes and a stamp
    ATTRIBUTES = {"sampling_frequency": str(SCANS_HZ), "conversion_frequency": str(4 * SCANS_HZ), "scale": repr(1e3 * STEP_V),
                  "bits": "16", "serial": "F-0815"}
    DTD = ("<!DOCTYPE context [" + "".join(f"<!ELEMENT {name} ANY>" for name in ("context", "device", "channel", "scan-element", "attribute"))
           + "<!ATTLIST context name CDATA #IMPLIED version-major CDATA #IMPLIED version-minor CDATA #IMPLIED version-git CDATA #IMPLIED "
           "description CDATA #IMPLIED><!ATTLIST device id CDATA #IMPLIED name CDATA #IMPLIED><!ATTLIST channel id CDATA #IMPLIED "
           "type CDATA #IMPLIED><!ATTLIST scan-element index CDATA #IMPLIED format CDATA #IMPLIED><!ATTLIST attribute name CDATA #IMPLIED "
           "filename CDATA #IMPLIED>]>")  # clients validate
    XML = ('<?xml version="1.0" encoding="utf-8"?>' + DTD + '<context name="network" version-major="0" version-minor="24" '
           'version-git="foreign" description="a card of others"><device id="iio:device0" name="foreign-adc">'
           + "".join(f'<channel id="voltage{k}" type="input"><scan-element index="{k}" format="le:S16/16&gt;&gt;0" />'
                     f'<attribute name="scale" filename="in_voltage_scale" /></channel>' for k in range(4))
           + '<channel id="timestamp" type="input"><scan-element index="4" format="le:S64/64&gt;&gt;0" /></channel>'
           + "".join(f'<attribute name="{name}" />' for name in ("sampling_frequency", "conversion_frequency", "bits", "serial"))
           + "</device></context>")

    def __init__(self, script, stack):
        super().__init__(script)
        self.stack = stack
        self.blocks = {}  # by set-up and place: how many

    def block(self, length):
        """Chance is that of this block at this place, whatever went wrong before."""
        lost = self.happen() == "gap"
        place = (self.stack.seat_arcsec, *(round(axis.place(), 3) for axis in self.stack.axes))
        self.blocks[place] = self.blocks.get(place, 0) + 1
        chance = random.Random(f"{place} {self.blocks[place]}")
        volts, begin_ns, scans = self.stack.volts(), time.monotonic_ns(), length // self.SCAN_BYTES
        data = bytearray()
        for scan in range(scans):
            codes = [max(-32768, min(32767, round((volt + chance.gauss(0.0, NOISE_V)) / STEP_V))) for volt in volts]
            late = scan + 7 if lost and scan >= scans // 2 else scan
            data += struct.pack("<4hq", *codes, begin_ns + late * 1000000000 // SCANS_HZ)
        return bytes(data)


def main():
    controller = EspController(sys.argv[2:], [Axis(), Axis()])
    stack = Stack(controller.axes)
    positions = [k * 360.0 / POSITIONS for k in range(POSITIONS)]
    hidden = {"position_deg": positions}
    for what, terms in (("target.ez_arcsec", LOWER_Z), ("reference.ez_arcsec", UPPER_Z), ("target.ex_arcsec", LOWER_X),
                        ("target.dy_um", LOWER_D_UM)):
        hidden[what] = [wave(terms, at) for at in positions]
    show([controller, Card(sys.argv[2:], stack), Fixture(sys.argv[2:], stack)], hidden, sys.argv[1])


main()
