// What the browser tests share: runs made by the program, and their pages opened in one browser.
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";

const { TWINBENCH_PROGRAM, TWINBENCH_SOURCE_DIR, TWINBENCH_CHROMIUM, TWINBENCH_MODULES } = process.env;
const load = createRequire(join(TWINBENCH_MODULES, "package.json"));
const { chromium } = load("playwright-core");
const axe = readFileSync(load.resolve("axe-core/axe.min.js"), "utf8");

export const folder = mkdtempSync(join(tmpdir(), "twinbench-browser-"));

export function twinbench(...words) {
  return execFileSync(TWINBENCH_PROGRAM, words, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, XDG_CACHE_HOME: folder } });
}

export const scenario = (name) => join(TWINBENCH_SOURCE_DIR, "scenarios", `${name}.toml`);

export function write(name, text) {
  writeFileSync(join(folder, name), text);
}

/** Other results than a run's own: its record becomes that of a version that kept no digests, and would refuse them else. */
export function exchangeResults(run, results) {
  write(`${run}/results.json`, JSON.stringify(results));
  const forget = "import sqlite3, sys; sqlite3.connect(sys.argv[1]).executescript('DROP TABLE digests; DROP TABLE files; PRAGMA user_version = 5')";
  execFileSync("python3", ["-c", forget, join(folder, run, "record.sqlite")]);
}

/** A run of the twin with its score, made once. */
export function makeRun(name, toml, ...more) {
  twinbench("run", toml, "-o", name, ...more);
  twinbench("score", name, "--json", join(name, "score.json"));
  return name;
}

let browser;

/** The program in the background: `err` is what it has said so far, `ended` promises its exit code. */
export function begin(...words) {
  const process_ = spawn(TWINBENCH_PROGRAM, words, { cwd: folder, stdio: ["ignore", "ignore", "pipe"], env: { ...process.env, XDG_CACHE_HOME: folder } });
  const program = { err: "", id: process_.pid, kill: () => process_.kill("SIGKILL") };
  process_.stderr.on("data", (text) => (program.err += text));
  program.ended = new Promise((done) => process_.on("close", done));
  return program;
}

/** A page that says on the console whatever it has against what it is shown; kept in `said`. */
async function blank() {
  browser ??= await chromium.launch({ executablePath: TWINBENCH_CHROMIUM, args: ["--no-sandbox"] });
  const context = await browser.newContext({ viewport: { width: 1300, height: 900 } });
  const page = await context.newPage();
  page.said = [];
  page.on("console", (message) => page.said.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => page.said.push(`error: ${error.message}`));
  return page;
}

/** Opens a page of the program's own server. */
export async function openAddress(address) {
  const page = await blank();
  await page.goto(address);
  return page;
}

/** Opens a page of results, which asks nothing of any network. */
export async function open(file) {
  const page = await blank();
  page.on("request", (request) => request.url().startsWith("http") && page.said.push(`request: ${request.url()}`));
  await page.goto(`file://${join(folder, file)}`);
  await page.waitForFunction(() => [...document.querySelectorAll(".plot")].every((plot) => plot.dataset.drawn));
  return page;
}

/** What the checker of accessibility has against the page, contrast among it; of the letters in plots, which it does not judge, see faintOf. */
export async function faultsOf(page) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(axe);
  const found = await page.evaluate(() => window.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21aa"], resultTypes: ["violations"] }));
  return found.violations.map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map((node) => node.html.slice(0, 120)).join(" | ")}`);
}

/** What stands out too little in the plots, by the checker's own measure, which leaves text of SVG for people to judge: letters below 4.5 to 1 on what is behind the
 * plot (WCAG 1.4.3), and the colours of series, as the legends show them, below 3 to 1 (1.4.11). Plots of many points are one canvas and have none. */
export async function faintOf(page) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(axe);
  return page.evaluate(() => {
    const { Color, flattenColors, getContrast } = window.axe.commons.color;
    const painted = (element, property) => {
      const style = getComputedStyle(element);
      if (style[property] === "none") return undefined;
      const colour = new Color();
      colour.parseString(style[property]);
      colour.alpha *= Number(style[`${property}Opacity`] ?? 1) * Number(style.opacity);
      return colour;
    };
    const behind = (element) => painted(element.closest(".card"), "backgroundColor");
    const tooFaint = (element, property, least) => {
      const colour = painted(element, property);
      if (!colour || colour.alpha === 0) return false;
      return getContrast(behind(element), flattenColors(colour, behind(element))) < least;
    };
    const letters = [...document.querySelectorAll(".plot svg text")];
    const marks = [...document.querySelectorAll('.legend .entry[aria-pressed="true"] svg *')].filter((mark) => !mark.children.length);
    const faint = letters.filter((text) => tooFaint(text, "fill", 4.5)).map((text) => `letters ${text.textContent}`);
    for (const mark of marks) if (tooFaint(mark, "stroke", 3) && tooFaint(mark, "fill", 3)) faint.push(`series ${mark.outerHTML}`);
    return { letters: letters.length, marks: marks.length, faint };
  });
}

export async function close() {
  await browser?.close();
  rmSync(folder, { recursive: true });
}
