// Which scan, as what, in which colours.

import { choice, make } from "./dom.js";
import { wordFor } from "./words.js";

export function showTool(app) {
  const scans = choice("Scan", app.models.map((model) => [model.number, model.name]),
    (number) => app.update({ scan: Number(number) }));
  scans.element.classList.add("stacked");
  const kinds = choice("Show as", [["surface", "Surface"], ["points", "Points"]],
    (kind) => app.update({ kind }));
  const colours = make("select", {
    "aria-label": "Colour by", onchange: () => app.update({ layer: colours.value }),
  });
  const ends = [0, 1].map((end) => make("input", {
    type: "number", step: "any", "aria-label": end ? "Colours up to" : "Colours from",
    onchange: () => {
      const range = [...app.range];
      range[end] = ends[end].valueAsNumber;
      if (range[0] < range[1]) app.update({ ranges: { ...app.state.ranges, [app.layer.name]: range } });
      else app.sync();
    },
  }));
  const whole = make("button", {
    type: "button", textContent: "Reset", title: "The colours' first range",
    onclick: () => app.update({ ranges: { ...app.state.ranges, [app.layer.name]: null } }),
  });
  const range = make("div", { className: "row" }, ends[0], "to", ends[1], whole);
  const note = make("p", { className: "note" });
  const parts = [note, kinds.element, make("label", {}, "Colour by ", colours), range];
  if (app.models.length > 1) {
    parts.unshift(scans.element, make("p", { className: "note" },
      `${app.content.relation} Key B changes from one to the other.`.trim()));
  }

  function sync() {
    const { model, layer } = app;
    scans.show(model.number);
    kinds.show(app.state.kind);
    kinds.element.hidden = model.faces.length === 0;
    note.textContent = model.note;
    note.hidden = !model.note;
    const names = ["plain", ...model.layers.map(({ name }) => name)];
    colours.replaceChildren(...names.map((name) => {
      const unit = model.layers.find((one) => one.name === name)?.unit;
      const text = wordFor(name);
      return make("option", { value: name, textContent: unit ? `${text} [${unit}]` : text });
    }));
    colours.value = layer?.name ?? "plain";
    range.hidden = !layer;
    if (layer) ends.forEach((input, end) => { input.value = Number(app.range[end].toPrecision(3)); });
  }
  return { name: "show", title: "Show", element: make("div", {}, ...parts), sync };
}
