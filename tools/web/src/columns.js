// Columns, of which the reader of the page chooses which to plot against which, and which gives the points their colour.
import { colourScale } from "./scale.js";
import { rangeOf } from "./colours.js";
import { element, slug } from "./dom.js";
import { figureCard } from "./figure.js";
import { axisTitle } from "./format.js";
import { onThemeChange } from "./theme.js";

/** Points with the same value of the group are one series. */
function seriesOf({ columns, group }, x, y, colour) {
  const all = group >= 0 ? columns[group].values : null;
  const kinds = all ? [...new Set(all)].sort((a, b) => a - b) : [null];
  return kinds.map((kind) => {
    const of = (c) => columns[c].values.filter((_, k) => !all || all[k] === kind);
    return {
      name: kind === null ? "points" : `${columns[group].name} ${kind}`, role: "estimate", x: of(x), y: of(y),
      ...(colour >= 0 ? { shade: of(colour) } : {}),
    };
  });
}

export function columnsCard(block) {
  const chosen = { y: block.y, x: block.x, colour: block.colour };
  const place = element("div", {});
  const show = () => {
    const [x, y] = [block.columns[chosen.x], block.columns[chosen.y]];
    const colour = chosen.colour >= 0 ? block.columns[chosen.colour] : null;
    const figure = {
      form: "points", title: `${y.name} against ${x.name}`, note: block.note, x, y, series: seriesOf(block, chosen.x, chosen.y, chosen.colour),
      ...(colour ? { shades: rangeOf(colour.values), shaded: colour } : {}),
    };
    place.replaceChildren(figureCard(figure), colour ? colourScale(colour.name, colour.unit, figure.shades) : "");
  };
  const list = (key, word, none) => {
    const made = element(
      "select", { id: `${slug(block.title)}-${key}`, onchange: () => ((chosen[key] = Number(made.value)), show()) },
      ...(none ? [element("option", { value: -1, selected: chosen[key] < 0 }, none)] : []),
      ...block.columns.map((column, c) => element("option", { value: c, selected: c === chosen[key] }, axisTitle(column))),
    );
    return element("label", { for: made.id }, `${word} `, made);
  };
  show();
  onThemeChange(show);
  return element(
    "section", { class: "choice wide" },
    element("div", { class: "questions" }, element("h3", {}, block.title), list("y", "plot"), list("x", "against"), list("colour", "coloured by", block.group >= 0 ? block.columns[block.group].name : "nothing")),
    place,
  );
}
