// Cursor keys on a plot: left and right walk along the points, up and down change the series, + - 0 zoom, z draws a rectangle.
import { measured, withUnit } from "./format.js";
import { headAt } from "./tip.js";

/** What a figure says about one point, for the line below the plot and for screen readers. */
function spoken(figure, s, k) {
  const series = figure.series[s];
  const head = figure.categories ? figure.categories[k] : headAt(figure, series.x[k]);
  return `${series.name}, ${head}: ${withUnit(measured(series.y[k], series.u?.[k], series.k), figure.y.unit)}`;
}

export function addCursor(plot, figure, card) {
  let s = 0;
  let k = -1;
  const length = () => figure.series[s].y.length;
  const nextShown = (way) => {
    for (let n = 0; n < figure.series.length; ++n) {
      s = (s + way + figure.series.length) % figure.series.length;
      if (card.shown[s]) return;
    }
  };
  const move = (to) => {
    if (!card.shown[s]) nextShown(1);
    k = Math.max(0, Math.min(length() - 1, to));
    card.say(spoken(figure, s, k));
    card.pointAt(s, k);
  };
  const page = () => Math.max(1, Math.round(length() / 12));
  const keys = {
    ArrowRight: () => move(k + 1),
    ArrowLeft: () => move(k - 1),
    PageDown: () => move(k + page()),
    PageUp: () => move(k - page()),
    Home: () => move(0),
    End: () => move(length() - 1),
    ArrowUp: () => (nextShown(-1), move(Math.max(0, k))),
    ArrowDown: () => (nextShown(1), move(Math.max(0, k))),
    "+": () => card.zoom(0.6),
    "-": () => card.zoom(1 / 0.6),
    0: () => card.unzoom(),
    z: () => card.takesRectangle() && card.rectangle.begin(),
    Escape: () => card.leave(),
  };
  plot.addEventListener("keydown", (event) => {
    const act = event.ctrlKey || event.altKey || event.metaKey ? undefined : keys[event.key === "=" ? "+" : event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}
