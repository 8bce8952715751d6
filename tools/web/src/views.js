// The ways in which each form of figure can be looked at; the first is how it opens.
import { barsOption } from "./bars.js";
import { planeOption } from "./plane.js";
import { magnification, polarOption, polarPlace } from "./polar.js";
import { sharesHeight, sharesOption } from "./shares.js";

const plane = { name: "Linear", option: planeOption, zooms: true };
const polar = { name: "Polar", option: polarOption, note: magnification, place: polarPlace, square: true };
const bars = { name: "Linear", option: (figure, shown, looks) => barsOption(figure, shown, looks, false), zooms: true };
const logarithmic = { name: "Logarithmic", option: (figure, shown, looks) => barsOption(figure, shown, looks, true), zooms: true };
const shares = { name: "Shares", option: sharesOption, height: sharesHeight, wide: true };

const ranks = { ...shares, name: "Ranks" };

const views = {
  angle: [polar, plane],
  line: [plane],
  points: [plane],
  track: [plane],
  bars: [bars, logarithmic],
  histogram: [bars],
  shares: [shares],
  ranks: [ranks],
};

/** A spectrum is about what is beyond noise, and noise is small. */
const isSpectrum = (figure) => figure.form === "bars" && figure.series.some(({ role }) => role === "expected");

export const viewsOf = (figure) => (isSpectrum(figure) ? [logarithmic, bars] : views[figure.form] ?? [plane]);
