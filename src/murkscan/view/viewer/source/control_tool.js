// Control points picked on the model: the table that `murkscan georeference` reads, and its command.

import { copyButton, folderOf, numbersOf } from "./command.js";
import { choice, make, setPressed } from "./dom.js";
import { pointOf, worldPlace } from "./model.js";

const SIGMA = "5"; // mm, until the surveyor says better
const KINDS = {
  earth: {
    label: "On the Earth", file: "control.csv",
    columns: [["easting_m", "easting"], ["northing_m", "northing"], ["height_m", "height"]],
    flags: "--control control.csv --crs EPSG:N",
    hint: "Put the number of the coordinate system in place of N.",
  },
  frames: {
    label: "Ship, frames", file: "hull.csv",
    columns: [["frame", "frame"], ["height_m", "height"], ["from_centreline_m", "off centreline"], ["side", "side"]],
    flags: "--hull hull.csv --frame-spacing-mm D",
    hint: "Put the distance of two frames in place of D.",
  },
  bow: {
    label: "Ship, from bow", file: "hull.csv",
    columns: [["from_bow_m", "from bow"], ["height_m", "height"], ["from_centreline_m", "off centreline"], ["side", "side"]],
    flags: "--hull hull.csv", hint: "",
  },
};

export function controlTool(app) {
  const toggle = make("button", {
    type: "button", textContent: "Pick", title: "Key G",
    onclick: () => app.update({ picking: !app.state.picking, measuring: false, first: null }),
  });
  const clear = make("button", {
    type: "button", textContent: "Clear", onclick: () => app.update({ picks: [] }),
  });
  const kinds = choice("What the points lie in",
    Object.entries(KINDS).map(([value, { label }]) => [value, label]),
    (kind) => app.update({ controlKind: kind }));
  kinds.element.classList.add("stacked");
  const hint = make("p", { className: "note" });
  const list = make("ol", { className: "picks" });
  const save = make("button", { type: "button", textContent: "Save as CSV", onclick: saveTable });
  const copying = make("div", {});
  const element = make("div", {}, make("div", { className: "row" }, toggle, clear), kinds.element,
    hint, list, save, copying);

  const columns = () => [["name", "name"], ...KINDS[app.state.controlKind].columns, ["sigma_mm", "sigma [mm]"]];

  function table() {
    const names = columns().map(([name]) => name);
    const rows = app.picks.map((pick, k) => [
      ...names.map((name) => cell(valueOf(pick, name, k))),
      ...numbersOf(worldPlace(app.model, pointOf(app.model, pick.point))).split(","),
    ].join(","));
    return [[...names, "x_m", "y_m", "z_m"].join(","), ...rows, ""].join("\n");
  }

  function saveTable() {
    const address = URL.createObjectURL(new Blob([table()], { type: "text/csv" }));
    make("a", { href: address, download: KINDS[app.state.controlKind].file }).click();
    setTimeout(() => URL.revokeObjectURL(address), 1000);
  }

  function describe(pick, k) {
    const fields = columns().map(([name, label]) => make("label", {}, `${label} `, make("input", {
      type: "text", size: 9, value: valueOf(pick, name, k), "data-column": name,
      oninput: (event) => { pick.cells[name] = event.target.value.trim(); },
    })));
    const drop = make("button", {
      type: "button", textContent: "Leave out",
      onclick: () => app.update({ picks: app.state.picks.filter((one) => one !== pick) }),
    });
    return make("li", {}, ...fields, drop);
  }

  let shown = ""; // what is typed stays while nothing else changes
  function sync() {
    const { picking, controlKind } = app.state;
    setPressed(toggle, picking);
    kinds.show(controlKind);
    const { picks } = app;
    clear.hidden = save.hidden = copying.hidden = picks.length === 0;
    const { flags, hint: how } = KINDS[controlKind];
    hint.textContent = picking && picks.length < 3
      ? "Point at each place that was measured, three or more that are not on a line."
      : picks.length ? `Write down what was measured there, and save the table. ${how}` : "";
    hint.hidden = !hint.textContent;
    const now = `${controlKind} ${app.state.scan} ${picks.map(({ point }) => point)}`;
    if (now === shown) return;
    shown = now;
    list.replaceChildren(...picks.map(describe));
    copying.replaceChildren(copyButton(`murkscan georeference ${folderOf(app)} ${flags}`));
  }
  return { name: "control", title: "Control points", element, sync };
}

function valueOf({ cells }, name, k) {
  if (name in cells) return cells[name];
  return name === "name" ? `P${k + 1}` : name === "sigma_mm" ? SIGMA : "";
}

// A decimal comma, and what would part cells, do not belong into one.
const cell = (text) => text.replace(/(\d),(\d)/g, "$1.$2").replace(/[,;\t"]/g, " ");
