// y +- k u as a band along a curve, drawn in the coordinates of the chart, so that it zooms with it.

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
