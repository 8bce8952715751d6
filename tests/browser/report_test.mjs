import assert from "node:assert/strict";
import { mkdirSync, statSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { close, exchangeResults, faintOf, faultsOf, folder, makeRun, open, scenario, twinbench, write } from "./bench.mjs";

const kEvil = "</script><script>document.title='caught'</script><img src=x onerror=\"document.title='caught'\">";

const kRuns = ["rotary", "turntable", "circles", "diagnosed"];

before(() => {
  makeRun("rotary", scenario("rotary_4dof"), "--images");
  makeRun("turntable", scenario("turntable_shifts"));
  makeRun("circles", scenario("circular_motion"), "--set", "circular_procedure.points=90");
  const small = ["--set", "procedure.positions=12", "--set", "procedure.shifts=[0,1,5]", "--set", "procedure.passes=[1,-1]"];
  makeRun("diagnosed", scenario("rotary_4dof"), ...small, "--set", 'effect=[{name="psd_roll", where="psd_b", roll_mrad=20.0}]');
  twinbench("diagnose", "diagnosed", "--scenario", scenario("rotary_4dof"), ...small);
  for (const run of kRuns) twinbench("report", run);
});
after(close);

/** What a page of results shows, in a browser whose console stays silent. */
function shown(what, file, look) {
  test(what, async () => {
    const page = await open(file);
    await look(page);
    assert.deepEqual(page.said, []);
    await page.close();
  });
}

/** The library draws what has changed some frames later. */
const drawnAgain = (page) => page.waitForTimeout(500);

const kIndexError = "Turntable: index error EZ [arcsec]";
const cardOf = (page, heading) => page.locator("figure.card").filter({ has: page.getByRole("heading", { name: heading, exact: true }) });

/** Of those that can be looked at as polar plots. */
const firstCurve = (page) => page.locator("figure.card").filter({ has: page.getByRole("button", { name: "Linear" }) }).first();

const boxOf = async (part) => {
  await part.scrollIntoViewIfNeeded();
  return part.boundingBox();
};

const plots = (page) => page.locator(".plot");

for (const run of kRuns) {
  shown(`${run}: every plot is drawn, the console is silent, contrast and names of all controls pass in light and dark`, `${run}/report.html`, async (page) => {
    assert.ok((await plots(page).count()) >= 4);
    const marks = await plots(page).evaluateAll((all) => all.map((plot) => plot.querySelectorAll("svg path, svg polygon, svg polyline, canvas").length));
    assert.ok(marks.every((n) => n > 3), `marks in each plot: ${marks}`);
    assert.deepEqual(await faultsOf(page), []);
    const inPlots = await faintOf(page);
    assert.ok(inPlots.letters > 20 && inPlots.marks > 4, JSON.stringify(inPlots));
    assert.deepEqual(inPlots.faint, []);
    const paper = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const light = await paper();
    await page.emulateMedia({ colorScheme: "dark" });
    assert.notEqual(await paper(), light);
    assert.deepEqual(await faultsOf(page), []);
    await drawnAgain(page);
    assert.deepEqual((await faintOf(page)).faint, []);
  });
}

shown("a page opens with what the run says: its title, tiles with U and units, and polar plots with theirs", "turntable/report.html", async (page) => {
  assert.match(await page.locator("h1").innerText(), /: turntable$/);
  assert.match(await page.locator(".subtitle").innerText(), /simulated, seed \d+ · \d+ readings in \d+:\d\d h/);
  assert.match(await page.locator(".tile").first().innerText(), /Largest error\s+\S+ ± \S+ arcsec\s+Turntable: index error EZ, at \S+°/);
  assert.match(await firstCurve(page).locator("h3").innerText(), /\[arcsec\]$/);
});

shown("a circle has both directions, says how much its deviations are magnified, and its errors are ranked", "circles/report.html", async (page) => {
  const card = page.locator("#errors .choice figure.card");
  assert.match(await card.locator("h3").innerText(), /^Radial deviation, mounting \d \((bar|grid)\), .* \[µm\]$/);
  assert.deepEqual(await card.locator(".legend .entry").allInnerTexts(), ["counter-clockwise", "clockwise"]);
  const times = async () => Number((await card.locator(".note").innerText()).match(/^R = \S+ mm, deviations magnified (.+) times$/)[1].replaceAll("\u202f", ""));
  const whole = await times();
  assert.ok(whole > 1000);
  await card.getByRole("button", { name: "Zoom in" }).click();
  assert.ok((await times()) > whole);
  const shares = (await page.locator("#table-errors-ranked tbody tr td:last-child").allInnerTexts()).map((text) => Number(text.match(/[\d.]+/)[0]));
  assert.ok(shares.length > 5 && shares.every((share, k) => k === 0 || share <= shares[k - 1]), String(shares));
});

shown("on a phone no label of a plot is cut off, and on paper no plot and no table", "circles/report.html", async (page) => {
  for (const [width, media, parts, within] of [[390, "screen", ".plot svg text", ".plot"], [700, "print", ".plot svg, table", ".card"]]) {
    await page.setViewportSize({ width, height: 900 });
    await page.emulateMedia({ media });
    await page.waitForFunction(() => [...document.querySelectorAll(".plot svg")].every((svg) => svg.clientWidth <= svg.closest(".plot").clientWidth)); // drawn again
    await drawnAgain(page);
    const cut = await page.evaluate(([parts, within]) => [...document.querySelectorAll(parts)].filter((part) => {
      const [box, room] = [part, part.closest(within)].map((element) => element.getBoundingClientRect());
      return box.width > 0 && (box.left < room.left - 1 || box.right > room.right + 1);
    }).map((part) => part.textContent.slice(0, 40)), [parts, within]);
    assert.deepEqual(cut, [], media);
  }
});

test("a page of four shifts is below 3 MB", () => {
  twinbench("report", "rotary");
  assert.ok(statSync(join(folder, "rotary/report.html")).size < 3e6);
});

shown("the pointer on a plot shows value, uncertainty and truth", "turntable/report.html", async (page) => {
  const card = await linear(page);
  const box = await boxOf(card.locator(".plot"));
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  const tip = card.locator(".tip");
  await tip.waitFor();
  const text = await tip.innerText();
  assert.match(text, /position \d+°/);
  assert.match(text, /estimate\s+\S+ ± \S+ arcsec/);
  assert.match(text, /truth\s+\S+ arcsec/);
});

shown("the plotted numbers are those of results.json", "turntable/report.html", async (page) => {
  const card = cardOf(page, kIndexError);
  await card.getByRole("button", { name: "Numbers" }).click();
  const shown = await card.locator(".numbers tbody tr").first().locator("td").allInnerTexts();
  const { default: results } = await import(join(folder, "turntable/results.json"), { with: { type: "json" } });
  const table = results.separation.turntable;
  assert.equal(Number(shown[0].replace("−", "-")), table.position_deg[0]);
  assert.equal(Number(shown[1].replace("−", "-")), Number(table.ez_arcsec[0].toPrecision(6)));
  assert.equal(Number(shown[2]), Number(table.u_ez_arcsec[0].toPrecision(6)));
});

shown("by keys alone a plot is reached, read, zoomed and shown whole again, and a series hidden", "rotary/report.html", async (page) => {
  const focused = () => page.evaluate(() => [document.activeElement.className, document.activeElement.innerText, document.activeElement.getAttribute("role")]);
  const tabTo = async (wanted) => {
    for (let n = 0; n < 60; ++n) {
      await page.keyboard.press("Tab");
      const [name, text, role] = await focused();
      if (wanted({ name, text, role })) return;
    }
    assert.fail("Tab does not lead there");
  };
  await tabTo(({ text }) => text === "Linear");
  await page.keyboard.press("Enter");
  await tabTo(({ text }) => text.trim() === "truth");
  await page.keyboard.press("Space");
  const truth = firstCurve(page).getByRole("button", { name: "truth" });
  assert.equal(await truth.getAttribute("aria-pressed"), "false");
  await tabTo(({ role }) => role === "application");
  await page.keyboard.press("ArrowRight");
  const readout = firstCurve(page).locator(".readout");
  const first = await readout.innerText();
  await page.keyboard.press("ArrowRight");
  assert.match(first, /estimate, position 0°: \S+ ± \S+ arcsec/);
  assert.notEqual(await readout.innerText(), first);
  const labels = () => firstCurve(page).locator(".plot svg text").allTextContents();
  const whole = await labels();
  assert.ok(whole.includes("100"), `labels of the axes: ${whole}`);
  await page.keyboard.press("+");
  await drawnAgain(page);
  assert.notDeepEqual(await labels(), whole);
  await page.keyboard.press("0");
  await drawnAgain(page);
  assert.deepEqual(await labels(), whole);
});

shown("on a polar plot pointer and cursor keys show the value at an angle", "turntable/report.html", async (page) => {
  const card = cardOf(page, kIndexError);
  await card.locator(".plot").focus();
  for (let n = 0; n < 5; ++n) await page.keyboard.press("ArrowRight");
  await card.locator(".tip").waitFor();
  const byKeys = await card.locator(".tip").innerText();
  assert.match(byKeys, /position 40°\s+estimate\s+\S+ ± \S+ arcsec\s+truth/);
  const box = await boxOf(card.locator(".plot"));
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2 - 60);
  await drawnAgain(page);
  assert.match(await card.locator(".tip").innerText(), /position 90°/);
});

