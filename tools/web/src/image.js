// A picture of the light: pixels on a canvas, the value and place under the pointer or the cursor keys.
import { rangeOf, shade } from "./colours.js";
import { colourScale } from "./scale.js";
import { element } from "./dom.js";
import { number, withUnit } from "./format.js";

function painted({ width, height, values }, [low, high]) {
  const canvas = element("canvas", { width, height });
  const context = canvas.getContext("2d");
  const pixels = context.createImageData(width, height);
  values.forEach((value, k) => pixels.data.set([...shade((value - low) / (high - low || 1)), 255], 4 * k));
  context.putImageData(pixels, 0, 0);
  return canvas;
}

export function imageCard(image) {
  const range = [0, rangeOf(image.values)[1]];
  const canvas = painted(image, range);
  const readout = element("p", { class: "readout", role: "status" });
  let [column, row] = [image.width >> 1, image.height >> 1];
  const say = () => {
    const [x, y] = [(column + 0.5 - image.width / 2) * image.pitch_mm, (image.height / 2 - row - 0.5) * image.pitch_mm];
    readout.textContent = `${number(x)}, ${number(y)} mm from the middle of the picture: ${withUnit(number(image.values[row * image.width + column]), image.unit)}`;
  };
  const clamp = (value, most) => Math.max(0, Math.min(most - 1, value));
  canvas.addEventListener("pointermove", (event) => {
    const box = canvas.getBoundingClientRect();
    column = clamp(Math.floor(((event.clientX - box.left) / box.width) * image.width), image.width);
    row = clamp(Math.floor(((event.clientY - box.top) / box.height) * image.height), image.height);
    say();
  });
  const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const frame = element("div", {
    class: "picture", tabindex: 0, role: "application", "aria-label": `${image.title}, arrow keys read the values`,
    onkeydown: (event) => {
      const way = ways[event.key];
      if (!way) return;
      event.preventDefault();
      column = clamp(column + way[0], image.width);
      row = clamp(row + way[1], image.height);
      say();
    },
  }, canvas);
  return element(
    "figure", { class: "card" },
    element("figcaption", {}, element("div", {}, element("h3", {}, image.title), element("p", { class: "note" }, image.note))),
    frame,
    element("p", { class: "note" }, `${number(image.width * image.pitch_mm)} by ${number(image.height * image.pitch_mm)} mm`),
    colourScale("irradiance", image.unit, range, (share) => `rgb(${shade(share).join(" ")})`),
    readout,
  );
}
