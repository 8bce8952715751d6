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

# What is not said any more -> what is said instead. Keys, columns, JSON and names of effects are formats and stay: they stand in code, in
# quotes or with an underscore, and no pattern meets them.
EVERYWHERE = {
    r"\bcarr(y|ies) (out a|a|one|the) scenario( out)?\b": "simulate a scenario",
    r"\b(show|shows|shown) the twin as hardware\b|\btwin shown as\b": "emulate the bench as network instruments",
    r"\banybody's recording\b": "a recording",
    r"\bsay how certain\b": "uncertainty budget",
    r"\bone cause after the other\b": "variance contribution of each source, switched off one at a time",
    r"\bAgrees: ": "Consistent with the scenario:",
    r"(?m)^(- )?(Named|Tie|Unknown): ": "Cause identified: / Ambiguous: / Unmodelled effect:",
    r"\b(structure|something|shapes?|causes?|signals?) (without a|that has no) name\b": "unmodelled effect",
    r"\bwhat (the|the believed) scenario leaves\b": "residual of",
    r"\b(look|looks|what looked) the same in this run\b": "indistinguishable in this run (aliased)",
    r"(?m)^(! )?Gain: ": "Held-out improvement:",
    r"\b(what )?cannot be separated\b": "not separable",
    r"\bharmonics? (is |are )?lost\b": "not separable, not observable",
    r"\bturned about (its nominal order|the beam)\b": "rotated about the diffracted beam",
    r"\brigorous: ours\b|\bthe rigorous (one|result)\b": "weighted least squares (exact model)",
    r"\bthe faces have them\b": "not separable from the polygon with these offsets",
    r"\bvariance, mean\b": "mean variance factor",
    r"\bno set below\b": "lower bound",
    r"\bfrom this size on\b|\buntil then it moves\b": "smallest detectable, undetected bias",
    r"\bbit (a|per) minute\b": "information rate [bit/min]",
    r"\bbit of (causes|results)\b": "information about causes [bit]",
    r"(?i)\bcannot be told\b": "not resolvable on this bench",
    r"\btold apart\b|\btell(s)? apart\b": "separated, distinguished",
    r"\bcosts an attempt\b": "faults trigger a retry; no reading is lost",
    r"(?i)\b(beside it )?lies the truth\b": "the true errors are stored alongside",
    r"\blocked to\b": "synchronous with, function of",
    r"\bslow wander\b|\brandom wander\b": "slow drift, random walk",
    r"\btake an effect out of the catalogue\b": "exclude an effect",
    r"\bwas touched\b|\btouches that\b": "transient",
    r"\bthis is no seed\b": "invalid seed",
    r"\bthere is no place for\b": "unexpected argument",
    r"(?<!-)\b1 (readings|causes|trials|pairs|turns)\b(?! (of|in) \d)": "singular",
    r"\b(lines|samples|stops|periods|positions|once|twice|times) a turn\b": "per turn",
    r"(?<![\w+])\+-(?= ?[\d{])": "±",
    r"\b[Ss]et-ups?\b": "mounting",
    r"\b(is|are|was|were|(?<!more can )be|been|not) told\b|\b[Tt]old (apart|from|by)\b": "concluded, stated, commanded, separated",
    r"\bother courses? of\b|\bcourses of (effects|disturbances)\b": "time function, recorded conditions, path",
    r"\b(at|from|of|off|between|every|each|other|usable|first|same|neighbouring|without) (a |its |the same |measured )?stops?\b(?!\.csv|_)": "measuring position",
    r"(?<=[\d.] )(um|degC|urad)\b(?! (above|from|rms)\b)": "µm, °C, µrad",
}
IN_HELP_AND_OUTPUTS = {
    r"\bthe twin as\b": "the bench",
    r"(?<!-)\bfaint\b": "smallest effect to detect",
    r"\bunlisted [a-z]": "not in the catalogue",
    r"\brestless": "disturbance",
    r"\breclamped\b|\breseated\b": "remounted on the rotor, whole table re-mounted",
}
IN_DOCUMENTS = {
    r"(?i)\b(a|the|this|these|every|one) rooms? `": "module",
    r"(?i)\bmodule's rooms\b|\btwinbench's rooms\b": "modules",
    r"\bfamil(y|ies) (of a bench|that explain|is a cause)\b": "candidate",
    r"\bbelieved scenario\b": "scenario",
}

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