shown("wheel with Ctrl zooms, wheel alone does not", "turntable/report.html", async (page) => {
  const card = firstCurve(page);
  await card.getByRole("button", { name: "Linear" }).click();
  const labels = () => card.locator(".plot svg text").allTextContents();
  const box = await boxOf(card.locator(".plot"));
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  const whole = await labels();
  await page.mouse.wheel(0, -300);
  await drawnAgain(page);
  assert.deepEqual(await labels(), whole);
  await page.keyboard.down("Control");
  await page.mouse.wheel(0, -300);
  await page.keyboard.up("Control");
  await drawnAgain(page);
  assert.notDeepEqual(await labels(), whole);
});

/** Numbers at the axis below a plot, in its own minus signs. */
const numbersBelow = async (card) => {
  const box = await boxOf(card.locator(".plot"));
  const texts = await card.locator(".plot svg text").evaluateAll((all) => all.map((text) => ({ text: text.textContent, at: text.getBoundingClientRect() })));
  return texts.filter(({ at }) => at.y > box.y + box.height - 46 && at.y < box.y + box.height - 25).map(({ text }) => Number(text.replace("\u2212", "-"))).filter(Number.isFinite);
};
const linear = async (page) => {
  const card = cardOf(page, kIndexError);
  await card.getByRole("button", { name: "Linear" }).click();
  await drawnAgain(page);
  return card;
};

