// The section as a line drawing: SVG, in millimetres.

import { length, roundDown } from "./numbers.js";
import { dot } from "./vectors.js";

const MARGIN = 0.06;
const SHAPE = 0.5; // height over width of the drawing, at least
const TALL = 1.2; // height over width of a section from which it is laid on its side

// Gives the text of an SVG with the cut lines, or dots, and a scale bar; null where nothing is met.
// A tall section is laid on its side.
export function drawSection(places, axes, isLines, ink) {
  let flat = flatten(places, axes.u, axes.v);
  if (!flat.length) return null;
  let [right, down] = axes.words;
  const { width: w, height: h } = spanOf(flat);
  if (h > TALL * w) {
    flat = flatten(places, axes.v, axes.u);
    [right, down] = [down, right];
  }
  const { left, top, width, height } = frameOf(flat);
  const x = (u) => ((u - left) * 1e3).toFixed(2);
  const y = (v) => ((v - top) * 1e3).toFixed(2);
  const marks = [];
  for (let i = 0; i < flat.length; i += isLines ? 4 : 2) {
    const start = `M${x(flat[i])} ${y(flat[i + 1])}`;
    marks.push(isLines ? `${start}L${x(flat[i + 2])} ${y(flat[i + 3])}` : `${start}h0`);
  }
  const [wide, tall] = [width * 1e3, height * 1e3];
  const line = wide / 320;
  const bar = roundDown(width / 3);
  const foot = tall - 12 * line;
  const letters = `font-family="sans-serif" font-size="${12 * line}" fill="${ink}" stroke="none"`;
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${wide}mm" height="${tall}mm"
    viewBox="0 0 ${wide} ${tall}" stroke-linecap="round" fill="none">
    <path d="${marks.join("")}" stroke="#c2410c" stroke-width="${(isLines ? 1.6 : 2.4) * line}"/>
    <path d="M${10 * line} ${foot}h${bar * 1e3}m0 ${-3 * line}v${6 * line}m${-bar * 1e3} 0v${-6 * line}"
      stroke="${ink}" stroke-width="${1.2 * line}"/>
    <text x="${10 * line}" y="${foot - 6 * line}" ${letters}>${length(bar, bar < 1e-3 ? 2 : 0)}</text>
    <text x="${wide - 8 * line}" y="${foot}" text-anchor="end" ${letters}>→ ${right}  ↓ ${down}</text>
  </svg>`;
}

// Right and down in the drawing, two numbers a place [m].
function flatten(places, u, v) {
  const flat = new Float64Array((places.length / 3) * 2);
  for (let i = 0; i < flat.length / 2; i++) {
    const place = places.subarray(3 * i, 3 * i + 3);
    flat[2 * i] = dot(place, u);
    flat[2 * i + 1] = dot(place, v);
  }
  return flat;
}

function spanOf(flat) {
  let [left, top, right, bottom] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i < flat.length; i += 2) {
    left = Math.min(left, flat[i]);
    right = Math.max(right, flat[i]);
    top = Math.min(top, flat[i + 1]);
    bottom = Math.max(bottom, flat[i + 1]);
  }
  return { left, top, width: right - left, height: bottom - top };
}

// The sheet around it, with room for the scale bar.
function frameOf(flat) {
  const { left, top, width, height } = spanOf(flat);
  const wide = Math.max(width, height / 1.2, 1e-3) * (1 + 2 * MARGIN);
  const foot = 0.13 * wide;
  const tall = Math.max(height + MARGIN * wide + foot, SHAPE * wide);
  return {
    left: left - (wide - width) / 2,
    top: top - (tall - foot - height) / 2,
    width: wide,
    height: tall,
  };
}
