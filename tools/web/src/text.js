import { element } from "./dom.js";

export function textCard(block) {
  return element(
    "section", { class: "card wide" },
    block.title ? element("h3", {}, block.title) : "",
    element("pre", { tabindex: 0, "aria-label": block.title || "Text" }, block.text),
  );
}