shown("a rectangle is zoomed into by pointer, by button and by Shift, and shown whole again", "turntable/report.html", async (page) => {
  const card = await linear(page);
  const plot = card.locator(".plot");
  const box = await boxOf(plot);
  const drag = async (from, to) => {
    const at = ([x, y]) => [box.x + 62 + x * (box.width - 80), box.y + 14 + y * (box.height - 60)]; // in the rectangle of the axes
    await page.mouse.move(...at(from));
    await page.mouse.down();
    await page.mouse.move(...at([(from[0] + to[0]) / 2, (from[1] + to[1]) / 2]));
    await page.mouse.move(...at(to));
    await page.mouse.up();
    await drawnAgain(page);
  };
  const within = (numbers, low, high) => assert.ok(numbers.length > 1 && numbers.every((x) => x >= low && x <= high), `${numbers} in ${low} to ${high}`);
  const whole = await numbersBelow(card);
  assert.ok(Math.max(...whole) - Math.min(...whole) >= 300);
  await card.getByRole("button", { name: "Rectangle" }).click();
  assert.equal(await card.getByRole("button", { name: "Rectangle" }).getAttribute("aria-pressed"), "true");
  await drag([0.2, 0.3], [0.4, 0.7]); // of 0 to 350 deg
  within(await numbersBelow(card), 0.2 * 350 - 2, 0.4 * 350 + 2);
  assert.equal(await card.locator(".sheet").count(), 0);
  await card.getByRole("button", { name: "All" }).click();
  await drawnAgain(page);
  assert.deepEqual(await numbersBelow(card), whole);
  await page.keyboard.down("Shift");
  await drag([0.8, 0.8], [0.6, 0.2]); // from any corner
  await page.keyboard.up("Shift");
  within(await numbersBelow(card), 0.6 * 350 - 2, 0.8 * 350 + 2);
  assert.deepEqual(await faultsOf(page), []);
});

shown("a rectangle is moved, sized and zoomed into by keys alone, told in words, and left by Escape", "turntable/report.html", async (page) => {
  const card = await linear(page);
  const plot = card.locator(".plot");
  const whole = await numbersBelow(card);
  const readout = () => card.locator(".readout").innerText();
  await plot.focus();
  await page.keyboard.press("z");
  assert.match(await readout(), /^position \[°\] 87.5 to 262.5, .* Enter zooms, Escape leaves\.$/);
  assert.deepEqual(await faultsOf(page), []);
  await page.keyboard.press("Escape");
  assert.deepEqual(await numbersBelow(card), whole);
  await page.keyboard.press("z");
  for (let n = 0; n < 3; ++n) await page.keyboard.press("ArrowRight"); // 5 % each
  for (let n = 0; n < 2; ++n) await page.keyboard.press("Shift+ArrowLeft");
  assert.match(await readout(), /^position \[°\] 140 to 280, /);
  await page.keyboard.press("Enter");
  await drawnAgain(page);
  const shown = await numbersBelow(card);
  assert.ok(shown.length > 1 && shown.every((x) => x >= 140 && x <= 280), String(shown));
  await page.keyboard.press("0");
  await drawnAgain(page);
  assert.deepEqual(await numbersBelow(card), whole);
});

