// A curve against an angle as a polar plot: zero is a circle, so that errors of both signs can be seen.
import { band } from "./bands.js";
import { base, itemStyle, lineStyle } from "./common.js";
import { axisTitle, number, withUnit } from "./format.js";
import { headAt, tipElement, valuesAt } from "./tip.js";
import { palette } from "./theme.js";

function largest(figure, shown) {
  let size = 0;
  figure.series.forEach((series, s) => {
    if (!shown[s]) return;
    series.y.forEach((y, k) => {
      if (y !== null) size = Math.max(size, Math.abs(y) + (series.u?.[k] ? series.k * series.u[k] : 0));
    });
  });
  return size || 1;
}

/** 1, 2 or 5 times a power of ten, at least `size / 2`. */
function step(size) {
  const power = 10 ** Math.floor(Math.log10(size / 2));
  return [1, 2, 5, 10].map((k) => k * power).find((candidate) => candidate >= size / 2);
}

/** The way round is closed where the last point has come nearly back to the first. */
function closed(series) {
  const points = series.x.map((x, k) => [series.y[k], x]);
  const way = series.x.length > 1 ? Math.abs(series.x.at(-1) - series.x[0]) : 0;
  const gap = Math.abs(series.x[1] - series.x[0]);
  return Math.abs(way + gap - 360) < gap / 2 ? [...points, points[0]] : points;
}

/** [px], with room for the angles around it. */
const radius = ({ width, height }) => Math.max(40, Math.min(width, height) / 2 - 40);

function radii(figure, shown, zoomed) {
  const size = largest(figure, shown) / zoomed;
  const tick = step(size);
  const outer = Math.ceil((size * 1.02) / tick) * tick;
  return { tick, outer, inner: -outer - tick };
}

/** How much larger deviations are drawn than the circle that they are deviations of. */
export function magnification(figure, shown, zoomed) {
  if (!figure.radius) return "";
  const times = Number((figure.radius / -radii(figure, shown, zoomed).inner).toPrecision(2));
  return `deviations magnified ${times.toLocaleString("en").replaceAll(",", "\u202f")} times`;
}

/** Where on the plot a point is drawn [px]. */
export function polarPlace(figure, shown, box, x, y) {
  const { inner, outer } = radii(figure, shown, box.zoomed);
  const r = (radius(box) * (y - inner)) / (outer - inner);
  const a = (x * Math.PI) / 180;
  return { x: box.width / 2 + r * Math.cos(a), y: box.height / 2 - r * Math.sin(a) };
}

export function polarOption(figure, shown, looks, box) {
  const colours = palette();
  const { tick, outer, inner } = radii(figure, shown, box.zoomed);
  const series = [
    {
      type: "line", coordinateSystem: "polar", silent: true, symbol: "none", tooltip: { show: false }, z: 0,
      lineStyle: { color: colours.soft, type: [5, 4], width: 1 },
      data: Array.from({ length: 181 }, (_, k) => [0, 2 * k]),
    },
  ];
  figure.series.forEach((s, k) => {
    if (!shown[k]) return;
    if (s.u) series.push(band(s, (x, y) => [Math.max(inner, Math.min(outer, y)), x], { coordinateSystem: "polar", colour: looks[k].colour }));
    series.push({
      type: "line", coordinateSystem: "polar", name: s.name, data: closed(s), symbol: looks[k].symbol, symbolSize: 5,
      showSymbol: s.x.length <= 100, emphasis: { scale: 2.4, lineStyle: { width: looks[k].width } }, lineStyle: lineStyle(looks[k]), itemStyle: itemStyle(looks[k], colours.paper), clip: true, z: looks[k].open ? 4 : 3,
    });
  });
  return {
    ...base(),
    polar: { radius: radius(box) },
    angleAxis: {
      type: "value", min: 0, max: 360, interval: 30, startAngle: 0, clockwise: false,
      axisLabel: { color: colours.soft, fontSize: 11, formatter: (a) => (a === 360 ? "" : `${a}\u00b0`) },
      axisLine: { lineStyle: { color: colours.line } }, axisTick: { show: false },
      splitLine: { lineStyle: { color: colours.line, opacity: 0.6 } },
    },
    radiusAxis: {
      type: "value", min: inner, max: outer, interval: tick,
      axisLine: { show: false }, axisTick: { show: false },
      axisLabel: { color: colours.ink, fontSize: 11, formatter: (r) => (Math.abs(r) < tick / 2 ? "0" : Math.abs(Math.abs(r) - outer) < tick / 2 ? withUnit(number(r), figure.y.unit) : ""), backgroundColor: colours.paper, padding: [1, 3] },
      splitLine: { lineStyle: { color: colours.line, opacity: 0.6 } },
    },
    tooltip: {
      ...base().tooltip, trigger: "axis",
      formatter: (points) => {
        const x = points[0].value[1];
        return tipElement(headAt(figure, x), valuesAt(figure, shown, x));
      },
    },
    series,
    aria: { label: axisTitle(figure.y) },
  };
}
