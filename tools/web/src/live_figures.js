// Plots that grow with the readings: spots as tracks where two columns are x and y of one thing, the rest of what is shown against time.
import { makeChart } from "./chart.js";
import { element, slug } from "./dom.js";
import { axisTitle } from "./format.js";
import { looks, swatch } from "./looks.js";
import { planeOption } from "./plane.js";
import { onThemeChange } from "./theme.js";

const kShown = 600; // readings; older ones leave the plots

class LiveCard {
  /** @param figure  With empty series.  @param take  (reading) -> [x, y, u] of each series: y null is a gap, undefined is not there. */
  constructor(figure, take) {
    Object.assign(this, { figure, take });
    this.plot = element("div", { class: "plot", role: "img", "aria-label": `${figure.title}, ${axisTitle(figure.y)} against ${axisTitle(figure.x)}` });
    this.plot.style.height = figure.form === "track" ? "340px" : "240px";
    this.legend = element("div", { class: "legend" });
    this.element = element("figure", { class: "card", id: `live-${slug(figure.title)}` }, element("h3", {}, figure.title), this.legend, this.plot);
    this.name();
    const shown = figure.series.map(() => true);
    this.chart = makeChart(this.plot, kShown * figure.series.length, () =>
      planeOption(this.figure, shown, looks(this.figure), { width: this.plot.clientWidth, height: this.plot.clientHeight, zoomed: 1 }));
    onThemeChange(() => this.name());
  }

  name() {
    const look = looks(this.figure);
    if (this.figure.series.length > 1)
      this.legend.replaceChildren(...this.figure.series.map((series, s) => element("span", { class: "entry" }, swatch(look[s]), series.name)));
  }

  /** Lines are not drawn across a re-mounting. */
  add(reading, ...more) {
    const points = this.take(reading, ...more);
    if (this.setup !== undefined && reading.setup !== this.setup) this.push(points.map(([x]) => [x, null, null]));
    this.setup = reading.setup;
    this.push(points);
  }

  push(points) {
    points.forEach(([x, y, u], s) => {
      const series = this.figure.series[s];
      if (x === null || y === undefined) return;
      [[series.x, x], [series.y, y], ...(series.u ? [[series.u, u]] : [])].forEach(([list, value]) => {
        list.push(value);
        if (list.length > kShown) list.shift();
      });
    });
    this.plot.dataset.points = this.figure.series.reduce((sum, series) => sum + series.x.length, 0);
  }
}

const empty = (name, more) => ({ name, role: "estimate", x: [], y: [], ...more });

/** Pairs of columns that are x and y of one thing, by their names: "psd a x", "psd a y". */
function pairs(columns) {
  return columns.flatMap((column, x) => {
    if (column.role !== "shown" || !/\bx$/.test(column.name)) return [];
    const y = columns.findIndex((other) => other.name === column.name.replace(/x$/, "y") && other.unit === column.unit);
    return y < 0 ? [] : [{ x, y, name: column.name.replace(/ ?x$/, "") }];
  });
}

function trackCard(columns, { x, y, name }) {
  const axis = (c) => ({ name: columns[c].name, unit: columns[c].unit });
  return new LiveCard({ form: "track", title: name, x: axis(x), y: axis(y), series: [empty(name)] }, ({ v }) => [[v[x], v[y] ?? undefined]]);
}

/** Everything with one unit and one role in one plot against the bench's time. */
function timeCards(columns, role, title) {
  const units = [...new Set(columns.filter((c) => c.role === role && !c.name.endsWith(" std")).map((c) => c.unit))];
  return units.map((unit) => {
    const of = columns.flatMap((c, k) => (c.role === role && c.unit === unit && !c.name.endsWith(" std") ? [k] : []));
    const name = units.length > 1 ? `${title}, ${unit || "numbers"}` : title;
    return new LiveCard(
      { form: "line", title: name, x: { name: "bench time", unit: "s" }, y: { name: of.length > 1 ? "" : columns[of[0]].name, unit }, series: of.map((k) => empty(columns[k].name)) },
      ({ t, v }) => of.map((k) => [t, v[k] ?? undefined]),
    );
  });
}

/** What the readings deviate by from their prediction, one plot a channel, with its expanded uncertainty and the limits that raise an alarm about zero. */
export function residualFigures(channels) {
  const limit = (name) => empty(name, { role: "expected" });
  return figuresOf(channels.map(({ name, unit }, c) => new LiveCard(
    { form: "line", title: `Residual of ${name}`, x: { name: "reading", unit: "" }, y: { name: "reading less prediction", unit },
      series: [empty("residual"), empty("U, k = 2", { u: [], k: 2 }), limit("upper limit"), limit("lower limit")] },
    ({ n, v, u }, limit_u) => {
      const at = (y) => [n, u[c] === null ? null : y, u[c]];
      return [[n, v[c]], at(0), at(limit_u * u[c]), at(-limit_u * u[c])];
    },
  )));
}

/** Means over the trials so far, one plot a result, with the standard uncertainty of the mean about it where there is one. */
export const meanFigures = (names) => figuresOf(names.map((name, r) => new LiveCard(
  { form: "line", title: `Mean of ${name}`, x: { name: "trials", unit: "" }, y: { name: "mean", unit: "" }, series: [empty("mean and u", { u: [], k: 1 })] },
  ({ trials, results }) => [[trials, results[r]?.mean ?? null, results[r]?.u_mean ?? null]],
)));

const figuresOf = (all) => ({
  cards: all.map((card) => card.element),
  add: (...told) => all.forEach((card) => card.add(...told)),
  draw: () => all.forEach((card) => card.chart.draw()),
});

/** @param columns  Of the readings: name, unit, role. */
export const liveFigures = (columns) =>
  figuresOf([...pairs(columns).map((pair) => trackCard(columns, pair)), ...timeCards(columns, "axis", "Axes"), ...timeCards(columns, "shown", "Shown")]);
