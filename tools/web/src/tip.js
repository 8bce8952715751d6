// What is shown while the pointer or the cursor keys are on a plot: elements, never markup.
import { element } from "./dom.js";
import { measured, number, withUnit } from "./format.js";

/** The series of the figure that have a point at this place, as [name, value]. */
export function valuesAt(figure, shown, x) {
  const rows = [];
  figure.series.forEach((series, s) => {
    if (!shown[s]) return;
    const k = series.x.indexOf(x);
    if (k >= 0) rows.push([series.name, withUnit(measured(series.y[k], series.u?.[k], series.k), figure.y.unit)]);
  });
  return rows;
}

export function tipElement(head, rows) {
  return element(
    "div", { class: "tip" },
    element("strong", {}, head),
    ...rows.map(([name, value]) => element("div", {}, element("span", {}, name), element("b", {}, value))),
  );
}

export function headAt(figure, x) {
  const name = figure.categories ? figure.categories[x] : number(x);
  return withUnit(figure.x.name ? `${figure.x.name} ${name}` : name, figure.x.unit);
}
