// What all charts of the page have in common.
import { axisTitle, number } from "./format.js";
import { palette } from "./theme.js";

export const font = 'system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif';

export function base() {
  const colours = palette();
  return {
    animation: false,
    textStyle: { fontFamily: font, color: colours.soft },
    tooltip: {
      backgroundColor: colours.raised, borderColor: colours.line, borderWidth: 1, padding: [8, 10], confine: true,
      textStyle: { color: colours.ink, fontFamily: font, fontSize: 13 }, transitionDuration: 0,
      extraCssText: "box-shadow:0 4px 16px rgb(0 0 0/.18);border-radius:6px",
      axisPointer: { type: "line", animation: false, lineStyle: { color: colours.soft, type: "solid" }, label: { show: false } },
    },
  };
}

export function axis(described, how = {}) {
  const colours = palette();
  return {
    type: "value", name: axisTitle(described), nameLocation: "middle", nameGap: 30, scale: true,
    nameTextStyle: { color: colours.soft, fontSize: 12 },
    axisLine: { show: true, lineStyle: { color: colours.line } },
    axisTick: { show: false },
    axisLabel: { color: colours.soft, fontSize: 11, formatter: number, hideOverlap: true },
    splitLine: { lineStyle: { color: colours.line, opacity: 0.6 } },
    ...how,
  };
}

/** Plain wheel scrolls the page; with Ctrl it zooms. */
export const zoom = (axes) => [
  { type: "inside", ...axes, zoomOnMouseWheel: "ctrl", moveOnMouseMove: true, moveOnMouseWheel: false, filterMode: "none", id: Object.keys(axes)[0] },
];

export const grid = { left: 62, right: 18, top: 14, bottom: 46 };

export const lineStyle = (look) => ({ color: look.colour, width: look.width, type: look.dash });
export const itemStyle = (look, paper) => ({ color: look.open ? paper : look.colour, borderColor: look.colour, borderWidth: look.open ? 1.5 : 0 });
