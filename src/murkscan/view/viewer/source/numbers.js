// How numbers are written.

const THIN = "\u202f";

export function grouped(number, digits = 0) {
  const [whole, part] = Math.abs(number).toFixed(digits).split(".");
  const sign = number < 0 && Number(number.toFixed(digits)) !== 0 ? "−" : "";
  const text = whole.replace(/\B(?=(\d{3})+$)/g, THIN);
  return sign + text + (part ? `.${part}` : "");
}

// Metres as millimetres; as metres from ten of them on.
export function length(metres, digits = 2) {
  return Math.abs(metres) < 10 ? `${grouped(metres * 1e3, digits)} mm` : `${grouped(metres, 4)} m`;
}

// A place in the world: metres, as commands take it.
export const place = (metres) => `${grouped(metres, 5)} m`;

export function valueText(value, unit) {
  const size = Math.abs(value);
  const digits = size >= 1000 ? 1 : size >= 1 ? 2 : 3;
  return `${grouped(value, digits)}${unit ? ` ${unit}` : ""}`;
}

// The largest of 1, 2 and 5 times a power of ten that is not above a value.
export function roundDown(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].map((step) => step * power).find((step) => step <= value * (1 + 1e-9));
}

// About so many round numbers from low to high.
export function ticks(low, high, count) {
  const least = (high - low) / count;
  const step = [1, 2, 5, 10].map((s) => s * 10 ** Math.floor(Math.log10(least)))
    .find((s) => s >= least * (1 - 1e-9));
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) {
    found.push({ value: k * step, text: grouped(k * step, digits) });
  }
  return found;
}
