// Colours stand in style.css alone, in light and dark; charts ask for them as they are now.
import { button } from "./dom.js";

const probe = document.createElement("span");
probe.hidden = true;

function colour(name) {
  probe.style.color = `var(--${name})`;
  return getComputedStyle(probe).color;
}

/** What a chart draws with. Series differ by dash and symbol too, for those who see fewer colours. */
export function palette() {
  document.body.append(probe);
  const series = [1, 2, 3, 4, 5, 6, 7, 8].map((k) => colour(`series-${k}`));
  return { ink: colour("ink"), soft: colour("soft"), line: colour("line"), paper: colour("card"), raised: colour("raised"), series };
}

export const dashes = ["solid", [7, 4], [2, 3], [10, 3, 2, 3], [4, 2], "solid", [7, 4], [2, 3]];
export const symbols = ["circle", "rect", "triangle", "diamond", "pin", "roundRect", "arrow", "circle"];

const listeners = new Set();
export const onThemeChange = (listener) => listeners.add(listener);
const changed = () => listeners.forEach((listener) => listener());

const dark = matchMedia("(prefers-color-scheme: dark)");
dark.addEventListener("change", changed);

export const isDark = () => (document.documentElement.dataset.theme ?? (dark.matches ? "dark" : "light")) === "dark";

function setTheme(name) {
  if (name) document.documentElement.dataset.theme = name;
  else delete document.documentElement.dataset.theme;
  changed();
}

// On paper everything is light.
let before;
addEventListener("beforeprint", () => {
  before = document.documentElement.dataset.theme;
  setTheme("light");
});
addEventListener("afterprint", () => setTheme(before));

export function themeButton() {
  const word = () => (isDark() ? "Light" : "Dark");
  const made = button(word(), () => {
    setTheme(isDark() ? "light" : "dark");
    made.textContent = word();
  }, { class: "theme", "aria-label": "Light or dark" });
  return made;
}
