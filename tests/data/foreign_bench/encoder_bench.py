"""A shaft with two encoders behind a Modbus gateway: a reference, and a device that is mounted at an angle, in closed form.

usage: encoder_bench.py shown.json [device.kind@event ...] [rtu]   (line_devices.py says which faults there are)

Devices: `controller` (esp_controller.py), `hand` (which mounts), and `gateway`: Modbus by pymodbus, a program of others, unit 3, over TCP or,
with `rtu`, over a serial line, where an answer has no number and a late one looks like the next. Its events are readings; its faults are `late`, and `refuse`, an exception instead of the registers. Input register 20: the reference, 21 and 20 being the high and
the low word of millionths of a degree. Register 22: the device, a float of degrees, high word first.

At the shaft's angle a the reference shows a + R(a); mounted at m the device shows d + D(d), d = a + m. Written to shown.json: the ports,
the gateway's address, and the waves of R and D.
"""
import asyncio
import logging
import math
import os
import random
import struct
import sys
import threading
import time
import tty

from pymodbus.datastore import ModbusServerContext, ModbusSlaveContext
from pymodbus.datastore.store import BaseModbusDataBlock
from pymodbus.server.async_io import ModbusSerialServer, ModbusTcpServer

from esp_controller import EspController
from line_devices import LATE_S, Device, Hand, show

FIRST, WORDS, UNIT = 20, 4, 3
MOUNTING_DEG = (0.0, 90.0, 210.0)
REFERENCE = ({"order": 1, "amplitude_arcsec": 1.5, "phase_deg": 40.0},)
NOISE_ARCSEC = 0.1  # of the device; its float has steps of 0.1 arcsec
DEVICE = ({"order": 1, "amplitude_arcsec": 6.0, "phase_deg": -70.0}, {"order": 2, "amplitude_arcsec": 3.0, "phase_deg": 15.0})


def error_deg(waves, angle_deg):
    return sum(wave["amplitude_arcsec"] * math.cos(math.radians(wave["order"] * angle_deg + wave["phase_deg"])) for wave in waves) / 3600.0


class Registers(BaseModbusDataBlock):
    """What both encoders show at the instant of a request."""

    def __init__(self, axis, hand, gateway):
        self.axis, self.hand, self.gateway = axis, hand, gateway
        self.chance = random.Random(20)

    def validate(self, address, count=1):
        inside = FIRST <= address and address + count <= FIRST + WORDS
        return inside and self.gateway.happen() != "refuse"

    def getValues(self, address, count=1):
        if self.gateway.take_due() == "late":
            time.sleep(LATE_S)
        shaft_deg = self.axis.place()
        reference = round((shaft_deg + error_deg(REFERENCE, shaft_deg)) * 1e6) & 0xFFFFFFFF
        device_deg = shaft_deg + MOUNTING_DEG[self.hand.set_up or 0]
        high, low = struct.unpack(">HH", struct.pack(">f", device_deg % 360.0 + error_deg(DEVICE, device_deg) + self.chance.gauss(0.0, NOISE_ARCSEC) / 3600.0))
        words = [reference & 0xFFFF, reference >> 16, high, low]
        return words[address - FIRST:address - FIRST + count]


class Gateway(Device):
    name = "gateway"


async def serve_tcp(context, address):
    server = ModbusTcpServer(context, address=("127.0.0.1", 0))
    running = asyncio.ensure_future(server.serve_forever())
    await server.serving
    address.append(f"tcp:127.0.0.1:{server.server.sockets[0].getsockname()[1]}")
    await running


def relay(source, sink):
    while some := os.read(source, 4096):
        os.write(sink, some)


async def serve_rtu(context, address):
    """A serial line is two pseudo terminals and whoever carries bytes between them."""
    (near, near_file), (far, far_file) = os.openpty(), os.openpty()
    for end in (near_file, far_file):
        tty.setraw(end)
    for source, sink in ((near, far), (far, near)):
        threading.Thread(target=relay, args=(source, sink), daemon=True).start()
    server = ModbusSerialServer(context, port=os.ttyname(far_file), baudrate=115200)
    await server.start()
    address.append(f"serial:{os.ttyname(near_file)}:115200:8E1")
    await server.serve_forever()


def main():
    logging.disable(logging.CRITICAL)
    controller, hand, gateway = EspController(sys.argv[2:]), Hand(sys.argv[2:]), Gateway(sys.argv[2:])
    unit = ModbusSlaveContext(ir=Registers(controller.axes[0], hand, gateway), zero_mode=True)
    serve = serve_rtu if "rtu" in sys.argv[2:] else serve_tcp
    address = []
    forever = serve(ModbusServerContext({UNIT: unit}, single=False), address)
    threading.Thread(target=asyncio.run, args=(forever,), daemon=True).start()
    while not address:
        time.sleep(0.01)
    show([controller, hand], {"reference": REFERENCE, "device": DEVICE, "gateway": address[0]}, sys.argv[1])


main()
