// Numbers as a person reads them.

const minus = (text) => text.replace("-", "\u2212");

/** Six digits; very large and very small ones as powers of ten. */
export function number(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "\u2013";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return minus(value.toExponential(3));
  return minus(String(Number(value.toPrecision(6))));
}

/** A value with its expanded uncertainty, both to two digits of it. */
export function measured(value, u, k) {
  if (!Number.isFinite(u) || u === null || u <= 0 || !Number.isFinite(value)) return number(value);
  const U = k * u;
  const digits = Math.min(12, Math.max(0, 1 - Math.floor(Math.log10(U))));
  return `${minus(value.toFixed(digits))} \u00b1 ${U.toFixed(digits)}`;
}

export function withUnit(text, unit) {
  return unit ? `${text}${unit === "\u00b0" ? "" : " "}${unit}` : text;
}

export function axisTitle(axis) {
  return axis.unit ? `${axis.name} [${axis.unit}]` : axis.name;
}