shown("every plot with axes takes a rectangle, bars along their places, and no other does", "turntable/report.html", async (page) => {
  const cards = page.locator("figure.card").filter({ has: page.getByRole("button", { name: "Zoom in" }) });
  const told = { plane: 0, bars: 0, none: 0 };
  for (let k = 0; k < (await cards.count()); ++k) {
    const card = cards.nth(k);
    const can = await card.getByRole("button", { name: "Rectangle" }).isVisible();
    await card.locator(".plot").focus();
    await page.keyboard.press("z");
    assert.equal(await card.locator(".sheet").count(), can ? 1 : 0);
    if (!can) {
      ++told.none;
      continue;
    }
    const words = await card.locator(".readout").innerText();
    const range = words.match(/^.*? (\S+) to (\S+?)(, .* \S+ to \S+)?\. Arrows/);
    assert.ok(range && range.slice(1, 3).every((end) => Number.isFinite(Number(end.replace("\u2212", "-")))), words);
    ++told[range[3] ? "plane" : "bars"];
    await page.keyboard.press("Enter");
    assert.equal(await card.locator(".plot").getAttribute("data-zoomed"), "yes");
  }
  assert.ok(told.plane > 0 && told.bars > 0 && told.none > 0, JSON.stringify(told));
});

shown("choosing another residual draws another plot", "diagnosed/report.html", async (page) => {
  const choice = page.locator("#residuals .choice");
  const title = () => choice.locator("figcaption h3").innerText();
  const before = await title();
  const other = await choice.locator("select").first().evaluate((list) => [...list.options].find((option) => !option.selected).value);
  await choice.locator("select").first().selectOption(other);
  assert.notEqual(await title(), before);
  assert.match(await page.locator(".verdict").innerText(), /psd_roll at psd_b/);
});

