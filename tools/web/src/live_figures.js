// Plots that grow with the readings: spots as tracks where two columns are x and y of one thing, the rest of what is shown against time.
import { makeChart } from "./chart.js";
import { element, slug } from "./dom.js";
import { axisTitle } from "./format.js";
import { looks, swatch } from "./looks.js";
import { planeOption } from "./plane.js";
import { onThemeChange } from "./theme.js";

const kShown = 600; // readings; older ones leave the plots

class LiveCard {
  /** @param figure  With empty series.  @param take  (reading, values) -> [x, y] of each series. */
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

  add(reading) {
    this.take(reading).forEach(([x, y], s) => {
      const series = this.figure.series[s];
      if (x === null || y === null) return;
      series.x.push(x);
      series.y.push(y);
      if (series.x.length > kShown) series.x.shift(), series.y.shift();
    });
    this.plot.dataset.points = this.figure.series.reduce((sum, series) => sum + series.x.length, 0);
  }
}

const empty = (name) => ({ name, role: "estimate", x: [], y: [] });

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
  return new LiveCard({ form: "track", title: name, x: axis(x), y: axis(y), series: [empty(name)] }, ({ v }) => [[v[x], v[y]]]);
}

/** Everything with one unit and one role in one plot against the bench's time. */
function timeCards(columns, role, title) {
  const units = [...new Set(columns.filter((c) => c.role === role && !c.name.endsWith(" std")).map((c) => c.unit))];
  return units.map((unit) => {
    const of = columns.flatMap((c, k) => (c.role === role && c.unit === unit && !c.name.endsWith(" std") ? [k] : []));
    const name = units.length > 1 ? `${title}, ${unit || "numbers"}` : title;
    return new LiveCard(
      { form: "line", title: name, x: { name: "bench time", unit: "s" }, y: { name: of.length > 1 ? "" : columns[of[0]].name, unit }, series: of.map((k) => empty(columns[k].name)) },
      ({ t, v }) => of.map((k) => [t, v[k]]),
    );
  });
}

/** What the readings deviate by from their prediction, one plot a channel, with twice the standard uncertainty about it. */
export function residualFigures(channels) {
  const cards = channels.map(({ name, unit }, c) => new LiveCard(
    { form: "line", title: `Residual of ${name.replaceAll("_", " ")}`, x: { name: "reading", unit: "" }, y: { name: "reading - prediction", unit },
      series: [empty("residual"), empty("+2 u"), empty("-2 u")] },
    ({ n, v, u }) => [[n, v[c]], [n, u[c] === null ? null : 2 * u[c]], [n, u[c] === null ? null : -2 * u[c]]],
  ));
  return {
    cards: cards.map((card) => card.element),
    add: (readings) => readings.forEach((reading) => cards.forEach((card) => card.add(reading))),
    draw: () => cards.forEach((card) => card.chart.draw()),
  };
}

/** Means over the trials so far, one plot a result, with the standard uncertainty of the mean about it where there is one. */
export function meanFigures(names) {
  const cards = names.map((name, r) => new LiveCard(
    { form: "line", title: `Mean of ${name}`, x: { name: "trials", unit: "" }, y: { name: "mean", unit: "" }, series: [empty("mean"), empty("+ u"), empty("- u")] },
    ({ trials, results }) => {
      const { mean, u_mean } = results[r];
      const edge = (way) => [trials, mean === null || u_mean === null ? null : mean + way * u_mean];
      return [[trials, mean], edge(1), edge(-1)];
    },
  ));
  return {
    cards: cards.map((card) => card.element),
    add: (told) => cards.forEach((card, r) => told.results[r] && card.add(told)),
    draw: () => cards.forEach((card) => card.chart.draw()),
  };
}

/** @param columns  Of the readings: name, unit, role. */
export function liveFigures(columns) {
  const all = [...pairs(columns).map((pair) => trackCard(columns, pair)), ...timeCards(columns, "axis", "Axes"), ...timeCards(columns, "shown", "Shown")];
  return {
    cards: all.map((card) => card.element),
    add: (reading) => all.forEach((card) => card.add(reading)),
    draw: () => all.forEach((card) => card.chart.draw()),
  };
}
