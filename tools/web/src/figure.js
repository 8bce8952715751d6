// A figure as a card: title, views, legend, plot, the line that says what the cursor is on, and its numbers.
import { addCursor } from "./cursor.js";
import { makeChart } from "./chart.js";
import { button, element, slug } from "./dom.js";
import { axisTitle } from "./format.js";
import { looks, swatch } from "./looks.js";
import { addRectangle } from "./rectangle.js";
import { numbersTable } from "./table.js";
import { isDark, onThemeChange, palette } from "./theme.js";
import { viewsOf } from "./views.js";

/** A polar plot has no axis beside which the unit could stand. */
const titleOf = ({ form, title, y }) => (form === "angle" && y.unit ? `${title} [${y.unit}]` : title);

function pressed(made, is) {
  made.setAttribute("aria-pressed", String(is));
}

class Card {
  constructor(figure) {
    this.figure = figure;
    this.shown = figure.series.map(() => true);
    this.views = viewsOf(figure);
    this.view = this.views[0];
    this.zoomed = 1;
    this.points = figure.series.reduce((sum, series) => sum + series.y.length, 0);
    this.plot = element("div", {
      class: "plot", tabindex: 0, role: "application",
      "aria-label": `${figure.title}, ${axisTitle(figure.y)} against ${axisTitle(figure.x) || "categories"}. Arrow keys read the values, + and - zoom, Z draws a rectangle to zoom into, 0 shows all.`,
    });
    this.readout = element("p", { class: "readout", role: "status" });
    this.element = element("figure", { class: "card", id: `figure-${slug(figure.title)}` }, this.head(), this.legend(), this.plot, this.readout, this.numbers());
    if (this.view.wide) this.element.classList.add("wide");
    this.size();
    this.rectangle = addRectangle(this.plot, figure, this);
    addCursor(this.plot, figure, this);
    this.chart = makeChart(this.plot, this.points, () => this.option());
    this.plot.addEventListener("dblclick", () => this.unzoom());
    this.plot.addEventListener("blur", () => this.leave());
    onThemeChange(() => this.legendElement.replaceWith(this.legend()));
  }

  box() {
    return { width: this.plot.clientWidth, height: this.plot.clientHeight, zoomed: this.zoomed };
  }

  option() {
    this.note.textContent = [this.figure.note, this.view.note?.(this.figure, this.shown, this.zoomed)].filter(Boolean).join(", ");
    return this.view.option(this.figure, this.shown, looks(this.figure), this.box());
  }

  size() {
    this.plot.classList.toggle("square", Boolean(this.view.square));
    if (this.view.height) this.plot.style.height = `${this.view.height(this.figure, this.plot.clientWidth || innerWidth - 80)}px`;
  }

  head() {
    const tools = element("div", { class: "tools", role: "group", "aria-label": `View of ${this.figure.title}` });
    if (this.views.length > 1) tools.append(...this.viewButtons());
    if (this.view.zooms || this.view.square) {
      tools.append(
        button("+", () => this.zoom(0.6), { "aria-label": "Zoom in", title: "Zoom in (Ctrl + wheel)" }),
        button("\u2212", () => this.zoom(1 / 0.6), { "aria-label": "Zoom out", title: "Zoom out" }),
        this.rectangleButton(),
        button("All", () => this.unzoom(), { title: "Show all (double click)" }),
      );
    }
    tools.append(this.numbersButton(), button("Save", () => this.save(), { title: "Save this picture" }));
    this.note = element("p", { class: "note" }, this.figure.note);
    return element("figcaption", {}, element("div", {}, element("h3", {}, titleOf(this.figure)), this.note), tools);
  }

  viewButtons() {
    const buttons = this.views.map((view) =>
      button(view.name, () => {
        this.view = view;
        this.zoomed = 1;
        this.rectangle.end();
        this.toRectangle.hidden = !view.zooms;
        buttons.forEach((other, k) => pressed(other, this.views[k] === view));
        this.size();
        this.chart.draw();
      }, { "aria-pressed": String(view === this.view) }),
    );
    return buttons;
  }

  rectangleButton() {
    this.toRectangle = button("Rectangle", () => {
      this.rectangle.begin();
      this.plot.focus();
    }, { "aria-pressed": "false", title: "Zoom into a rectangle (Shift and drag, or Z in the plot)" });
    this.toRectangle.hidden = !this.view.zooms;
    return this.toRectangle;
  }

  /** A polar plot has no rectangles. */
  takesRectangle() {
    return Boolean(this.view.zooms && this.chart.get());
  }

  frame() {
    return this.chart.get().getModel().getComponent("grid").coordinateSystem.getRect();
  }