shown("a picture of the light tells its values by cursor keys and under the pointer", "rotary/report.html", async (page) => {
  const card = page.locator("#light figure.card").first();
  await card.locator(".picture").focus();
  await page.keyboard.press("ArrowLeft");
  assert.match(await card.locator(".readout").innerText(), /^\S+, \S+ mm from the middle of the picture: \S+ W\/mm2$/);
  const painted = await card.locator("canvas").evaluate((canvas) => new Set(new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size);
  assert.ok(painted > 1);
  await card.locator("canvas").hover({ position: { x: 5, y: 5 } });
  assert.match(await card.locator(".readout").innerText(), /: 0 W\/mm2$/);
});

test("pages of plans and investigations are drawn and pass the same checks", async () => {
  const cause = (effect) => ({ effect, where: "" });
  const planned = { name: "separation.target.ez_arcsec", order: [1, 2, 3], u: [0.01, 0.02, 0.015] };
  write("plan.json", JSON.stringify({
    runs: [{ run: "own", readings: 10, minutes: 5, dof: 3, shifts: {}, results: [{ name: planned.name, rms_u: 0.05 }], harmonics: [planned], not_separable: ["dx"] }],
    next: "best", advice: [{ name: "best", words: "two more mountings", bit_per_minute: 0.5, sets: [] }, { name: "same", words: "the same again", bit_per_minute: 0.1, sets: [] }],
    ties: [{ present: cause("a"), blamed: cause("b"), told_from: 0.1, unit: "um" }], never_told_apart: [[cause("a"), cause("c")]], detectable: [], invisible: [],
  }));
  const step = (number, p) => ({ number, run: "r", words: "w", reason: "y", minutes: 5, expected_bit: 0.5, gained_bit: 0.4, u_goal: null, unlisted: 0, believed: [{ name: "a", probability: p }, { name: "b", probability: 1 - p }] });
  write("investigation.json", JSON.stringify({ told: "tied", ended: "budget spent", minutes: 10, goal: null, causes: [{ name: "a", probability: 0.9, chi2: 1 }], unlisted: 0, steps: [step(1, 0.5), step(2, 0.9)], refused: [] }));
  for (const name of ["plan", "investigation"]) {
    twinbench("report", `${name}.json`);
    const page = await open(`${name}.html`);
    assert.equal(await plots(page).count(), 2);
    if (name === "investigation") {
      const words = await page.locator("#figure-probability-of-each-hypothesis svg text").allTextContents();
      assert.ok(["0", "0.2", "0.4", "0.6", "0.8", "1"].every((tick) => words.includes(tick)), `not from 0 to 1: ${words}`); // the points are from 0.1 to 0.9
    }
    assert.deepEqual(await faultsOf(page), []);
    assert.deepEqual(page.said, []);
    await page.close();
  }
});

test("on a phone the broken labels of lying bars keep apart", async () => {
  const words = ["first", "second", "third", "fourth"].map((which) => `the ${which} circle with the multi-tooth table a millimetre off the axis while the temperature rises`);
  write("wordy.json", JSON.stringify({ runs: [], next: "", advice: words.map((text, k) => ({ name: text, words: text, bit_per_minute: k, sets: [] })) }));
  twinbench("report", "wordy.json");
  const page = await open("wordy.html");
  await page.setViewportSize({ width: 390, height: 900 });
  await page.reload();
  const labels = page.locator("#figure-information-rate-of-each-next-run svg text");
  await labels.nth(8).waitFor();
  const boxes = await labels.evaluateAll((all) => all.map((label) => label.getBoundingClientRect()).map(({ left, right, top, bottom }) => ({ left, right, top, bottom })));
  const kLetters = 4; // px: less is the room about a letter
  const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > kLetters && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > kLetters;
  assert.deepEqual(boxes.filter((a, k) => boxes.some((b, l) => l > k && meet(a, b))), []);
  await page.close();
});

test("the page of an investigation leads to the pages of its runs, which are made with it", async () => {
  mkdirSync(join(folder, "asked"));
  makeRun("asked/01-first", scenario("turntable_shifts"));
  const steps = ["01-first", "../turntable"].map((run, k) => ({ number: k + 1, run, folder: run, believed: [] }));
  write("asked/investigation.json", JSON.stringify({ ended: "budget spent", minutes: 10, causes: [], steps }));
  twinbench("report", "asked");
  const page = await open("asked/report.html");
  const links = page.locator("#table-runs a");
  assert.deepEqual(await links.allInnerTexts(), ["1 01-first"]); // nothing outside of the folder is looked at
  await links.click();
  assert.match(await page.locator("h1").innerText(), /: 01-first$/);
  await page.close();
});

test("nothing that results or a folder's name say is read as markup or script", async () => {
  makeRun("evil", scenario("turntable_shifts"));
  const results = JSON.parse((await import("node:fs")).readFileSync(join(folder, "evil/results.json"), "utf8"));
  results[kEvil] = 3;
  results.separation.turntable[`${kEvil}_arcsec`] = results.separation.turntable.ez_arcsec;
  results.separation.not_separable = [{ what: kEvil, why: kEvil }];
  results.diagnosis = { verdict: "named", in_words: kEvil, causes: [{ effect: kEvil, where: "", probability: 1, parameters: {}, next_measurement: kEvil }] };
  exchangeResults("evil", results);
  twinbench("report", "evil");
  const page = await open("evil/report.html");
  const title = await page.title();
  assert.match(title, /: evil$/);
  assert.equal(await page.locator("img").count(), 0);
  assert.equal(await page.locator(".verdict").innerText(), kEvil);
  const plot = page.locator("#figure-causes .plot, figure.card .plot").first();
  await plot.focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForTimeout(100);
  assert.equal(await page.title(), title);
  assert.deepEqual(page.said, []);
  await page.close();
});

test("a hundred thousand points are drawn and can be zoomed into", async () => {
  const n = 100000;
  const x = Array.from({ length: n }, (_, k) => (360 * k) / n);
  const results = { many: { position_deg: x, ez_arcsec: x.map((a) => Math.sin(a)) } };
  makeRun("many", scenario("turntable_shifts"));
  exchangeResults("many", results);
  twinbench("report", "many");
  const page = await open("many/report.html");
  const card = firstCurve(page);
  await card.getByRole("button", { name: "Linear" }).click();
  const before = await card.screenshot();
  await card.getByRole("button", { name: "Zoom in" }).click();
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  assert.ok(!before.equals(await card.screenshot()));
  assert.deepEqual(page.said, []);
  await page.close();
});
