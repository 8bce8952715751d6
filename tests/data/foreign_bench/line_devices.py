"""Devices of a laboratory that answer lines of text over TCP, with faults on a script.

A device counts its events: moves of a controller, readings of an instrument, seatings of an indexer. A fault is written
<device>.<kind>@<event> and begins with that event:

    mute     one query is not answered
    late     one query is answered LATE_S too late
    drop     the connection ends instead of one answer
    freeze   nothing is answered any more on any connection; what moves goes on moving
    others   are the device's own

Shares nothing with the program that is tried on it: not a line, and the manual of no device but what is said in docs/hardware.md.
"""
import json
import os
import re
import socketserver
import sys
import threading
import time

LATE_S = 0.7
WIRE_FAULTS = ("mute", "late", "drop")
COMMANDS = re.compile(r'(?:[^;"]|"[^"]*")+')  # of a line; a semicolon in quotes is none


class Device:
    """What stands behind one TCP port of this computer. `obey` is the device's own: what a command is answered, or None."""

    name = "device"
    line_end = "\n"

    def __init__(self, script):
        self.faults = {}
        for fault in script:
            who, _, rest = fault.partition(".")
            kind, _, event = rest.partition("@")
            if who == self.name:
                self.faults[int(event)] = kind
        self.events = 0
        self.due = None  # fault on the wire that waits for a query
        self.frozen = False

    def happen(self):
        """Counts an event. Returns the kind of a fault of the device's own that begins with it, or None."""
        self.events += 1
        kind = self.faults.get(self.events)
        if kind in WIRE_FAULTS:
            self.due = kind
            return None
        self.frozen = self.frozen or kind == "freeze"
        return kind

    def take_due(self):
        kind, self.due = self.due, None
        return kind

    def obey(self, command):
        raise NotImplementedError


class ScpiDevice(Device):
    """One with an error queue, as instruments have it. `do` is its own: True, an answer, or None where it knows no such thing."""

    identity = ""

    def __init__(self, script, stand=None):
        super().__init__(script)
        self.stand = stand  # what the device is part of
        self.errors = []

    def obey(self, command):
        word = command.upper()
        if word == "*IDN?":
            return self.identity
        if word == "SYST:ERR?":
            return self.errors.pop(0) if self.errors else '0,"No error"'
        answer = self.do(word)
        if answer is None:
            self.errors.append('-113,"Undefined header"')
        return answer if isinstance(answer, str) else None

    def do(self, word):
        raise NotImplementedError


def mounted(word):
    """The number of the mounting that a hand is told to mount, or None if the command is another."""
    return int(word.split()[1].split(",")[0]) if word.startswith("FIXT:MOUN ") else None


class Hand(ScpiDevice):
    """Whoever mounts what a mounting needs."""

    name = "hand"
    identity = "FOREIGN LABORATORY,HAND,1,1"
    set_up = None

    def mount(self, set_up):
        self.set_up = set_up

    def do(self, word):
        if (set_up := mounted(word)) is not None:
            self.mount(set_up)
            return True
        return True if word == "FIXT:CLE" else None


class Conversation(socketserver.StreamRequestHandler):
    disable_nagle_algorithm = True  # else the second of several answers waits 40 ms for the first to be acknowledged

    def handle(self):
        try:
            for line in self.rfile:
                if not self.answer(line.decode("ascii", "replace").strip()):
                    return
        except OSError:
            pass  # whoever asked has gone

    def answer(self, line):
        """Returns False where the connection shall end."""
        device, lock = self.server.device, self.server.lock
        for command in COMMANDS.findall(line):
            with lock:
                if device.frozen:
                    continue
                answer = device.obey(command.strip())
                trouble = device.take_due() if answer is not None and not device.frozen else None
                if answer is None or device.frozen:
                    continue
            if trouble == "drop":
                return False
            if trouble == "mute":
                continue
            if trouble == "late":
                time.sleep(LATE_S)
            self.wfile.write((answer + device.line_end).encode())
        return True


class _Port(socketserver.ThreadingTCPServer):
    allow_reuse_address = True
    daemon_threads = True

    def __init__(self, device, lock):
        super().__init__(("127.0.0.1", 0), getattr(device, "conversation", Conversation))
        self.device, self.lock = device, lock


def show(devices, told, path):
    """Serves every device on a port of its own, as long as stdin is open.

    path: of a JSON file that appears once all of them can be reached: `told`, and the ports by the devices' names.
    """
    lock = threading.RLock()  # one physics for all
    ports = {}
    for device in devices:
        port = _Port(device, lock)
        ports[device.name] = port.server_address[1]
        threading.Thread(target=port.serve_forever, daemon=True).start()
    with open(path + ".part", "w") as file:
        json.dump({"ports": ports, **told}, file)
    os.rename(path + ".part", path)
    sys.stdin.read()
