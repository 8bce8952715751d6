// A scale of colours for values: cividis, which reads the same with fewer colours and grows steadily lighter.
import { isDark } from "./theme.js";

const stops = [[0, 34, 78], [18, 53, 112], [59, 73, 108], [87, 93, 109], [112, 113, 115], [138, 134, 120], [165, 156, 116], [195, 179, 105], [225, 204, 85], [254, 232, 56]];

/** @param share  0 to 1.  @return [r, g, b] */
export function shade(share) {
  const at = Math.max(0, Math.min(1, share)) * (stops.length - 1);
  const k = Math.min(stops.length - 2, Math.floor(at));
  return stops[k].map((c, i) => Math.round(c + (at - k) * (stops[k + 1][i] - c)));
}

/** Of points, which stand on the card: the darkest colours would be lost on a dark one. */
export const shadeCss = (share) => `rgb(${shade(isDark() ? 0.3 + 0.7 * share : 0.9 * share).join(" ")})`;

export function rangeOf(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) if (value !== null) (low = Math.min(low, value)), (high = Math.max(high, value));
  return low <= high ? [low, high] : [0, 1];
}
