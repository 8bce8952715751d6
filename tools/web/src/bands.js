// y +- k u: a band along a curve, whiskers on bars. Drawn in the coordinates of the chart, so they zoom with it.

/** Runs of points that follow each other without a gap. */
function runs(series) {
  const found = [];
  let run = [];
  for (let k = 0; k < series.y.length; ++k) {
    if (series.y[k] !== null && series.u[k] !== null) run.push(k);
    else if (run.length) found.push(run.splice(0));
  }
  return run.length ? [...found, run] : found;
}

/** @param at  (x, y) -> what the coordinate system takes. */
export function band(series, at, how) {
  const parts = runs(series);
  const edge = (api, k, sign) => api.coord(at(series.x[k], series.y[k] + sign * series.k * series.u[k]));
  return {
    type: "custom", ...how, silent: true, z: 1, tooltip: { show: false }, animation: false,
    // Each run is one item; its shape is that of all of its points.
    data: parts.map((run) => at(series.x[run[0]], series.y[run[0]])),
    renderItem: (params, api) => {
      const run = parts[params.dataIndex];
      const upper = run.map((k) => edge(api, k, 1));
      const lower = run.map((k) => edge(api, k, -1)).reverse();
      return {
        type: "polygon",
        shape: { points: [...upper, ...lower] },
        style: { fill: how.colour, opacity: 0.2 },
      };
    },
  };
}

/** @param placeOf  x -> its place on the axis: a number, or the index of a category. */
export function whiskers(series, placeOf, how) {
  const with_u = series.y.map((_, k) => k).filter((k) => series.y[k] !== null && series.u[k] !== null);
  return {
    type: "custom", ...how, silent: true, z: 5, tooltip: { show: false }, animation: false, clip: true,
    data: with_u.map((k) => [placeOf(series.x[k]), series.y[k]]),
    renderItem: (params, api) => {
      const k = with_u[params.dataIndex];
      const half = series.k * series.u[k];
      const low = Math.max(series.y[k] - half, how.lowest ?? -Infinity);
      const [top, foot] = [api.coord([api.value(0), series.y[k] + half]), api.coord([api.value(0), low])];
      const style = { stroke: how.colour, lineWidth: 1 };
      const line = (x1, y1, x2, y2) => ({ type: "line", shape: { x1, y1, x2, y2 }, style });
      return {
        type: "group",
        children: [
          line(top[0], top[1], foot[0], foot[1]),
          line(top[0] - 3, top[1], top[0] + 3, top[1]),
          line(foot[0] - 3, foot[1], foot[0] + 3, foot[1]),
        ],
      };
    },
  };
}
