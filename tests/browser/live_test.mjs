import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { connect } from "node:net";
import { join } from "node:path";
import { after, test } from "node:test";
import { begin, close, faultsOf, folder, openAddress, scenario, twinbench, write } from "./bench.mjs";

const begun = [];
after(async () => {
  begun.forEach((program) => program.kill());
  await close();
});

function start(...words) {
  begun.push(begin(...words));
  return begun.at(-1);
}

async function until(what, told) {
  for (let k = 0; k < 400; ++k) {
    const found = await what();
    if (found) return found;
    await new Promise((done) => setTimeout(done, 25));
  }
  throw new Error(`not within 10 s: ${told()}`);
}

/** The address that a program prints. */
const addressOf = (program) => until(() => program.err.match(/http:\/\/127\.0\.0\.1:\d+\/\?token=\w+/)?.[0], () => program.err);

/** Answers of the served twin's controllers. */
function ask(port, ...questions) {
  return new Promise((done, fail) => {
    const answers = [];
    let text = "";
    const line = connect(port, "127.0.0.1", () => line.write(`${questions[0]}\n`));
    line.on("error", fail);
    line.on("data", (data) => {
      text += data;
      if (!text.endsWith("\n")) return;
      answers.push(text.trim());
      text = "";
      if (answers.length < questions.length) return line.write(`${questions[answers.length]}\n`);
      line.end();
      done(answers);
    });
  });
}

/** What the page says at its end, which comes to it after the program has gone. */
const verdictOf = (page) => until(async () => {
  const said = await page.locator("#state").innerText();
  return /exit code/.test(said) && said;
}, () => "the page does not say how it ended");

const kServed = ["--set", "procedure.positions=12", "--set", 'mechanics.fidelity="linear"'];

