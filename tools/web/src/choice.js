// Many figures of one kind, one shown at a time: a list for each question, and the card of what was chosen.
import { element, slug } from "./dom.js";
import { figureCard } from "./figure.js";

export function choiceCard(choice) {
  const place = element("div", {});
  const chosen = choice.answers[0].slice();
  const show = () => {
    const at = choice.answers.findIndex((answers) => answers.every((answer, q) => answer === chosen[q]));
    place.replaceChildren(at >= 0 ? figureCard(choice.figures[at]) : element("p", { class: "note" }, "There is no such plot."));
  };
  const lists = choice.questions.map((question, q) => {
    const answers = [...new Set(choice.answers.map((of) => of[q]))];
    const list = element(
      "select", { id: `${slug(choice.title)}-${q}`, onchange: () => ((chosen[q] = list.value), show()) },
      ...answers.map((answer) => element("option", { value: answer, selected: answer === chosen[q] }, answer)),
    );
    return element("label", { for: list.id }, `${question} `, list);
  });
  show();
  return element("section", { class: "choice wide" }, element("div", { class: "questions" }, element("h3", {}, choice.title), ...lists), place);
}
