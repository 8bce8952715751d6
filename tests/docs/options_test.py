#!/usr/bin/env python3
"""An option that several commands have means the same in all of them: it is hung under them in one place and explained in the same words.

Usage: options_test.py PROGRAM
"""
import re
import subprocess
import sys
import unittest

PROGRAM = sys.argv.pop(1)
EVERY_COMMAND = ("--help", "--json", "--quiet", "--verbose", "--version")
# What a command writes or reads there is said in its own words; one sense, many things.
OWN_WORDS = ("--json", "--scenario")
# One name for two things, which scripts use as they are: see the help of both commands.
TWO_SENSES = {
    "--readings": "export: the file, as -o; plan: a budget in readings",
    "--tables": "separate: the folder, as -o; serve: how tables are driven",
    "--goal": "plan: a result; investigate: a result and the uncertainty to be reached",
    "--seed": "run: of the scenario; uncertainty: of the trials",
    "--bench": "explain: the name of a bench; else a bench file",
    "--resume": "campaign: a table; measure: a run",
}


def program(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)


def options_of(command):
    """{"--set": what the help says of it, with what it takes}."""
    text = program(command, "--help").stdout.split("\nOptions:\n")[1].split("\n\nExit codes")[0]
    found = {}
    for entry in re.split(r"\n(?=  -)", text):
        words = re.sub(r"\s+", " ", entry).strip()
        names, rest = re.match(r"((?:-{1,2}[a-z-]+,?)+) ?(.*)", words).groups()
        for name in re.findall(r"--[a-z-]+", names):
            found[name] = re.sub(r"^[A-Z].*?=\S+ ", "", rest) if name == "--output" else rest
    return found


class Options(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        names = re.findall(r"^  ([a-z]+) +[A-Z]", program("--help").stdout.split("Subcommands:")[1].split("\n\n")[0], re.MULTILINE)
        cls.options = {name: options_of(name) for name in names}

    def test_every_command_has_those_that_all_have(self):
        for name, options in self.options.items():
            self.assertEqual([o for o in EVERY_COMMAND if o not in options], [], name)
            said = program(name, "--version")
            self.assertEqual((said.returncode, said.stderr), (0, ""), name)
            self.assertEqual(said.stdout, program("--version").stdout, name)

    def test_one_that_several_have_is_explained_alike(self):
        senses = {}
        for name, options in self.options.items():
            for option, text in options.items():
                senses.setdefault(option, {}).setdefault(text, []).append(name)
        for option, texts in senses.items():
            if option == "--output":  # where a command writes what it makes
                self.assertEqual([t for t in texts if not re.search(r"write [^;]* here(, - for stdout)?$", t)], [])
            elif option not in (*OWN_WORDS, *TWO_SENSES):
                self.assertEqual(len(texts), 1, f"{option}: {texts}")

    def test_quiet_shows_no_progress_and_verbose_says_how_long_it_took(self):
        self.assertEqual(program("list", "--quiet").stderr, "")
        self.assertEqual(program("list", "--quiet").stdout, program("list").stdout)
        self.assertRegex(program("list", "--verbose").stderr, r"^twinbench list: [0-9.]+ s, [0-9.]+ s of CPU time\n$")
        self.assertEqual(program("list", "--quiet", "--verbose").returncode, 2)


if __name__ == "__main__":
    unittest.main()
