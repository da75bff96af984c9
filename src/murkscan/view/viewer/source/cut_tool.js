// A plane that takes a part away, and the line that it draws on the rest.

import { copyButton, folderOf, numbersOf } from "./command.js";
import { make, setPressed } from "./dom.js";
import { place } from "./numbers.js";
import { extentAlong, meetPoints, meetTriangles, planeAxes } from "./section.js";
import { drawSection } from "./section_drawing.js";

const MIDDLE = 0.5;

export function cutTool(app) {
  const toggle = make("button", {
    type: "button", textContent: "Cut", title: "Key C", onclick: () => app.toggleCut(),
  });
  const flip = make("button", {
    type: "button", textContent: "Other side", onclick: () => app.cutWith({ flip: !app.state.cut.flip }),
  });
  const axis = make("select", { "aria-label": "Cut from", onchange: () => app.cutWith({ axis: axis.value }) });
  const slider = make("input", {
    type: "range", min: 0, max: 1000, "aria-label": "Place of the cut",
    oninput: () => app.cutWith({ share: slider.value / 1000 }),
  });
  const where = make("output");
  const drawing = make("figure", { className: "section", "aria-label": "Section" });
  const save = make("button", { type: "button", textContent: "Save section as SVG", onclick: saveSection });
  const copying = make("div", {});
  const more = make("div", {}, make("label", {}, "From ", axis), slider, where, drawing, save, copying);
  const element = make("div", {}, make("div", { className: "row" }, toggle, flip), more);

  function saveSection() {
    const text = drawSection(app.section.places, app.section.axes, app.section.isLines, "#14242b");
    const address = URL.createObjectURL(new Blob([text], { type: "image/svg+xml" }));
    make("a", { href: address, download: "section.svg" }).click();
    setTimeout(() => URL.revokeObjectURL(address), 1000);
  }

  // The plane lies `at` its normal from the world's origin.
  function command() {
    const { normal } = app.section.axes;
    const point = numbersOf(normal.map((x) => x * app.section.at));
    return `murkscan measure ${folderOf(app)} section --point-m ${point} --normal ${numbersOf(normal)}`;
  }

  let drawn = null; // redrawn only when the plane has moved
  function sync() {
    const { cut } = app.state;
    setPressed(toggle, cut);
    flip.hidden = more.hidden = !cut;
    if (!cut) return;
    const planes = planeAxes(app.model.views, app.state.along);
    axis.replaceChildren(...Object.entries(planes).map(([value, { label }]) =>
      make("option", { value, textContent: label })));
    axis.value = cut.axis;
    slider.value = cut.share * 1000;
    where.textContent = place(app.section.at);
    if (app.section === drawn) return;
    drawn = app.section;
    const svg = drawSection(app.section.places, app.section.axes, app.section.isLines, "currentColor");
    drawing.innerHTML = svg ?? "<p class='note'>The plane meets nothing here.</p>";
    save.hidden = copying.hidden = !svg;
    copying.replaceChildren(copyButton(command()));
  }
  return { name: "cut", title: "Cut", element, sync };
}

export const firstCut = () => ({ axis: "across", share: MIDDLE, flip: false });

// Where the plane through a distance lies between the ends of the model.
export function shareThrough(model, { normal, at }) {
  const [low, high] = extentAlong(model, normal);
  return (at - low) / (high - low || 1);
}

// What the chosen cut takes away and what it meets.
export function cutModel(model, cut, along) {
  const axes = planeAxes(model.views, along)[cut.axis] ?? planeAxes(model.views).across;
  const [low, high] = extentAlong(model, axes.normal);
  const at = low + cut.share * (high - low);
  const isLines = model.faces.length > 0;
  const places = (isLines ? meetTriangles : meetPoints)(model, axes.normal, at);
  const sign = cut.flip ? -1 : 1;
  const origin = axes.normal.reduce((sum, x, k) => sum + x * model.centre[k], 0);
  return {
    axes, places, isLines, at: at + origin,
    plane: { normal: axes.normal.map((x) => sign * x), offset: sign * at },
  };
}
