// The strip that says which colour is which value.
import { shadeCss } from "./colours.js";
import { element } from "./dom.js";
import { number, withUnit } from "./format.js";

export function colourScale(name, unit, [low, high], colour = shadeCss) {
  const strip = element("span", { class: "strip", "aria-hidden": "true" });
  strip.style.background = `linear-gradient(to right, ${[0, 0.25, 0.5, 0.75, 1].map((share) => colour(share)).join(",")})`;
  return element("p", { class: "scale" }, `${name}: ${number(low)} `, strip, ` ${withUnit(number(high), unit)}`);
}
