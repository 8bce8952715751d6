// y against x: lines, points, and tracks whose axes have one scale.
import { band } from "./bands.js";
import { axis, base, grid, itemStyle, lineStyle, zoom } from "./common.js";
import { shadeCss } from "./colours.js";
import { number, withUnit } from "./format.js";
import { headAt, tipElement, valuesAt } from "./tip.js";
import { palette } from "./theme.js";

const kMany = 2000;

function drawn(figure, series, look, paper) {
  const data = series.x.map((x, k) => [x, series.y[k]]);
  const many = data.length > kMany;
  if (figure.form === "points" || figure.form === "track") {
    if (series.shade) {
      const [low, high] = figure.shades;
      return {
        type: "scatter", name: series.name, symbol: look.symbol, symbolSize: 8,
        data: data.map((value, k) => ({ value: [...value, series.shade[k]], itemStyle: { color: shadeCss((series.shade[k] - low) / (high - low || 1)) } })),
      };
    }
    return {
      type: "scatter", name: series.name, data, symbol: look.symbol, symbolSize: many ? 3 : 6, large: many, largeThreshold: kMany,
      itemStyle: { ...itemStyle(look, paper), opacity: many ? 0.6 : 0.9 }, emphasis: { scale: 1.6 },
    };
  }
  return {
    type: "line", name: series.name, data, sampling: many ? "lttb" : undefined, symbol: look.symbol, symbolSize: 5,
    showSymbol: data.length <= 100, lineStyle: lineStyle(look), itemStyle: itemStyle(look, paper), z: look.open ? 4 : 3, connectNulls: false, emphasis: { scale: 2, lineStyle: { width: look.width } },
  };
}

/** Both axes about the middle of the points, with the same length of scale in the plot's rectangle. */
function equalRanges(figure, shown, box) {
  const range = (key) => {
    let low = Infinity;
    let high = -Infinity;
    figure.series.forEach((series, s) => {
      if (shown[s]) for (const value of series[key]) if (value !== null) (low = Math.min(low, value)), (high = Math.max(high, value));
    });
    return low <= high ? [low, high] : [0, 1];
  };
  const [x, y] = [range("x"), range("y")];
  const width = Math.max(50, box.width - grid.left - grid.right);
  const height = Math.max(50, box.height - grid.top - grid.bottom);
  const scale = 1.1 * Math.max((x[1] - x[0]) / width, (y[1] - y[0]) / height) || 1 / width;
  const about = ([low, high], length) => ({ min: (low + high - scale * length) / 2, max: (low + high + scale * length) / 2 });
  const ends = { axisLabel: { color: palette().soft, fontSize: 11, formatter: number, hideOverlap: true, showMinLabel: false, showMaxLabel: false } };
  return [{ ...about(x, width), ...ends }, { ...about(y, height), ...ends }];
}

/** Room for the bands, which the library does not see. */
function rangeWithBands(figure, shown) {
  let [low, high] = [Infinity, -Infinity];
  figure.series.forEach((series, s) => {
    if (!shown[s] || !series.u) return;
    series.y.forEach((y, k) => {
      if (y === null || series.u[k] === null) return;
      low = Math.min(low, y - series.k * series.u[k]);
      high = Math.max(high, y + series.k * series.u[k]);
    });
  });
  if (low > high) return {};
  return { min: (of) => nice(Math.min(low, of.min), low, high, Math.floor), max: (of) => nice(Math.max(high, of.max), low, high, Math.ceil) };
}

/** The next round number outwards. */
function nice(value, low, high, outwards) {
  const unit = 10 ** Math.floor(Math.log10(high - low || Math.abs(high) || 1)) / 2;
  return Number((outwards(value / unit) * unit).toPrecision(12));
}

export function planeOption(figure, shown, looks, box) {
  const colours = palette();
  const series = [];
  figure.series.forEach((s, k) => {
    if (!shown[k]) return;
    if (s.u) series.push(band(s, (x, y) => [x, y], { colour: looks[k].colour, clip: true }));
    series.push(drawn(figure, s, looks[k], colours.paper));
  });
  const [low, high] = figure.y.ends ?? [];
  const [x, y] = figure.form === "track" ? equalRanges(figure, shown, box) : [{}, {}];
  const yRange = figure.form === "track" ? y : figure.y.ends ? { min: low, max: high } : rangeWithBands(figure, shown);
  const wholeNumbers = figure.series.every((s) => s.x.every(Number.isInteger));
  const trigger = figure.form === "track" || figure.form === "points" ? "item" : "axis";
  return {
    ...base(),
    grid,
    xAxis: axis(figure.x, { ...x, minInterval: wholeNumbers ? 1 : 0, ...(trigger === "axis" ? { min: "dataMin", max: "dataMax" } : {}) }),
    yAxis: axis(figure.y, { nameGap: 48, ...yRange }),
    dataZoom: [...zoom({ xAxisIndex: 0 }), ...zoom({ yAxisIndex: 0 })],
    tooltip: {
      ...base().tooltip, trigger,
      formatter: (at) => {
        const point = Array.isArray(at) ? at[0] : at;
        if (trigger === "axis") return tipElement(headAt(figure, point.value[0]), valuesAt(figure, shown, point.value[0]));
        return tipElement(point.seriesName, [
          [figure.x.name, withUnit(number(point.value[0]), figure.x.unit)],
          [figure.y.name, withUnit(number(point.value[1]), figure.y.unit)],
          ...(figure.shaded ? [[figure.shaded.name, withUnit(number(point.value[2]), figure.shaded.unit)]] : []),
        ]);
      },
    },
    series,
  };
}
