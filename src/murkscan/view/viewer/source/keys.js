// The keyboard, and the page that tells of it.

import { make } from "./dom.js";
import { swapTheme } from "./theme.js";

const STEP = Math.PI / 36;
const PAN = 0.06;
const ZOOM = 1.2;

const HELP = [
  ["drag, or one finger", "turn"],
  ["wheel, or two fingers", "zoom, towards the pointer"],
  ["right button, or two fingers", "move"],
  ["double click", "turn about this point"],
  ["click", "read a point"],
  ["arrow keys", "turn; with shift: move"],
  ["+  −", "zoom"],
  ["1 … 7", "isometric, front, back, left, right, top, bottom"],
  ["R", "reset the view, the cut and the time"],
  ["S", "surface or points"],
  ["M", "measure: then click two points"],
  ["C", "cut"],
  ["G", "pick control points"],
  ["P", "play the profiles"],
  ["B", "before and after, where there are two scans"],
  ["T", "light or dark"],
  ["Esc", "stop measuring and picking"],
  ["?", "this help"],
];

const about = (rounding) => [
  "Lengths are in millimetres, places in metres along the world's axes, as commands take and give them.",
  `Places are rounded by ${rounding}, values to a 65 000th of their range, the `
    + "directions that shade the surface to a quarter of a degree. cloud.ply has all digits.",
  "White slits and gaps are places without a point: an edge hid them from the laser or from the camera, no "
    + "light came back, or the camera went too fast. The report's map says which. Nothing is made up there.",
];

export function startKeys(app) {
  const names = Object.keys(app.model.views);
  const { stage } = app;
  const turnOrMove = (right, up) => (event) => (event.shiftKey
    ? stage.shift((right * PAN * stage.width) / stage.scale, (up * PAN * stage.width) / stage.scale)
    : stage.turn(right * STEP, up * STEP));
  const actions = {
    ArrowLeft: turnOrMove(-1, 0), ArrowRight: turnOrMove(1, 0),
    ArrowUp: turnOrMove(0, 1), ArrowDown: turnOrMove(0, -1),
    "+": () => stage.zoomBy(ZOOM), "=": () => stage.zoomBy(ZOOM),
    "-": () => stage.zoomBy(1 / ZOOM), _: () => stage.zoomBy(1 / ZOOM),
    r: () => app.reset(),
    s: () => app.update({ kind: app.state.kind === "surface" ? "points" : "surface" }),
    m: () => app.update({ measuring: !app.state.measuring, picking: false, first: null }),
    g: () => app.update({ picking: !app.state.picking, measuring: false, first: null }),
    c: () => app.toggleCut(),
    p: () => app.play(!app.state.playing),
    b: () => app.update({ scan: (app.state.scan + 1) % app.models.length }),
    t: () => { swapTheme(); app.update({}); },
    "?": () => app.help.showModal(),
    Escape: () => app.update({ measuring: false, picking: false, first: null, snapped: null }),
  };
  names.forEach((name, number) => { actions[String(number + 1)] = () => app.lookFrom(name); });
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || app.help.open) return;
    if (event.target.matches("input, select") && event.key !== "Escape") return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (!actions[key]) return;
    event.preventDefault();
    actions[key](event);
  });
}

export function makeHelp(models) {
  const step = Math.max(...models.map(({ grid }) => grid.step / 2)) * 1e3;
  const rounding = step < 0.001 ? "less than 0.001 mm" : `${step.toFixed(3)} mm`;
  const help = document.getElementById("help");
  const rows = HELP.flatMap(([keys, meaning]) =>
    [make("dt", { textContent: keys }), make("dd", { textContent: meaning })]);
  const close = make("button", { type: "button", textContent: "Close", onclick: () => help.close() });
  help.append(
    make("h2", { textContent: "Keys and gestures" }), make("dl", {}, ...rows),
    make("h2", { textContent: "About" }),
    ...about(rounding).map((textContent) => make("p", { textContent })), close);
  help.addEventListener("click", (event) => { if (event.target === help) help.close(); });
  return help;
}
