// Reads the page's data and puts its sections one below the other.
import { choiceCard } from "./choice.js";
import { columnsCard } from "./columns.js";
import { element, slug } from "./dom.js";
import { figureCard } from "./figure.js";
import { imageCard } from "./image.js";
import { tableCard } from "./table.js";
import { textCard } from "./text.js";
import { themeButton } from "./theme.js";

const page = JSON.parse(document.getElementById("data").textContent);
const cards = { choice: choiceCard, columns: columnsCard, image: imageCard, figure: figureCard, table: tableCard, text: textCard };

function header() {
  return element(
    "header", {},
    element("div", { class: "brand" }, element("span", {}, "twinbench"), themeButton()),
    element("h1", {}, page.title),
    page.subtitle ? element("p", { class: "subtitle" }, page.subtitle) : "",
    tiles(),
    page.verdict ? element("p", { class: `verdict ${page.tone}` }, page.verdict) : "",
  );
}

function tiles() {
  if (!page.tiles?.length) return "";
  return element(
    "dl", { class: "tiles" },
    ...page.tiles.map(({ name, value, note, tone }) =>
      element("div", { class: `tile ${tone}` }, element("dt", {}, name), element("dd", { class: "value" }, value), note ? element("dd", { class: "note" }, note) : "")),
  );
}

function navigation() {
  return element(
    "nav", { "aria-label": "Sections" },
    element("ul", {}, ...page.sections.map(({ title }) => element("li", {}, element("a", { href: `#${slug(title)}` }, title)))),
  );
}

function section({ title, lead, blocks }) {
  return element(
    "section", { id: slug(title), class: "part" },
    element("h2", {}, title),
    lead ? element("p", { class: "lead" }, lead) : "",
    element("div", { class: "cards" }, ...blocks.map((block) => cards[block.type](block))),
  );
}

document.getElementById("page").append(
  header(),
  element("div", { class: "columns" }, navigation(), element("main", { id: "content", tabindex: -1 }, ...page.sections.map(section))),
);
