// Distances between two points, drawn on the picture and listed.

import { copyButton, folderOf, numbersOf } from "./command.js";
import { make, setPressed } from "./dom.js";
import { pointOf, worldPlace } from "./model.js";
import { length } from "./numbers.js";

export function measureTool(app) {
  const toggle = make("button", {
    type: "button", textContent: "Measure", title: "Key M",
    onclick: () => app.update({ measuring: !app.state.measuring, picking: false, first: null }),
  });
  const clear = make("button", {
    type: "button", textContent: "Clear", onclick: () => app.update({ measures: [], first: null }),
  });
  const hint = make("p", { className: "note" });
  const list = make("ol", { className: "measures" });
  const element = make("div", {}, make("div", { className: "row" }, toggle, clear), hint, list);

  function sync() {
    const { measuring, first } = app.state;
    const mine = app.measures;
    setPressed(toggle, measuring);
    clear.hidden = mine.length === 0;
    hint.textContent = !measuring ? ""
      : first === null ? "Point at the first place: it snaps to the nearest measured point."
        : "Now the second place.";
    hint.hidden = !measuring;
    list.replaceChildren(...mine.map(describe));
  }

  function describe({ first, second, length: metres, step, off, shared }) {
    const parts = ["x", "y", "z"].map((name, k) => `Δ${name}\u00a0${length(step[k])}`).join("  ");
    const item = make("li", {}, make("b", { textContent: length(metres) }), ` ${doubt(off)}`,
      make("small", { textContent: parts }), make("small", {
        textContent: `Of these two points; neighbours lie about ${length(app.model.spacing, 1)} apart.`,
      }));
    if (off !== null) {
      item.append(make("small", {
        textContent: shared === null ? "What points share, by calibration, motion and alignment, is not in it: murkscan measure distance tells."
          : `${app.model.sharing}: ± ${length(shared)}.`,
      }));
    }
    item.append(copyButton(commandOf(first, second)));
    return item;
  }

  function commandOf(first, second) {
    const [from, to] = [first, second].map((i) => numbersOf(worldPlace(app.model, pointOf(app.model, i))));
    return `murkscan measure ${folderOf(app)} distance --from-m ${from} --to-m ${to}`;
  }
  return { name: "measure", title: "Measure", element, sync };
}

const doubt = (off) => (off === null ? "(uncertainty not known)" : `± ${length(off)} (95 %)`);

// Lines and labels over the picture.
export function drawMeasures(app) {
  const marks = document.getElementById("marks");
  const labels = document.getElementById("labels");
  const ends = app.measures.map(({ first, second }) => [first, second]
    .map((i) => app.stage.project(pointOf(app.model, i))));
  marks.innerHTML = [
    ...ends.map(([a, b]) => `<path d="M${a[0]} ${a[1]}L${b[0]} ${b[1]}"/>${[a, b].map(ring).join("")}`),
    ...app.picks.map(({ point }) => ring(app.stage.project(pointOf(app.model, point)))),
    ...[app.state.first, app.state.snapped].filter((i) => i !== null)
      .map((i) => ring(app.stage.project(pointOf(app.model, i)))),
  ].join("");
  const names = app.picks.map(({ point, cells }, k) => {
    const [x, y] = app.stage.project(pointOf(app.model, point));
    const label = make("span", { textContent: cells.name || `P${k + 1}` });
    label.style.translate = `calc(${x}px - 50%) calc(${y}px - 140%)`;
    return label;
  });
  labels.replaceChildren(...names, ...app.measures.map(({ length: metres, off }, k) => {
    const [a, b] = ends[k];
    const label = make("span", { textContent: length(metres) + (off === null ? "" : ` ± ${length(off)}`) });
    label.style.translate = `calc(${(a[0] + b[0]) / 2}px - 50%) calc(${(a[1] + b[1]) / 2}px - 140%)`;
    return label;
  }));
}

const ring = ([x, y]) => `<circle cx="${x}" cy="${y}" r="5"/>`;
