// How series are told apart: colour, dash and symbol together; in ink are truth, dotted with open marks, and what noise or chance would do, dashed.
import { dashes, palette, symbols } from "./theme.js";

/** One look for each series of a figure. */
export function looks(figure) {
  const colours = palette();
  let next = 0;
  return figure.series.map((series) => {
    if (series.role === "expected") return { colour: colours.ink, dash: [8, 4], symbol: "none", open: false, width: 1.5 };
    if (series.role === "truth") return { colour: colours.ink, dash: [2, 4], symbol: "diamond", open: true, width: 1.5 };
    const k = next++ % colours.series.length;
    return { colour: colours.series[k], dash: dashes[k], symbol: symbols[k], open: series.role === "before", width: 2 };
  });
}

/** The same as a small picture for the legend. */
export function swatch(look) {
  const ns = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(ns, "svg");
  svg.setAttribute("viewBox", "0 0 28 12");
  svg.setAttribute("aria-hidden", "true");
  const line = document.createElementNS(ns, "path");
  line.setAttribute("d", "M1 6h26");
  line.setAttribute("stroke", look.colour);
  line.setAttribute("stroke-width", look.width);
  line.setAttribute("stroke-dasharray", look.dash === "solid" ? "none" : look.dash.join(" "));
  const mark = document.createElementNS(ns, "path");
  mark.setAttribute("d", { rect: "M11 3h6v6h-6z", triangle: "M14 2l4 7h-8z", diamond: "M14 1l5 5-5 5-5-5z", none: "M1 6h0" }[look.symbol] ?? "M14 2.5a3.5 3.5 0 1 0 .01 0z");
  mark.setAttribute("fill", look.open ? "none" : look.colour);
  mark.setAttribute("stroke", look.colour);
  svg.append(line, mark);
  return svg;
}
