// What stands still on the picture: scale bar, axes, colour bar.

import { grouped, length, roundDown, ticks } from "./numbers.js";
import { wordFor } from "./words.js";

const AXES = { x: [0, "var(--x)"], y: [1, "var(--y)"], z: [2, "var(--z)"] };
const LONGEST = 0.25; // of the picture's width

export function showScale(stage) {
  const element = document.getElementById("scale");
  const metres = roundDown((LONGEST * stage.width) / stage.scale);
  element.lastElementChild.style.width = `${metres * stage.scale}px`;
  const digits = metres >= 1e-3 ? 0 : Math.ceil(-Math.log10(metres)) - 3;
  element.firstElementChild.textContent = metres >= 1 ? `${grouped(metres)} m` : length(metres, digits);
}

// The world's axes as the view shows them; one that points at the viewer is a dot.
export function showAxes(stage) {
  const view = stage.camera.matrixWorldInverse.elements;
  const parts = Object.entries(AXES).map(([name, [column, colour]]) => {
    const [right, up, near] = view.slice(4 * column, 4 * column + 3);
    return { name, colour, x: 34 * right, y: -34 * up, near };
  });
  parts.sort((a, b) => a.near - b.near);
  document.getElementById("axes").innerHTML = parts.map(({ name, colour, x, y }) => {
    const isDot = Math.hypot(x, y) < 4;
    const letter = isDot ? [8, -8] : [1.3 * x, 1.3 * y];
    return `<g style="color:${colour}"><path d="M0 0L${x.toFixed(1)} ${y.toFixed(1)}"/>
      <circle r="3" cx="${x.toFixed(1)}" cy="${y.toFixed(1)}"/>
      <text x="${letter[0].toFixed(1)}" y="${letter[1].toFixed(1)}">${name}</text></g>`;
  }).join("");
}

// A bar with round numbers; null hides it.
export function showLegend(layer, range, colours) {
  const element = document.getElementById("legend");
  element.hidden = !layer;
  if (!layer) return;
  const [low, high] = range;
  const stops = Array.from({ length: 17 }, (_, k) => {
    const at = 4 * Math.round((255 * k) / 16);
    return `rgb(${colours[at]},${colours[at + 1]},${colours[at + 2]})`;
  });
  const marks = ticks(low, high, 7).map(({ value, text }) => {
    const share = (100 * (value - low)) / (high - low);
    return `<li style="--at:${share.toFixed(2)}%">${text}</li>`;
  });
  // Depth grows away from the viewer: near is on top, as on the pictures.
  element.classList.toggle("turned", layer.name === "depth");
  element.innerHTML = "<figcaption></figcaption><div class='bar'></div><ol></ol>";
  element.querySelector("figcaption").textContent = wordFor(layer.name) + (layer.unit ? ` [${layer.unit}]` : "");
  element.querySelector(".bar").style.setProperty("--stops", stops.join(","));
  element.querySelector("ol").innerHTML = marks.join("");
}