/** A twin that is served, once its bench file is there; the port of its controllers is `scpi`. */
async function serve(bench, ...more) {
  const program = start("serve", scenario("rotary_4dof"), ...kServed, "--iiod-port", "0", "--scpi-port", "0", "--esp-port", "0", "--no-pty", "--write-bench", bench, ...more);
  await until(() => existsSync(join(folder, bench)), () => "no bench file");
  program.scpi = Number(readFileSync(join(folder, bench), "utf8").match(/kind = "scpi"[^[]*tcp:127\.0\.0\.1:(\d+)/)[1]);
  return program;
}

test("a served twin is seen while it is measured, and stopped by the page as by Ctrl-C", async () => {
  const { scpi } = await serve("bench.toml", "--speed", "400");
  const measure = start("measure", scenario("rotary_4dof"), ...kServed, "--bench", "bench.toml", "-o", "seen", "--web", "0");
  const page = await openAddress(await addressOf(measure));

  await page.locator("#live-psd-a .plot[data-points]").waitFor();
  const points = () => page.locator("#live-psd-a .plot").getAttribute("data-points").then(Number);
  const first = await points();
  await until(async () => (await points()) > first, () => "no further readings");
  assert.match(await page.locator("#counted").innerText(), /^\d+ of \d+ readings, bench time [\d:]+, [\d:]+ left, ends at \d+:\d\d/);
  assert.deepEqual(await faultsOf(page), []);

  await page.locator("#live-residual-of-psd-a-x .plot[data-points]").waitFor();
  assert.match(await page.locator("#judged").innerText(), /^\d+ readings predicted by those before them; no alarm at a false-alarm rate of 1 % a run$/);

  for (const last of await page.locator("#residuals dd").allInnerTexts()) assert.match(last, /^(not predicted|\S+ of ± \S+ µm)$/);
  const [saved] = await Promise.all([page.waitForEvent("download"), page.locator("#save").click()]);
  const [head, ...rows] = readFileSync(await saved.path(), "utf8").trimEnd().split("\n").map((line) => line.split(","));
  assert.deepEqual(head.slice(0, 6), ["reading", "time_s", "setup", "pass", "phase", "status"]);
  assert.ok(head.includes("psd_a_x_V") && rows.length > 0 && rows.every((row) => row.length === head.length), String(head));

  const pause = page.locator("#pause"), paused = page.locator("#pause-said");
  await pause.click();
  await page.locator('#pause-said[data-state="paused"]').waitFor();
  const k = Number((await paused.innerText()).match(/^Paused at reading (\d+): everything stands$/)[1]);
  const look = async () => (await ask(scpi, "ROT1:STAT?", "ROT2:STAT?")).map((answer) => answer.split(","));
  for (const state of await look()) assert.equal(state[2], "0", "the controller says that it does not move");
  const held = await page.locator("#counted").innerText();
  await new Promise((done) => setTimeout(done, 700)); // at this speed some twenty readings, and one more look at the tables
  assert.equal(await page.locator("#counted").innerText(), held);
  assert.match(held, new RegExp(`^${k} of `));
  assert.match(await paused.innerText(), /everything stands/);
  assert.equal(await page.locator("#state").innerText(), "Paused: everything stands");
  assert.equal(await pause.innerText(), "Resume");
  await pause.press("Enter");
  await until(async () => (await page.locator("#counted").innerText()) !== held, () => "it did not go on");
  assert.equal(await pause.innerText(), "Pause");

  const stop = page.locator("#stop");
  await stop.click();
  await page.locator("#stop-not").click();
  const still = await points();
  await until(async () => (await points()) > still, () => "it stopped without being told");
  await stop.click();
  await page.locator("#stop-sure").click();
  const code = await measure.ended;
  const words = "stopped by the operator. The tables were brought to rest. The controller says that all tables stand still; every reading so far is kept.";
  assert.equal(code, 1);
  assert.ok(measure.err.includes(words), measure.err);
  const verdict = await verdictOf(page);
  assert.ok(verdict.startsWith("The program ended with exit code 1."), verdict);
  assert.ok(verdict.includes(words), verdict);
  assert.ok(await stop.isDisabled());
  assert.deepEqual(page.said, []);

  const [before, then] = [await look(), await look()];
  for (const table of [0, 1]) {
    assert.equal(before[table][2], "0", "the controller says that it does not move");
    assert.ok(Math.abs(before[table][1] - then[table][1]) < 1e-3, "its encoder stands");
  }
  await page.close();
});

test("a served twin shows where clients have moved its tables, and is stopped from its page", async () => {
  const served = await serve("watched.toml", "--speed", "100", "--web", "0");
  const page = await openAddress(await addressOf(served));
  const target = page.locator(".now dd").first();
  await until(async () => /^0(\.0+)?°$/.test(await target.innerText()), () => "the target does not begin at 0");
  await ask(served.scpi, "ROT1:ANGL 30;STAT?");
  await until(async () => /^(30(\.0+)?|29\.99+\d*|30\.00+\d*)°$/.test(await target.innerText()), () => "the target is not seen to get to 30 deg");
  assert.deepEqual(await faultsOf(page), []);
  await page.getByRole("button", { name: "Stop serving" }).click();
  await page.locator("#stop-sure").click();
  assert.equal(await served.ended, 0, served.err);
  assert.equal(await verdictOf(page), "Nothing is served any more: the program ended with exit code 0");
  assert.deepEqual(page.said, []);
  await page.close();
});

/** A second or two by bodies. */
const kSmallRun = 'bench = "rotary_4dof"\n[procedure]\nphases = ["full_circle"]\nshifts = [0, 1, 3]\npositions = 8\n[mechanics]\nfidelity = "bullet"\n';

/** An investigation of one run, which takes a second or two: long enough to be told something meanwhile. */
function startInquiry(name) {
  write("inquiry.toml", kSmallRun);
  return start("investigate", "inquiry.toml", "--twin", "inquiry.toml", "--runs", "1", "-o", name, "--web", "0");
}
const tell = (address, wish) => fetch(`${address.origin}/${wish}${address.search}`, { method: "POST" }).then((answer) => answer.status);

/** Once a run is under way and waits. */
async function isPaused(address) {
  const told = (await fetch(`${address.origin}/events${address.search}`)).body.pipeThrough(new TextDecoderStream()).getReader();
  for (let text = ""; !text.includes('"state":"paused"'); ) {
    const { value, done } = await told.read();
    assert.ok(!done, `it ended without a pause: ${text}`);
    text += value;
  }
  await told.cancel();
}

/** A small run of that name, under way and paused. */
async function pausedRun(name) {
  write(`${name}.toml`, kSmallRun);
  const run = start("run", `${name}.toml`, "-o", name, "--web", "0");
  const address = new URL(await addressOf(run));
  assert.equal(await tell(address, "pause"), 202);
  await isPaused(address);
  return [run, address];
}

test("on a phone nothing of a paused run's page is beside the screen, and stop and resume are beside each other", async () => {
  const [run, address] = await pausedRun("phone");
  const page = await openAddress(address.href);
  await page.locator('#pause-said[data-state="paused"]').waitFor();
  await page.setViewportSize({ width: 390, height: 844 });
  const boxes = await Promise.all([".halts .stop", ".halts .pause"].map((halt) => page.locator(halt).first().boundingBox()));
  assert.ok(Math.abs(boxes[0].y - boxes[1].y) < 8, JSON.stringify(boxes));
  assert.ok(boxes[0].x + boxes[0].width <= boxes[1].x && boxes[1].x + boxes[1].width <= 390, JSON.stringify(boxes));
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
  assert.equal(await tell(address, "resume"), 202);
  assert.equal(await run.ended, 0, run.err);
  await page.close();
});

test("a pause changes no bit of a twin's run", async () => {
  const [run, address] = await pausedRun("held");
  assert.equal(await tell(address, "resume"), 202);
  assert.equal(await run.ended, 0, run.err);
  twinbench("run", "held.toml", "-o", "unheld");
  const readings = (name) => twinbench("export", name);
  assert.equal(readings("held"), readings("unheld"));
});

test("an investigation shows its step and what is believed", async () => {
  const inquiry = startInquiry("inquiry");
  const address = new URL(await addressOf(inquiry));
  assert.equal(await tell(address, "pause"), 202);
  const page = await openAddress(address.href);
  await page.locator('#pause-said[data-state="paused"]').waitFor();
  assert.match(await page.locator("#step").innerText(), /^Step 1: /);
  await page.locator("#pause").click();
  await page.locator("#causes tbody tr").first().waitFor({ timeout: 120000 }); // a diagnosis on a busy machine
  assert.equal(await page.locator("#believed").innerText(), "Believed after step 1");
  const probabilities = await page.locator("#causes td:nth-child(2)").allInnerTexts();
  assert.ok(probabilities.every((text) => /^(< 0\.1|\d+\.\d) %$/.test(text)), probabilities.join());
  assert.equal(await inquiry.ended, 0, inquiry.err);
  assert.deepEqual(await faultsOf(page), []);
  assert.deepEqual(page.said, []);
  await page.close();
});

test("a stop passes to the run of an investigation that is under way", async () => {
  const inquiry = startInquiry("stopped");
  const address = new URL(await addressOf(inquiry));
  assert.equal(await tell(address, "pause"), 202);
  await isPaused(address);
  assert.equal(await tell(address, "stop"), 202);
  assert.equal(await inquiry.ended, 1);
  assert.match(inquiry.err, /stopped by the operator behind reading \d+ of 96/);
});

const kStudy = (trials, more = "") => `scenario_text = '''
bench = "encoder_comparison"
[encoder_procedure]
turns = 1
stops_per_turn = 12
passes = [1, -1]
${more}'''
seed = 1
trials = ${trials}
`;

test("a campaign is seen with its means and lost trials, stopped by the page, and gone on with to the same table", async () => {
  write("long.toml", kStudy(20000));
  const first = start("campaign", "long.toml", "-o", "long.sqlite", "--threads", "1", "--web", "0", "--show", "reversal.mean_arcsec", "--show", "score.device.ez_arcsec[]");
  const page = await openAddress(await addressOf(first));
  await page.locator("#live-mean-of-reversal-mean-arcsec .plot[data-points]").waitFor();
  const cells = () => page.locator("#results tbody tr").first().locator("th, td").allInnerTexts();
  const points = () => page.locator("#live-mean-of-reversal-mean-arcsec .plot").getAttribute("data-points").then(Number);
  const before = await points();
  await until(async () => (await points()) > before, () => "the mean does not go on");
  assert.equal((await cells())[0], "reversal.mean_arcsec");
  assert.match((await cells())[2], /^\S+ \u00b1 \S+$/);
  const heads = await page.locator("#results thead th").allTextContents();
  const scored = page.locator("#results tbody tr", { hasText: "score.device.ez_arcsec[]" }).locator("th, td");
  assert.match((await scored.allTextContents())[heads.indexOf("rms error")], /^\d/);
  assert.match(await page.locator("#counted").innerText(), /^\d+ of 20000 trials, 0 lost, [\d:]+ left$/);
  assert.match(await page.locator("h1").innerText(), /^campaign: long\.toml into long\.sqlite$/);
  assert.deepEqual(await faultsOf(page), []);
  await page.locator("#stop").click();
  assert.match(await page.locator("#stop-question").innerText(), /Stop the campaign\?/);
  await page.locator("#stop-sure").click();
  assert.equal(await first.ended, 1, first.err);
  assert.match(first.err, /stopped by the operator; trials that had begun are in long\.sqlite\. Go on with --resume/);
  assert.match(await verdictOf(page), /^The program ended with exit code 1\./);
  assert.deepEqual(page.said, []);
  await page.close();

  write("short.toml", kStudy(40));
  twinbench("campaign", "short.toml", "-o", "whole.sqlite", "--csv", "whole.csv", "--threads", "1");
  const seen = start("campaign", "short.toml", "-o", "seen.sqlite", "--csv", "seen.csv", "--threads", "2", "--web", "0");
  assert.equal(await seen.ended, 0, seen.err);
  assert.equal(readFileSync(join(folder, "seen.csv"), "utf8"), readFileSync(join(folder, "whole.csv"), "utf8"));
});

test("lost trials of a campaign are told with their reasons", async () => {
  // What repeats with the lines of a scale loses the trials of a scale of which no lines are stated.
  write("lost.toml", `${kStudy(1000)}set = ['effect=[{name = "interpolation"}]']
[[vary]]
key = "device.lines_per_turn"
values = [0, 1024]
`);
  const lost = start("campaign", "lost.toml", "-o", "lost.sqlite", "--threads", "1", "--web", "0");
  const page = await openAddress(await addressOf(lost));
  await page.locator("#lost li").first().waitFor();
  assert.match(await page.locator("#lost li").first().innerText(), /^trial \d+: .*needs the lines/);
  await until(async () => / [1-9]\d* lost, /.test(await page.locator("#counted").innerText()), () => "no lost trial is counted");
  assert.deepEqual(await faultsOf(page), []);
  assert.deepEqual(page.said, []);
  lost.kill();
  await page.close();
});
