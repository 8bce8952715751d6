// A campaign: trials done and lost, and what the chosen results have come to so far.
import { element } from "./dom.js";
import { number } from "./format.js";
import { meanFigures } from "./live_figures.js";

const kLostShown = 50;
const percent = (share) => (share === null ? "\u2013" : `${(100 * share).toFixed(1)} %`);
const shownAs = (value) => (value === null ? "\u2013" : number(value));

/** @param clock  (seconds) -> text. */
export function campaign(clock) {
  const body = element("tbody");
  const lost = element("ol", { class: "alarms", id: "lost" });
  const cards = element("div", { class: "cards" });
  const heads = ["result", "count", "mean", "scatter", "rms error", "rms u", "bias", "in k u"];
  const part = element("section", { class: "part", "aria-label": "Campaign", hidden: true },
    element("h2", {}, "Results so far"), element("div", { role: "log", "aria-label": "Lost trials" }, lost),
    element("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Results so far" },
      element("table", { id: "results" }, element("thead", {}, element("tr", {}, ...heads.map((head) => element("th", { scope: "col" }, head)))), body)),
    cards);
  let figures;
  return {
    element: part,
    begin: () => (part.hidden = false),
    /** @return the line below the bar. */
    trials: ({ done, planned, lost: failed, left_s, trials, results }) => {
      if (!figures && results.length) {
        figures = meanFigures(results.map(({ name }) => name));
        cards.replaceChildren(...figures.cards);
      }
      figures?.add({ trials, results });
      body.replaceChildren(...results.map((r) => element("tr", {}, element("th", { scope: "row" }, r.name),
        ...[String(r.count), r.u_mean === null ? shownAs(r.mean) : `${number(r.mean)} \u00b1 ${number(Number(r.u_mean.toPrecision(2)))}`, shownAs(r.sd), shownAs(r.rms_error), shownAs(r.rms_u), shownAs(r.scored ? r.bias : null), percent(r.scored ? r.coverage95 : null)]
          .map((text) => element("td", { class: "number" }, text)))));
      return `${done} of ${planned} trials, ${failed} lost, ${clock(left_s)} left`;
    },
    lost: ({ trial, failure }) => {
      lost.append(element("li", {}, `trial ${trial}: ${failure}`));
      if (lost.children.length > kLostShown) lost.firstChild.remove();
    },
    draw: () => figures?.draw(),
  };
}