  onRectangle(is) {
    if (this.toRectangle) pressed(this.toRectangle, is);
    if (is) this.leave();
  }

  /** What lies in a rectangle of the plot; bars have places along x only. */
  rangeOf({ left, top, right, bottom }) {
    const chart = this.chart.get();
    const [[x0, y1], [x1, y0]] = [[left, top], [right, bottom]].map((at) => chart.convertFromPixel({ gridIndex: 0 }, at));
    const hasY = chart.getOption().dataZoom.length > 1;
    const place = (x) => (this.figure.form === "bars" || this.figure.form === "histogram" ? Number(chart.getOption().xAxis[0].data[x]) : x);
    return { x: [place(x0), place(x1)], y: hasY ? [y0, y1] : undefined, ends: hasY ? [[x0, x1], [y0, y1]] : [[x0, x1]] };
  }

  zoomInto(pixels) {
    const { ends } = this.rangeOf(pixels);
    this.chart.get().dispatchAction({
      type: "dataZoom", batch: ends.map(([startValue, endValue], dataZoomIndex) => ({ dataZoomIndex, startValue, endValue })),
    });
    this.plot.dataset.zoomed = "yes";
  }

  legend() {
    const look = looks(this.figure);
    const entries = this.figure.series.map((series, s) => {
      const entry = button("", () => {
        this.shown[s] = !this.shown[s];
        pressed(entry, this.shown[s]);
        this.chart.draw();
      }, { "aria-pressed": String(this.shown[s]), class: "entry" });
      entry.append(swatch(look[s]), element("span", {}, series.name));
      return entry;
    });
    const banded = this.figure.form !== "bars" && this.figure.series.find((series) => series.u);
    const note = banded ? element("span", { class: "band" }, `band: U, k = ${banded.k.toFixed(2)}`) : "";
    this.legendElement = element("div", { class: "legend", role: "group", "aria-label": `Series of ${this.figure.title}` }, ...entries, note);
    return this.legendElement;
  }

  numbersButton() {
    this.toNumbers = button("Numbers", () => {
      this.table.hidden = !this.table.hidden;
      if (!this.table.hidden && !this.table.firstChild) this.table.append(numbersTable(this.figure));
      this.toNumbers.setAttribute("aria-expanded", String(!this.table.hidden));
    }, { "aria-expanded": "false", title: "The numbers behind this plot" });
    return this.toNumbers;
  }

  numbers() {
    this.table = element("div", { class: "numbers", hidden: true });
    return this.table;
  }

  say(text) {
    this.readout.textContent = text;
  }

  /** Shows the library's tip at a point of the figure. */
  pointAt(s, k) {
    const chart = this.chart.get();
    if (!chart) return;
    const series = this.figure.series[s];
    if (this.view.place) {
      if (series.y[k] !== null) chart.dispatchAction({ type: "showTip", ...this.view.place(this.figure, this.shown, this.box(), series.x[k], series.y[k]) });
      return;
    }
    const name = series.name;
    const seriesIndex = chart.getOption().series.findIndex((series) => series.name === name && series.type !== "custom");
    const ascending = this.figure.form === "bars" || this.figure.form === "histogram";
    const places = ascending ? [...new Set(this.figure.series.flatMap((other) => other.x))].sort((a, b) => a - b) : undefined;
    const dataIndex = places ? places.indexOf(series.x[k]) : k;
    chart.dispatchAction({ type: "showTip", seriesIndex, dataIndex });
  }

  leave() {
    this.chart.get()?.dispatchAction({ type: "hideTip" });
  }

  zoom(by) {
    if (!this.view.zooms) {
      this.zoomed = Math.max(1, this.zoomed / by);
      return this.chart.draw();
    }
    const chart = this.chart.get();
    chart.getOption().dataZoom.forEach(({ start, end }, dataZoomIndex) => {
      const [middle, half] = [(start + end) / 2, Math.min(50, ((end - start) / 2) * by)];
      const from = Math.max(0, Math.min(100 - 2 * half, middle - half));
      chart.dispatchAction({ type: "dataZoom", dataZoomIndex, start: from, end: from + 2 * half });
    });
    this.plot.dataset.zoomed = "yes";
  }

  unzoom() {
    this.zoomed = 1;
    delete this.plot.dataset.zoomed;
    this.chart.draw();
  }

  save() {
    const chart = this.chart.get();
    const type = this.points <= 4000 ? "svg" : "png";
    const address = chart.getDataURL({ type, pixelRatio: 2, backgroundColor: isDark() ? palette().paper : "#fff" });
    element("a", { href: address, download: `${slug(this.figure.title)}.${type}` }).click();
  }
}

export const figureCard = (figure) => new Card(figure).element;
