// A rectangle to zoom into: drawn by the pointer (button, or Shift held), or moved and sized by keys.
import { element } from "./dom.js";
import { axisTitle, number } from "./format.js";

const kStep = 0.05; // of the plot, by one key
const kSmallest = 0.02; // of the plot: less is a click

const clamp = (value, low, high) => Math.max(low, Math.min(high, value));

/** Of the plot's own rectangle, between 0 and 1 from its upper left corner. */
class Rectangle {
  constructor(plot, frame) {
    this.plot = plot;
    this.frame = frame;
    this.set(0.25, 0.25, 0.75, 0.75);
  }
  set(left, top, right, bottom) {
    [this.left, this.right] = [clamp(Math.min(left, right), 0, 1), clamp(Math.max(left, right), 0, 1)];
    [this.top, this.bottom] = [clamp(Math.min(top, bottom), 0, 1), clamp(Math.max(top, bottom), 0, 1)];
  }
  move(x, y) {
    const [dx, dy] = [clamp(x, -this.left, 1 - this.right), clamp(y, -this.top, 1 - this.bottom)];
    this.set(this.left + dx, this.top + dy, this.right + dx, this.bottom + dy);
  }
  grow(x, y) {
    this.set(this.left, this.top, Math.max(this.left + kStep, this.right + x), Math.max(this.top + kStep, this.bottom + y));
  }
  get isSmall() {
    return this.right - this.left < kSmallest || this.bottom - this.top < kSmallest;
  }
  pixels() {
    const { x, y, width, height } = this.frame();
    return { left: x + this.left * width, top: y + this.top * height, right: x + this.right * width, bottom: y + this.bottom * height };
  }
  shareAt(event) {
    const { x, y, width, height } = this.frame();
    const at = this.plot.getBoundingClientRect();
    return [(event.clientX - at.left - x) / width, (event.clientY - at.top - y) / height];
  }
}

/**
 * @param card  Says what the rectangle holds, and zooms: `takesRectangle()`, `frame()`: where the axes are drawn in the plot [px], `rangeOf(pixels)`, `zoomInto(pixels)`, `say(text)`, `onRectangle(is)`.
 * @return begin(): the rectangle, or off with it if it is there; end().
 */
export function addRectangle(plot, figure, card) {
  let sheet;
  let drawn;
  let from;
  const rectangle = new Rectangle(plot, () => card.frame());

  const show = () => {
    const { left, top, right, bottom } = rectangle.pixels();
    Object.assign(drawn.style, { left: `${left}px`, top: `${top}px`, width: `${right - left}px`, height: `${bottom - top}px` });
    const range = card.rangeOf(rectangle.pixels());
    const words = (axis, [low, high]) => `${axisTitle(axis) || "places"} ${number(low)} to ${number(high)}`;
    card.say(`${words(figure.x, range.x)}${range.y ? `, ${words(figure.y, range.y)}` : ""}. Arrows move, Shift and arrows size, Enter zooms, Escape leaves.`);
  };
  const end = () => {
    sheet?.remove();
    sheet = from = undefined;
    card.onRectangle(false);
  };
  const zoom = () => {
    const pixels = rectangle.pixels();
    const is = !rectangle.isSmall;
    end();
    if (is) card.zoomInto(pixels);
    card.say(is ? "Zoomed into the rectangle; 0 shows all." : "");
  };
  const press = (event) => {
    from = rectangle.shareAt(event);
    sheet.setPointerCapture(event.pointerId);
    event.preventDefault();
    plot.focus();
  };
  const drag = (event) => {
    if (!from) return;
    rectangle.set(...from, ...rectangle.shareAt(event));
    show();
  };
  const begin = () => {
    if (sheet) return end();
    drawn = element("div", { class: "rectangle" });
    sheet = element("div", { class: "sheet", onpointerdown: press, onpointermove: drag, onpointerup: () => from && zoom(), onpointercancel: end }, drawn);
    plot.append(sheet);
    rectangle.set(0.25, 0.25, 0.75, 0.75);
    card.onRectangle(true);
    show();
  };

  // With Shift the first press draws already. It is taken before the chart sees it, which would move the plot.
  plot.addEventListener("pointerdown", (event) => {
    if (sheet || !event.shiftKey || event.button !== 0 || !card.takesRectangle()) return;
    event.stopPropagation();
    begin();
    press(event);
  }, { capture: true });

  const arrows = { ArrowLeft: [-kStep, 0], ArrowRight: [kStep, 0], ArrowUp: [0, -kStep], ArrowDown: [0, kStep] };
  plot.addEventListener("keydown", (event) => {
    if (!sheet || event.ctrlKey || event.altKey || event.metaKey) return;
    const way = arrows[event.key];
    if (way) event.shiftKey ? rectangle.grow(...way) : rectangle.move(...way), show();
    else if (event.key === "Enter") zoom();
    else if (event.key === "Escape") end(), card.say("");
    else return;
    event.preventDefault();
    event.stopImmediatePropagation(); // the cursor has the same keys
  }, { capture: true });
  return { begin, end };
}
