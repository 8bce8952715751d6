"""A machine run by LinuxCNC, as its remote shell linuxcncrsh shows it, with a joint an axis; and a look at one that runs elsewhere.

The words and the ends of lines are those of linuxcncrsh(1) and of what LinuxCNC 2.9 was seen to answer: `get` ends in CR LF, `set` in LF CR. A block
that goes too far is acknowledged and complained about afterwards.
"""
import re
import socket
import time

from esp_controller import DEGREES, MILLIMETRES, Axis, EspController
from line_devices import Conversation, Device

WORD = re.compile(r"([ABCFXYZ])(\[[^ ]*\]|[-+0-9.]+)")
LIMIT = re.compile(r"\[\[#<_ini\[axis_([abcxyz])\](min|max)_limit>\+([0-9.]+)\]\*([0-9.]+)\]")
PLACES, ROTARY = "XYZABC", "ABC"


class Shell(Conversation):
    """Echoes what it is told until it is told not to, and acknowledges nothing until it is told to."""

    def handle(self):
        self.echoes, self.acknowledges, self.greeted = True, False, False
        super().handle()

    def say(self, text):
        self.wfile.write(text.encode())

    def answer(self, line):
        device, lock = self.server.device, self.server.lock
        with lock:
            if device.frozen:
                return True
            if self.echoes and self.greeted:
                self.say(line + "\r\n")
            said = self.obey(device, line)
            trouble = device.take_due() if said else None
        if trouble == "drop":
            return False
        if trouble != "mute" and not device.frozen:
            self.say(said)
        return True

    def obey(self, device, line):
        verb, _, rest = line.partition(" ")
        if verb.lower() == "hello":
            self.greeted = rest.split()[:1] == ["EMC"]
            return "HELLO ACK EMCNETSVR 1.1\r\n" if self.greeted else "HELLO NAK\r\n"
        if not self.greeted:
            return ""
        name, _, value = rest.partition(" ")
        name = name.lower()
        if verb.lower() == "get":
            told = ("ON" if device.obeyed is self else "OFF") if name == "enable" else device.tell(name)
            return f"{name.upper()} {told}\r\n"
        done = self.set(device, name, value)
        return f"SET {name.upper()} {'ACK' if done else 'NAK'}\n\r" if self.acknowledges or not done else ""

    def set(self, device, name, value):
        if name == "echo":
            self.echoes = value == "on"
        elif name == "verbose":
            self.acknowledges = value == "on"
        elif name == "enable":
            if value == "EMCTOO":
                device.obeyed = self
            return device.obeyed is self
        elif name != "set_wait":
            return device.obeyed is self and device.do(name, value)
        return True


class LinuxCncController(Device):
    """Its events are moves. Faults of its own: `estop`, somebody presses the emergency stop as the move begins; `taken`, another client says the
    password, and this one is not obeyed any more.
    """

    name = "controller"
    conversation = Shell

    def __init__(self, script, letters="ABC"):
        super().__init__(script)
        self.letters = letters
        self.axes = [Axis() for _ in letters]
        self.lower, self.upper = -800.0, 800.0
        self.mode, self.is_on, self.estop, self.homed, self.feed = "MANUAL", True, False, True, 0.0
        self.errors = []
        self.obeyed = None  # the conversation that said the password last

    def tell(self, name):
        rotary = [letter in ROTARY for letter in self.letters]
        joints = {"joint_homed": ["YES" if self.homed else "NO"] * len(rotary), "joint_limit": ["OK"] * len(rotary), "joint_fault": ["OK"] * len(rotary),
                  "joint_type": ["ANGULAR" if each else "LINEAR" for each in rotary], "joint_units": ["DEG" if each else "MM" for each in rotary]}
        if name in joints:
            return " ".join(joints[name])
        if name in ("abs_cmd_pos", "abs_act_pos"):
            places = {letter: axis.place() for letter, axis in zip(self.letters, self.axes)}
            return " ".join(f"{places.get(letter, 0.0):.6f}" for letter in PLACES)
        if name == "error":
            return self.errors.pop(0) if self.errors else "OK"
        moves = not all(axis.is_done() for axis in self.axes)
        return {"machine": "ON" if self.is_on else "OFF", "estop": "ON" if self.estop else "OFF", "mode": self.mode,
                "program_status": "RUNNING" if moves else "IDLE", "program_codes": f"G0 G17 G53 F{self.feed:.0f} S0"}[name]

    def do(self, name, value):
        if name == "mdi":
            return self.is_on and self.mode == "MDI" and self.block(value)
        if name == "mode":
            self.mode = value.upper()
            return self.is_on
        if name == "abort":
            for axis in self.axes:
                axis.stop()
            return True
        if name == "machine":
            self.is_on = value == "on" and not self.estop
            return self.is_on
        if name == "home":
            for axis in self.axes:
                axis.find_origin()
            self.homed = True
            return True
        return False

    def block(self, text):
        places = {}
        for letter, number in WORD.findall(text.upper()):
            limit = LIMIT.fullmatch(number.lower())
            if limit:
                number = (self.lower if limit[2] == "min" else self.upper) + float(limit[3])
                number *= float(limit[4])
            if letter == "F":
                self.feed = float(number)
            else:
                places[letter] = float(number)
        for letter, place in places.items():
            if not self.lower <= place <= self.upper:
                self.errors.append(f"Linear move on line 0 would exceed {letter}'s {'positive' if place > 0.0 else 'negative'} limit")
                return True
        own = self.happen() if places else None
        for letter, place in places.items():
            self.axes[self.letters.index(letter)].go(place)
        if own == "freeze":
            for axis in self.axes:
                axis.takes_s *= 100.0  # it is on its way for long
        if own == "taken":
            self.obeyed = None
        if own == "estop":
            self.estop, self.is_on = True, False
            for axis in self.axes:
                axis.stop()
        return True


class AxesElsewhere:
    """Axes of a machine that LinuxCNC runs somewhere else: where they stand."""

    def __init__(self, address, letters):
        host, _, port = address.rpartition(":")
        self.line = socket.create_connection((host, int(port)), 5.0).makefile("rw", newline="\r\n")
        self.letters = letters
        self.ask("hello EMC stand 1.0")
        self.ask("set echo off")

    def ask(self, line):
        self.line.write(line + "\r\n")
        self.line.flush()
        return self.line.readline().split()

    def places(self):
        told = self.ask("get abs_act_pos")[1:]
        return [float(told[PLACES.index(letter)]) for letter in self.letters]


def controlled(words, letters, of_machine=None):
    """What moves the axes of a bench: an ESP controller, with controller=linuxcnc a machine here, with controller=HOST:PORT one elsewhere.

    words: of the command line, faults among them. of_machine: the letters of all axes of a LinuxCNC machine here. Returns the devices that the
    bench shows, and who tells where the axes are.
    """
    kind = next((word.partition("=")[2] for word in words if word.startswith("controller=")), "esp")
    script = [word for word in words if "=" not in word]
    if kind == "esp":
        controller = EspController(script, [Axis(DEGREES if letter in ROTARY else MILLIMETRES) for letter in letters])
        axes = controller.axes
    elif kind == "linuxcnc":
        controller = LinuxCncController(script, of_machine or letters)
        axes = [controller.axes[controller.letters.index(letter)] for letter in letters]
    else:
        return [], AxesElsewhere(kind, letters).places
    return [controller], lambda: [axis.place() for axis in axes]
