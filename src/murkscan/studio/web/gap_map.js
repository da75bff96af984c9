// The map of gaps: covered, missing, nothing known, a cell a pixel.

import { make } from "./dom.js";

const NOTHING = 255;

export function gapMap() {
  const canvas = make("canvas", { className: "gaps" });
  const said = make("figcaption", {});
  const element = make("figure", { className: "tile" }, said, make("div", { className: "held" }, canvas));
  let asked = 0;  // a map that is still read when another is asked for is not drawn
  clear();

  function clear() {
    asked += 1;
    canvas.width = canvas.height = 0;
    said.textContent = "Gaps: the map comes with the first metres.";
  }

  async function show(address, about) {
    const mine = ++asked;
    const image = new Image();
    image.src = address;
    await image.decode();
    if (mine !== asked) return;
    const [width, height] = [image.naturalWidth, image.naturalHeight];
    Object.assign(canvas, { width, height });
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    const picture = context.getImageData(0, 0, width, height);
    const style = getComputedStyle(document.documentElement);
    const [good, bad] = ["--good", "--bad"].map((name) => rgb(style.getPropertyValue(name)));
    const counts = new Map();
    for (let i = 0; i < picture.data.length; i += 4) {
      const value = picture.data[i];
      const colour = value === NOTHING ? [0, 0, 0, 0] : value === 0 ? [...good, 255] : [...bad, 255];
      if (value !== NOTHING && value !== 0) counts.set(value, (counts.get(value) ?? 0) + 1);
      picture.data.set(colour, i);
    }
    context.putImageData(picture, 0, 0);
    said.textContent = wordsOf(about, counts);
  }
  return { element, show, clear };
}

function wordsOf(about, counts) {
  const most = [...counts].sort((a, b) => b[1] - a[1])[0];
  const share = about?.share ?? null;
  const cell = about ? ` in cells of ${(1e3 * about.cell_m).toFixed(0)} mm` : "";
  const cause = most && about ? `; most of the rest: ${about.causes[most[0] - 1]?.replaceAll("_", " ")}` : "";
  return share === null ? `Gaps${cell}` : `${(100 * share).toFixed(0)} % covered${cell}${cause}`;
}

function rgb(text) {
  const hex = text.trim().slice(1);
  return [0, 2, 4].map((k) => parseInt(hex.slice(k, k + 2), 16));
}
