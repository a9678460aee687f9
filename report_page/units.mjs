// Numbers for people.

const prefixes = ["p", "n", "µ", "m", "", "k", "M", "G", "T"], none = 4;
const takesPrefix = new Set(["Pa", "N", "J", "W", "s", "m"]);

/// Prefix and factor that leave 1 to 1000 of the number before the unit; what is next to nothing keeps the unit.
export function scaleFor(largest, unit) {
  const first = unit.split("/")[0];
  if (!takesPrefix.has(first) || (first === "m" && unit !== "m") || !(Math.abs(largest) >= 1e-13) || !isFinite(largest))
    return {factor: 1, unit};
  const most = first === "s" ? none : unit === "m" ? none + 1 : prefixes.length - 1;
  const p = Math.min(most, Math.max(0, none + Math.floor(Math.log10(Math.abs(largest)) / 3 + 1e-9)));
  return {factor: 10 ** (3 * (none - p)), unit: prefixes[p] + unit};
}

/// At most so many digits, no zeros behind the point, powers of ten where they are shorter.
export function digits(value, count = 4) {
  if (!isFinite(value)) return "–";
  if (value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e6)) {
    const [mantissa, power] = value.toExponential(count - 1).split("e");
    return `${+mantissa}e${+power}`;
  }
  return String(+value.toPrecision(count)).replace("-", "−");
}

/// Limits of so many equal parts of a range, rounded by less than a thirtieth of a part.
export function limits(low, high, parts) {
  const step = (high - low) / parts, largest = Math.max(Math.abs(low), Math.abs(high));
  const decimals = Math.max(0, Math.ceil(Math.log10(16 / step)));
  return Array.from({length: parts + 1}, (_, k) => low + k * step).map((value) => {
    if (largest >= 1e6 || decimals > 6) return digits(Math.abs(value) < 1e-9 * largest ? 0 : value);
    const text = value.toFixed(decimals);
    return (+text === 0 ? text.replace("-", "") : text).replace("-", "−");
  });
}

export function pretty(unit) {
  return unit.replace("^2", "²").replace("^3", "³");
}

export function measure(value, unit, count = 4) {
  const {factor, unit: shown} = scaleFor(value, unit);
  return digits(value * factor, count) + (shown ? " " + pretty(shown) : "");
}

/// von_mises -> von Mises; names of arrays in words.
export function words(name) {
  return name === "von_mises" ? "von Mises stress" : name.replaceAll("_", " ");
}
