// Lines over a distance, drawn as SVG in the page's own colours.

import { draw, make } from "./dom.js";

const WIDTH = 520, HEIGHT = 270, LEFT = 52, RIGHT = 14, TOP = 12, BOTTOM = 40;

// lines: { values, name, colour, dash }; bands: [from, to] shaded along x
export function chart({ x, lines, xLabel, yLabel, isLog = false, band = null, xMost = null, yRange = null }) {
  const most = xMost ?? Math.max(...x);
  const [low, high] = yRange ?? rangeOf(lines, x, most, isLog);
  const place = (value) => (isLog ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));
  const toX = (value) => LEFT + (value / most) * (WIDTH - LEFT - RIGHT);
  const toY = (value) => HEIGHT - BOTTOM - place(value) * (HEIGHT - TOP - BOTTOM);
  const svg = draw("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": `${yLabel} over ${xLabel}` });
  if (band) {
    const [from, to] = band.map((value) => toX(Math.min(value, most)));
    svg.append(draw("rect", { class: "band", x: from, y: TOP, width: Math.max(to - from, 0), height: HEIGHT - TOP - BOTTOM }));
  }
  for (const value of ticks(0, most)) svg.append(grid(toX(value), TOP, toX(value), HEIGHT - BOTTOM), text(toX(value), HEIGHT - BOTTOM + 17, trim(value), "middle"));
  for (const value of isLog ? decades(low, high) : ticks(low, high)) svg.append(grid(LEFT, toY(value), WIDTH - RIGHT, toY(value)), text(LEFT - 7, toY(value) + 4, trim(value), "end"));
  svg.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 5, xLabel, "middle"));
  for (const { values, colour, dash } of lines) {
    const path = pathOf(x, values, { toX, toY, most, low, high });
    if (path) svg.append(draw("path", { d: path, class: "curve", style: `stroke: var(--${colour})`, ...(dash ? { "stroke-dasharray": dash } : {}) }));
  }
  return make("figure", { className: "chart" }, make("figcaption", { textContent: yLabel }), svg, legend(lines));
}

function legend(lines) {
  return make("div", { className: "legend" }, lines.map(({ name, colour, dash }) => make("span", {},
    draw("svg", { viewBox: "0 0 24 8", width: 24, height: 8 }, draw("path", {
      d: "M0 4H24", class: "curve", style: `stroke: var(--${colour})`, ...(dash ? { "stroke-dasharray": dash } : {}),
    })), name)));
}

function pathOf(x, values, { toX, toY, most, low, high }) {
  let path = "", isOn = false;
  x.forEach((at, k) => {
    const value = values[k];
    const isShown = value !== null && Number.isFinite(value) && at <= most * 1.0001;
    if (isShown) path += `${isOn ? "L" : "M"}${toX(at).toFixed(1)} ${toY(Math.min(Math.max(value, low), high)).toFixed(1)}`;
    isOn = isShown;
  });
  return path;
}

function rangeOf(lines, x, most, isLog) {
  const all = lines.flatMap(({ values }) => values.filter((v, k) => v !== null && v > 0 && x[k] <= most));
  if (!all.length) return isLog ? [0.1, 10] : [0, 1];
  const [low, high] = [Math.min(...all), Math.max(...all)];
  return isLog ? [10 ** Math.floor(Math.log10(low)), 10 ** Math.ceil(Math.log10(high * 1.0001))] : [0, high * 1.05];
}

function ticks(low, high) {
  const raw = (high - low) / 5, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((k) => k * power).find((one) => one >= raw);
  const found = [];
  for (let value = Math.ceil(low / step) * step; value <= high * 1.0001; value += step) found.push(value);
  return found;
}

function decades(low, high) {
  const found = [];
  for (let value = low; value <= high * 1.0001; value *= 10) found.push(value);
  return found;
}

const trim = (value) => String(Number(value.toPrecision(3)));
const grid = (x1, y1, x2, y2) => draw("line", { class: "gridline", x1, y1, x2, y2 });
const text = (x, y, words, anchor) => draw("text", { x, y, "text-anchor": anchor }, words);
