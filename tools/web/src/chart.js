// One drawn chart: made when its turn comes, drawn again when size, theme, view or choice change.
import { echarts } from "./library.js";
import { onThemeChange } from "./theme.js";

const kFewForSvg = 4000; // points: few are drawn sharp at any size, many fast
const waiting = [];
let working = false;

function work() {
  const begun = performance.now();
  while (waiting.length && performance.now() - begun < 30) waiting.shift()();
  working = waiting.length > 0;
  if (working) setTimeout(work);
}

/** Charts are drawn one after another, so that the page answers meanwhile. */
function later(task) {
  waiting.push(task);
  if (!working) (working = true), setTimeout(work);
}
addEventListener("beforeprint", () => waiting.splice(0).forEach((task) => task()));

/**
 * @param plot    The element to draw in.
 * @param points  How many points there are in all.
 * @param option  () -> what the library takes.
 */
export function makeChart(plot, points, option) {
  let chart;
  const draw = () => {
    if (!plot.isConnected) return;
    chart ??= echarts.init(plot, null, { renderer: points <= kFewForSvg ? "svg" : "canvas" });
    chart.resize();
    chart.setOption(option(), { notMerge: true });
    plot.querySelector("svg")?.setAttribute("viewBox", `0 0 ${chart.getWidth()} ${chart.getHeight()}`); // on paper it is made as wide as the card
    plot.dataset.drawn = "yes";
  };
  later(draw);
  new ResizeObserver(() => chart && later(draw)).observe(plot);
  onThemeChange(() => chart && draw());
  return { draw: () => (chart ? draw() : later(draw)), get: () => chart };
}
