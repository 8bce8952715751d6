// The steps of an investigation: which run is made and why, and what is believed after it.
import { element } from "./dom.js";

const percent = (p) => (p < 0.0005 ? "< 0.1 %" : `${(100 * p).toFixed(1)} %`);

/** Bars are drawn by the browser's own meter, which says its value to whoever cannot see it. */
function causeRow(name, probability) {
  return element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, percent(probability)),
    element("td", {}, element("meter", { min: 0, max: 1, value: probability, "aria-label": `${name}: ${percent(probability)}` })));
}

export function inquiry() {
  const now = element("p", { id: "step", role: "status" }, "");
  const body = element("tbody");
  const after = element("p", { class: "subtitle", id: "believed" }, "No run has been weighed yet");
  const done = element("ol", { class: "steps", id: "steps" });
  const part = element("section", { class: "part", "aria-label": "Investigation", hidden: true },
    element("h2", {}, "Investigation"), now, after,
    element("table", { id: "causes" }, element("thead", {}, element("tr", {}, element("th", { scope: "col" }, "cause"), element("th", { scope: "col" }, "probability"), element("th", { scope: "col" }, ""))), body),
    done);
  return {
    element: part,
    step: ({ number, run, reason }) => {
      part.hidden = false;
      now.textContent = `Step ${number}: ${run}. ${reason}`;
    },
    believed: ({ number, run, minutes, causes, unlisted }) => {
      part.hidden = false;
      after.textContent = `Believed after step ${number}`;
      body.replaceChildren(...causes.map(({ name, probability }) => causeRow(name, probability)), causeRow("something that is not listed", unlisted));
      done.append(element("li", {}, `${run}, ${minutes.toFixed(1)} min: ${causes.length ? `${causes[0].name} ${percent(causes[0].probability)}` : "nothing"}`));
    },
  };
}
