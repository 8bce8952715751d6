#!/usr/bin/env python3
"""The README is short and shows its picture; links lead somewhere; the program has one name on all pages."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *(ROOT / "scenarios").glob("*.md"), *(ROOT / "docs").glob("*.md")])
README = (ROOT / "README.md").read_text()


def anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


class Pages(unittest.TestCase):
    def test_readme_is_read_in_two_minutes(self):
        self.assertLessEqual(len(README.splitlines()), 120)

    def test_readme_shows_an_error_curve_with_units_uncertainty_and_truth_beside_its_cause(self):
        self.assertIn("(docs/pictures/first.svg)", README)
        picture = (ROOT / "docs/pictures/first.svg").read_text()
        self.assertTrue(5_000 < len(picture) < 60_000, len(picture))
        for words in ("[arcsec]", "band: U", "truth", "Cause", " ± "):
            self.assertIn(words, picture)

    def test_readme_has_a_drawing_of_every_bench(self):
        benches = {p.name for p in (ROOT / "twin/benches").iterdir() if (p / "format.h").exists()}
        self.assertEqual(len(benches), 6)
        for bench in benches:
            self.assertIn(f"docs/pictures/benches/{bench}.svg", README)

    def test_links_lead_somewhere(self):
        for page in PAGES:
            text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
            links = re.findall(r"\]\(([^)\s]+)\)", text) + re.findall(r'src="([^"]+)"', text)
            for link in links:
                if re.match(r"\w+:", link):
                    continue
                file, _, heading = link.partition("#")
                target = page.parent / file if file else page
                self.assertTrue(target.exists(), f"{page.name}: {link}")
                if heading:
                    headings = [anchor(h) for h in re.findall(r"^#+ (.*)$", target.read_text(), re.MULTILINE)]
                    self.assertIn(heading, headings, f"{page.name}: {link}")

    def test_every_scenario_is_listed(self):
        listed = (ROOT / "scenarios/README.md").read_text()
        for scenario in (ROOT / "scenarios").glob("*.toml"):
            self.assertIn(f"`{scenario.name}`", listed)

    def test_the_program_has_one_name(self):
        for page in PAGES:
            self.assertNotIn("build/tools/twinbench", page.read_text(), page.name)


if __name__ == "__main__":
    unittest.main()
