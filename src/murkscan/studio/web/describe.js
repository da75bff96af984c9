// A rig by what a data sheet, a ruler and a thermometer say: to plan with, and to calibrate from.

import { make, note } from "./dom.js";
import { commandForm } from "./form.js";

const FIELDS = [
  { key: "rig", label: "Rig file", value: "rig.toml", hint: "made where it is missing", required: true },
  { key: "size-px", label: "Picture", unit: "px", placeholder: "720x576", hint: "of a camera that is not calibrated" },
  { key: "view-deg", label: "Seen from left to right in air", unit: "°", kind: "number", placeholder: "66" },
  { key: "baseline-mm", label: "Laser from the camera", unit: "mm", kind: "number", placeholder: "300" },
  { key: "angle-deg", label: "Its angle with that line", unit: "°", kind: "number", placeholder: "65", hint: "90 is straight ahead" },
  { key: "axis", label: "It sits", kind: "select", options: [["", "above or below"], ["x", "beside"]], hint: "seen from the camera" },
  { key: "kind", label: "Window", kind: "select", local: true, options: [["", "–"], ["window-mm", "flat"], ["dome-radius-mm", "dome"]] },
  { key: "far", label: "Camera to its inner face", unit: "mm", kind: "number", local: true, placeholder: "30" },
  { key: "glass-mm", label: "Its thickness", unit: "mm", kind: "number", placeholder: "8", skip: ({ kind }) => !kind },
  { key: "temperature-c", label: "Water", unit: "°C", kind: "number", placeholder: "15" },
  { key: "salinity-psu", label: "Its salt", unit: "PSU", kind: "number", placeholder: "35", hint: "0 fresh, about 35 at sea" },
  { key: "glass-index", label: "Refractive index of the window", kind: "number", placeholder: "1.49", hint: "1.49 acrylic, 1.52 glass", more: true },
  { key: "wavelength-nm", label: "Colour of the laser", unit: "nm", kind: "number", placeholder: "532", hint: "for a new rig file", more: true },
];

export function describeCard() {
  const form = commandForm({
    page: "rig", command: "calibrate describe", run: "Write it", fields: FIELDS,
    onchange: ({ kind }) => { for (const key of ["far", "glass-mm"]) form.input(key).closest("label").hidden = !kind; },
  });
  form.also = ({ kind, far }) => (kind ? { [kind]: far } : {});
  const element = make("section", { className: "card wide" }, make("h2", { textContent: "A rig by what is known of it" }),
    note("What a data sheet, a ruler and a thermometer say is enough to plan with, and for a window’s calibration to begin from. Leave empty what is not known; what was calibrated stays."), form);
  return { element, name: (rig) => form.offer("rig", rig) };
}
