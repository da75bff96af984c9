// Measures that are typed rather than picked on the model.

import { studio } from "./ask.js";
import { make } from "./dom.js";
import { commandForm } from "./form.js";

const PART = [
  { key: "near-m", pick: true, label: "Around X,Y,Z", unit: "m", placeholder: "all of it" },
  { key: "within-mm", label: "as far as", unit: "mm", kind: "number" },
];
const DRAWING = [
  { key: "reference", label: "Drawing’s mesh in the folder", placeholder: "hull.stl", list: [] },
  { key: "unit", label: "Its unit", kind: "select", options: ["m", "cm", "mm", "in"] },
];
const KINDS = {
  sphere: ["Sphere", PART],
  cylinder: ["Pipe", PART],
  plane: ["Plane", PART],
  step: ["Step", [
    { key: "first-m", pick: true, label: "Middle of the first plane, X,Y,Z", unit: "m" },
    { key: "second-m", pick: true, label: "of the second", unit: "m" },
    { key: "within-mm", label: "as far as", unit: "mm", kind: "number", value: 20 }]],
  area: ["Area", PART],
  volume: ["Volume", [...PART,
    { key: "point-m", pick: true, label: "Above the plane through X,Y,Z", unit: "m" },
    { key: "normal", label: "with the normal", placeholder: "0,0,-1" }]],
  distance: ["Distance", [
    { key: "from-m", pick: true, label: "From X,Y,Z", unit: "m" },
    { key: "to-m", pick: true, label: "to X,Y,Z", unit: "m" }]],
  section: ["Section", [
    { key: "point-m", pick: true, label: "Through X,Y,Z", unit: "m" },
    { key: "normal", label: "across the direction", value: "0,1,0" }]],
  dents: ["Dents", [...DRAWING.map((field) => ({ ...field, more: true })),
    { key: "smallest-mm", label: "Smallest", unit: "mm", kind: "number", value: 20 },
    { key: "largest-mm", label: "Largest", unit: "mm", kind: "number", value: 150 }]],
  deviation: ["Deviation from a drawing", [...DRAWING,
    { key: "reach-mm", label: "Farthest that counts", unit: "mm", kind: "number", value: 50 }]],
};

export function measureForms(scan) {
  const place = make("div", {});
  const tabs = Object.entries(KINDS).map(([kind, [title]]) => make("button", {
    type: "button", textContent: title, data: { kind }, onclick: () => open(kind),
  }));
  function open(kind) {
    for (const tab of tabs) tab.setAttribute("aria-pressed", tab.dataset.kind === kind);
    const form = commandForm({
      page: "look", command: `measure ${kind}`, run: "Measure", values: { out: scan },
      fields: [...KINDS[kind][1], { key: "name", label: "Name", value: kind }],
    });
    place.replaceChildren(form);
    form.suggest("reference", studio.state?.found.meshes ?? []);
  }
  open("sphere");
  return make("div", { className: "form" }, make("div", { className: "choice", role: "group" }, tabs), place);
}
