// Parts of a whole for each category, as lying bars.
import { axis, base } from "./common.js";
import { number, withUnit } from "./format.js";
import { tipElement } from "./tip.js";
import { palette } from "./theme.js";

const kLetter = 6, kLine = 12; // px of a label
const labelWidth = (width) => Math.min(260, 0.46 * width);

/** Each bar as high as the longest label that is broken to the width. */
export function sharesHeight(figure, width) {
  const lines = Math.ceil((1.2 * kLetter * Math.max(...figure.categories.map((name) => name.length))) / labelWidth(width));
  return 76 + Math.max(26, kLine * lines + 2) * figure.categories.length;
}

const percent = (share) => `${(100 * share).toPrecision(3)} %`;
const isShare = (figure) => figure.form === "shares";
const valueText = (figure, value) => (isShare(figure) ? percent(value) : withUnit(number(value), figure.y.unit));

/** Stripes beside colours, for those who see fewer of them. */
const stripes = [null, { rotation: 0.6, dashArrayX: [1, 0], dashArrayY: [3, 4] }, { rotation: -0.6, dashArrayX: [1, 0], dashArrayY: [2, 6] }, { dashArrayX: [2, 3], dashArrayY: [2, 3] }];

export function sharesOption(figure, shown, looks, box) {
  const colours = palette();
  return {
    ...base(),
    grid: { left: 12, right: 24, top: 8, bottom: 44, containLabel: true },
    xAxis: axis(figure.y, { scale: false, ...(isShare(figure) ? { max: 1, axisLabel: { color: colours.soft, hideOverlap: true, formatter: (x) => `${Math.round(100 * x)} %` } } : {}) }),
    yAxis: axis({ name: "", unit: "" }, {
      type: "category", data: figure.categories, inverse: true, splitLine: { show: false },
      axisLabel: { color: colours.ink, fontSize: 11, lineHeight: kLine, width: labelWidth(box.width), overflow: "break", interval: 0 },
    }),
    tooltip: {
      ...base().tooltip, trigger: "axis", axisPointer: { type: "shadow" },
      formatter: (points) =>
        tipElement(
          figure.categories[points[0].dataIndex],
          points.filter((p) => p.value > 0).sort((a, b) => b.value - a.value).map((p) => [p.seriesName, valueText(figure, p.value)]),
        ),
    },
    series: figure.series
      .map((s, k) => ({
        type: "bar", stack: "all", name: s.name, data: s.y, barMaxWidth: 14, barMinHeight: 2,
        itemStyle: {
          color: looks[k].colour, borderColor: colours.paper, borderWidth: 1,
          decal: stripes[k % stripes.length] ? { color: "rgba(255,255,255,.35)", symbol: "rect", ...stripes[k % stripes.length] } : undefined,
        },
      }))
      .filter((_, k) => shown[k]),
  };
}
