// Spectra and histograms: a bar for each place on the axis, and a line for what noise or chance would do.
import { axis, base, grid, lineStyle, zoom } from "./common.js";
import { number } from "./format.js";
import { headAt, tipElement, valuesAt } from "./tip.js";
import { palette } from "./theme.js";

/** All places that any series has, ascending. */
function placesOf(figure) {
  return [...new Set(figure.series.flatMap((series) => series.x))].sort((a, b) => a - b);
}

/** A logarithmic axis ends below the line of noise, or else a little below the smallest bar; what is rounded to nothing is none. */
function smallest(figure) {
  const noise = figure.series.filter(({ role }) => role === "expected");
  const sizes = (noise.length ? noise : figure.series).flatMap(({ y }) => y).filter((y) => y > 0);
  const least = Math.max(Math.min(...sizes), 1e-6 * Math.max(...sizes));
  return 10 ** Math.floor(Math.log10(noise.length ? least / 5 : least));
}

export function barsOption(figure, shown, looks, logarithmic) {
  const places = placesOf(figure);
  const visible = figure.series.map((series, k) => ({ series, look: looks[k] })).filter((_, k) => shown[k]);
  const lowest = logarithmic ? smallest(figure) : undefined;
  const series = [];
  visible.forEach(({ series: s, look }) => {
    const at = new Map(s.x.map((x, k) => [x, k]));
    const size = (x) => (at.has(x) ? s.y[at.get(x)] : null);
    if (s.role === "expected") {
      series.push({ type: "line", name: s.name, data: places.map((x) => [String(x), size(x)]), symbol: "none", lineStyle: lineStyle(look), itemStyle: { color: look.colour } });
      return;
    }
    series.push({
      type: "bar", name: s.name, data: places.map((x) => [String(x), size(x)]), barMaxWidth: figure.form === "histogram" ? undefined : 22, barGap: "15%",
      barCategoryGap: figure.form === "histogram" ? "4%" : "30%",
      itemStyle: {
        color: look.open ? "transparent" : look.colour, borderColor: look.colour, borderWidth: look.open ? 1.5 : 0,
        borderType: look.dash,
      },
    });
  });
  return {
    ...base(),
    grid,
    xAxis: axis(figure.x, { type: "category", data: places.map(String), splitLine: { show: false }, axisLabel: { color: palette().soft, fontSize: 11, formatter: (x) => number(Number(Number(x).toPrecision(3))), hideOverlap: true } }),
    yAxis: axis(figure.y, { nameGap: 46, scale: false, ...(logarithmic ? { type: "log", min: lowest, startValue: lowest } : {}) }),
    dataZoom: zoom({ xAxisIndex: 0 }),
    tooltip: {
      ...base().tooltip, trigger: "axis", axisPointer: { type: "shadow" },
      formatter: (points) => {
        const x = Number(points[0].axisValue);
        return tipElement(headAt(figure, x), valuesAt(figure, shown, x));
      },
    },
    series,
  };
}
