// Shows a measurement while it goes on, and stops it. What a bench does is said only in the words of the program that reads it.
import { button, element } from "./dom.js";
import { campaign } from "./live_campaign.js";
import { liveFigures, residualFigures } from "./live_figures.js";
import { inquiry } from "./live_inquiry.js";
import { pausePanel } from "./live_pause.js";
import { stopPanel } from "./live_stop.js";
import { measured, number, withUnit } from "./format.js";
import { themeButton } from "./theme.js";

const token = new URLSearchParams(location.search).get("token") ?? "";
const address = (path) => `${path}?token=${encodeURIComponent(token)}`;
const kBetweenDrawings_ms = 400;
const kSilence_ms = 12000; // the program gives a sign of life every 5 s

const title = element("h1", {}, "Waiting for the measurement");
const subtitle = element("p", { class: "subtitle" }, "");
const verdict = element("p", { class: "verdict", role: "status", id: "state" }, "Connecting");
const bar = element("progress", { max: 1, value: 0, "aria-label": "Readings done" });
const counted = element("p", { class: "subtitle", id: "counted" }, "");
const axes = element("dl", { class: "now", "aria-label": "Last reading" });
const save = button("Save readings (CSV)", saveCsv, { class: "theme", id: "save", hidden: true });
const cards = element("div", { class: "cards" });
const residualCards = element("div", { class: "cards" });
const judged = element("p", { class: "subtitle", id: "judged" }, "No reading is predicted by those before it yet");
const alarms = element("ol", { class: "alarms", id: "alarms" });
const lastResiduals = element("dl", { class: "now", id: "residuals", "aria-label": "Last reading less its prediction, of the limit that raises an alarm" });
const residualPart = element("section", { class: "part", "aria-label": "Residuals" }, element("h2", {}, "Against the twin's prediction"), judged, lastResiduals, element("div", { role: "log", "aria-label": "Alarms" }, alarms), residualCards);
const send = (path) => fetch(address(path), { method: "POST" });
const stop = stopPanel(() => send("/stop"));
const pause = pausePanel(send);
const steps = inquiry();
const trials = campaign(clock);

let figures = null;
let serves = false;
let counts = false; // trials of a campaign
let shown = null; // folder
let residuals = null;
let predicted = 0;
let raised = 0;
let columns = [];
let rows = []; // of every reading that the page was told
let ended = false;
let paused = null; // what the program says of its pause
let heard = performance.now();
let changed = false;

function say(tone, text) {
  verdict.className = `verdict ${tone}`;
  verdict.textContent = text;
}

