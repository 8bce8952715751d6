// Tables: of the page, and of the numbers behind a plot.
import { element, slug } from "./dom.js";
import { axisTitle, number } from "./format.js";

const isNumber = (text) => /^[-\u2212+<]? ?[\d.]+(e[-+\u2212]?\d+)?(?!\w)/.test(text) && !/[a-z]{3}/i.test(text);
const kMostRows = 2000;

function rowsOf(columns, rows, links = []) {
  const numeric = columns.map((_, c) => rows.every((row) => row[c] === "" || isNumber(row[c])));
  const cell = (tag, text, c, more = {}) => element(tag, { class: numeric[c] ? "number" : undefined, ...more }, text);
  return [
    element("thead", {}, element("tr", {}, ...columns.map((name, c) => cell("th", name, c, { scope: "col" })))),
    element("tbody", {}, ...rows.map((row, r) => element("tr", {}, ...row.map((text, c) => (c === 0 ? cell("th", links[r] ? element("a", { href: encodeURI(links[r]) }, text) : text, c, { scope: "row" }) : cell("td", text.replace(/(^|e)-(?=\d)/g, "$1\u2212"), c)))))),
  ];
}

/** A table that may be wider or longer than the page scrolls for itself, by keys too. */
function scrolled(name, ...parts) {
  return element("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": name }, element("table", {}, ...parts));
}

export function tableCard(table) {
  return element(
    "section", { class: "card wide", id: `table-${slug(table.title)}` },
    element("h3", {}, table.title),
    scrolled(table.title, ...rowsOf(table.columns, table.rows, table.links)),
  );
}

export function numbersTable(figure) {
  const columns = ["series", figure.categories ? "category" : axisTitle(figure.x), axisTitle(figure.y), "u"];
  const rows = [];
  for (const series of figure.series) {
    series.y.forEach((y, k) => {
      if (rows.length < kMostRows) rows.push([series.name, figure.categories?.[k] ?? number(series.x[k]), number(y), series.u ? number(series.u[k]) : ""]);
    });
  }
  return scrolled(`Numbers of ${figure.title}`, ...rowsOf(columns, rows));
}
