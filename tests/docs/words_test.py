#!/usr/bin/env python3
"""Users read the words of their field: VIM, GUM, ISO 230. What was private idiom once does not come back in help, outputs, documents or pages.

Usage: words_test.py PROGRAM
"""
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else ROOT / "build/tools/twinbench"

def section(name):
    """{what is not said any more: what is said instead} of tests/data/words.txt."""
    lines = (ROOT / "tests/data/words.txt").read_text().split(f"## {name}\n")[1].split("\n\n")[0].splitlines()
    return dict(line.split(" => ") for line in lines)

EVERYWHERE, IN_HELP_AND_OUTPUTS, IN_DOCUMENTS = map(section, ("everywhere", "in help and outputs", "in documents"))

def said(text, words):
    """[(line, what should be said)] of everything in the text that is not said any more."""
    found = []
    for pattern, instead in words.items():
        for match in re.finditer(pattern, text):
            line = text[text.rfind("\n", 0, match.start()) + 1:].split("\n", 1)[0].strip()
            found.append(f'"{match.group().strip()}" in "{line[:140]}": say {instead}')
    return found

def program(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=True).stdout

def prose(page):
    """Of a document without its commands and code words; of a scenario the comments."""
    text = page.read_text()
    if page.suffix == ".toml":
        return "\n".join(line[line.index("#"):] for line in text.splitlines() if "#" in line and line[: line.index("#")].count('"') % 2 == 0)
    return re.sub(r"```.*?```|`[^`\n]*`", "``", text, flags=re.DOTALL)

def literals(source):
    """Texts in quotes of a script, in lines that are no comment."""
    lines = [line for line in source.read_text().splitlines() if not line.lstrip().startswith(("//", "*", "/*", "#include"))]
    return "\n".join(m.group(0)[1:-1] for line in lines for m in re.finditer(r'"(?:[^"\\]|\\.)*"|`[^`]*`', line))

class Words(unittest.TestCase):
    maxDiff = None

    def test_of_help(self):
        commands = re.findall(r"^  ([a-z]+) +[A-Z]", program("--help").split("Subcommands:")[1].split("\n\n")[0], re.MULTILINE)
        self.assertIn("diagnose", commands)
        texts = {"--help": program("--help"), **{c: program(c, "--help") for c in commands}, "list": program("list")}
        texts.update({f"help {topic}": program("help", topic) for topic in ("effects", "bench", "dialogue", "map")})
        texts["help scenario"] = program("help", "scenario")
        for name, text in texts.items():
            with self.subTest(name):
                self.assertEqual(said(text, EVERYWHERE | IN_HELP_AND_OUTPUTS), [])

    def test_of_outputs(self):
        kept = (ROOT / "tests/data/texts.txt").read_text()
        self.assertEqual(said(re.sub(r"(?m)^- .*; expected .*$|^[=#] .*$", "", kept), EVERYWHERE | IN_HELP_AND_OUTPUTS), [])

    def test_of_documents_and_scenarios(self):
        pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md")), *sorted((ROOT / "scenarios").rglob("*.md")),
                 *sorted((ROOT / "scenarios").rglob("*.toml"))]
        for page in pages:
            with self.subTest(page.name):
                self.assertEqual(said(prose(page), EVERYWHERE | IN_DOCUMENTS), [])

    def test_of_pages(self):
        for folder, endings in (("tools/web/src", (".js",)), ("twin/report/page", (".cc",)), ("tools/live", (".cc",)), ("twin/campaign", (".cc",))):
            for source in sorted((ROOT / folder).rglob("*")):
                if source.suffix not in endings:
                    continue
                with self.subTest(source.name):
                    self.assertEqual(said(literals(source), EVERYWHERE | IN_HELP_AND_OUTPUTS), [])

    def test_of_what_the_program_can_say(self):
        for source in sorted((ROOT / "twin").rglob("*.cc")) + sorted((ROOT / "tools/twinbench").glob("*.cc")) + sorted((ROOT / "tools/python").rglob("*.py")):
            with self.subTest(source.name):
                self.assertEqual(said(literals(source), EVERYWHERE), [])

if __name__ == "__main__":
    unittest.main()