function clock(seconds) {
  const whole = Math.round(seconds);
  const two = (n) => String(n).padStart(2, "0");
  return whole < 3600 ? `${Math.floor(whole / 60)}:${two(whole % 60)}` : `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}

function begin({ command, bench, folder, can_pause, columns: named }) {
  pause.offer(can_pause && !ended);
  if (folder === shown) return; // the connection is back; what was shown goes on
  shown = folder;
  residuals = null;
  predicted = raised = 0;
  residualCards.replaceChildren();
  alarms.replaceChildren();
  serves = command === "serve";
  counts = command === "campaign";
  title.textContent = counts ? `campaign: ${folder}` : serves ? `${bench}, emulated` : `${bench}: ${command} into ${folder}`;
  if (serves) {
    counted.textContent = folder;
    bar.hidden = residualPart.hidden = true;
    stop.isOf("Stop serving", "Stop serving?", "The program closes every connection and ends. What clients had in hand is theirs to take up again.");
  }
  if (counts) {
    trials.begin();
    residualPart.hidden = true;
    bar.setAttribute("aria-label", "Trials done");
    stop.isOf("Stop the campaign", "Stop the campaign?", "Trials that have begun are finished and kept, and no others begin. The same command with --resume goes on.");
  }
  columns = named;
  rows = [];
  save.hidden = counts || serves;
  figures = liveFigures(columns);
  axes.replaceChildren(...columns.map(({ name }) => element("div", {}, element("dt", {}, name), element("dd", {}, "\u2013"))));
  cards.replaceChildren(...figures.cards);
  if (!ended) sayState();
}

const running = () => (counts ? "The campaign is running" : serves ? "The bench is emulated" : "The measurement is running");
const kHeld = { paused: ["doubt", "Paused: everything stands"], restless: ["bad", "Paused, but not at rest: look at the bench"] };
const sayState = () => say(...(kHeld[paused] ?? ["", running()]));

function held(event) {
  pause.heard(event);
  paused = event.state;
  if (!ended) sayState();
}

function showLast(values) {
  columns.forEach(({ unit }, c) => (axes.children[c].lastChild.textContent = values[c] === null ? "\u2013" : withUnit(number(values[c]), unit)));
}

/** Axes that others move. */
function moved({ t, v, moving }) {
  figures?.add({ t, v });
  showLast(v);
  subtitle.textContent = `bench time ${clock(t)}, ${moving ? "moving" : "at rest"}`;
  changed = true;
}

function reading(r) {
  figures?.add(r);
  showLast(r.v);
  rows.push([r.n, r.t, r.setup, r.pass, r.phase, r.status, ...r.v]);
  subtitle.textContent = `reading ${r.n}: ${r.phase.replaceAll("_", " ")}, mounting ${r.setup}, pass ${r.pass}, ${r.status.replace("_", " ")}`;
  changed = true;
}

function progress({ done, planned, bench_s, left_s }) {
  bar.max = planned;
  bar.value = done;
  counted.textContent = `${done} of ${planned} readings, bench time ${clock(bench_s)}, ${left_s < 0 ? "time left not known yet" : done === planned ? "complete" : `${clock(left_s)} left, ends at ${new Date(Date.now() + 1000 * left_s).toLocaleTimeString([], { hour: "2-digit", minute: "2-digit" })}`}`;
}

/** The record has every reading; this is what the page was told. */
function saveCsv() {
  const head = ["reading", "time_s", "setup", "pass", "phase", "status", ...columns.map(({ column }) => column)];
  const text = [head, ...rows].map((row) => row.join(",")).join("\n");
  element("a", { href: URL.createObjectURL(new Blob([`${text}\n`], { type: "text/csv" })), download: "readings.csv" }).click();
}

/** What the twin, set to the readings before, said that these should be. @param limit_u  That raises an alarm. */
function compare({ channels, readings, limit_u }) {
  if (!residuals) {
    residuals = residualFigures(channels);
    residualCards.replaceChildren(...residuals.cards);
  }
  readings.forEach((reading) => residuals.add(reading, limit_u));
  showResiduals(channels, readings.at(-1), limit_u);
  predicted += readings.filter(({ v }) => v.some((value) => value !== null)).length;
  sayJudged();
  changed = true;
}

function showResiduals(channels, { v, u }, limit_u) {
  lastResiduals.replaceChildren(...channels.map(({ name, unit }, c) => {
    const limit = limit_u * u[c];
    const is = v[c] === null ? "not predicted" : withUnit(measured(v[c], limit, 1), unit).replace("\u00b1", "of \u00b1");
    return element("div", {}, element("dt", {}, name), element("dd", { class: Math.abs(v[c]) > limit ? "beyond" : undefined }, is));
  }));
}

function sayJudged() {
  const told = raised === 0 ? "no alarm" : raised === 1 ? "1 alarm" : `${raised} alarms`;
  judged.textContent = `${predicted} readings predicted by those before them; ${told} at a false-alarm rate of 1 % a run`;
}

function alarm({ words }) {
  raised += 1;
  alarms.append(element("li", {}, words));
  sayJudged();
}

function end({ code, words }) {
  ended = true;
  events.close();
  stop.over();
  pause.over();
  if (code === 0 && counts) return say("good", "The campaign is complete: the program ended with exit code 0");
  if (code === 0) return say("good", serves ? "Nothing is served any more: the program ended with exit code 0" : "The measurement is complete: the program ended with exit code 0");
  say(code === 3 ? "bad" : "doubt", `The program ended with exit code ${code}. ${words}`);
}

const events = new EventSource(address("/events"));
function on(kind, handle) {
  events.addEventListener(kind, (event) => {
    heard = performance.now();
    handle(JSON.parse(event.data));
  });
}
on("begin", begin);
on("run", begin);
on("step", steps.step);
on("believed", steps.believed);
on("reading", reading);
on("progress", progress);
on("axes", moved);
on("trials", (told) => {
  [bar.max, bar.value] = [told.planned, told.done];
  counted.textContent = trials.trials(told);
  changed = true;
});
on("lost_trial", trials.lost);
on("residuals", compare);
on("alarm", alarm);
on("unjudged", ({ why }) => (judged.textContent = `Readings are not compared with the twin: ${why}`));
on("asked", ({ what }) => (what === "stop" ? stop.asked() : pause.asked(what)));
on("pause", held);
on("left_out", (lost) => (subtitle.textContent = `${lost} messages came too fast to be shown; the record has every reading`));
on("end", end);
on("beat", () => {});
events.onerror = () => {
  if (!ended) say("bad", "No connection to the program. Whether anything moves is not known here: look at the terminal and at the bench");
};
events.onopen = () => {
  heard = performance.now();
  if (!ended) figures ? sayState() : say("", "Connected; nothing is being measured yet");
};
setInterval(() => {
  if (changed) (changed = false), figures?.draw(), residuals?.draw(), trials.draw();
  if (!ended && performance.now() - heard > kSilence_ms) events.onerror();
}, kBetweenDrawings_ms);

document.getElementById("page").append(
  element("header", {}, element("div", { class: "brand" }, element("span", {}, "twinbench, live"), themeButton()), title, subtitle, verdict),
  element("main", { id: "content", tabindex: -1 }, element("div", { class: "halts" }, stop.element, pause.element), steps.element, element("section", { class: "part" }, bar, counted, axes, save), trials.element, cards, residualPart),
);
