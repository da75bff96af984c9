// What is calibrated and how well, what comes next, and a board to print.

import { addressOf, ask, listen, question } from "./ask.js";
import { describeCard } from "./describe.js";
import { draw, keep, make, note, table } from "./dom.js";
import { commandForm, fill, uploader } from "./form.js";

const NEXT = {
  camera: "Photograph a board in air, tilted to every side, 15 times or more.",
  port: "Only behind a window: say below how far and how thick it is and what water is at hand, then photograph a board under water.",
  laser: "Photograph the laser's line on a board: near, far, and between.",
  mount: "Only for a vehicle with a log of poses: photograph a board that stands still from many places.",
};

export function rigPage(page) {
  const chosen = make("select", { "aria-label": "Rig" });
  const cards = make("div", { className: "cards" });
  const none = make("div", { className: "row" }, note("There is no rig in this folder yet: calibrate a camera, say below what is known of it, or bring a rig file."),
    make("a", { className: "button", href: "#calibrate/camera", textContent: "Calibrate a camera" }));
  const known = describeCard();
  const head = make("div", { className: "toolbar" }, make("label", {}, make("span", { textContent: "Rig" }), chosen),
    uploader({ label: "Bring a rig file", accept: ".toml", multiple: false, nameOf: (file) => file.name }));
  const cut = note("This folder holds more than is looked at: begin the studio in one for this work alone.", "warning");
  page.append(make("h1", { textContent: "Rig" }), head, cut, none, cards, known.element, board());
  chosen.onchange = load;

  let last = "";
  async function load() {
    const name = chosen.value;
    cards.hidden = !name;
    if (!name) return;
    known.name(name);
    try {
      const rig = await ask(question("api/rig", { name }));
      keep(cards, rig, () => describe(rig));
    } catch (error) {
      keep(cards, error.message, () => note(error.message, "warning"));
    }
  }
  return listen((state) => {
    const { rigs } = state.found;
    none.hidden = rigs.length > 0;
    cut.hidden = !state.found.is_cut;
    chosen.disabled = rigs.length === 0;
    const key = JSON.stringify([rigs, state.jobs.map((job) => [job.name, job.state])]);
    if (key === last) return;
    last = key;
    fill(chosen, rigs);
    load();
  });
}

function describe(rig) {
  return [
    rig.fault ? note(rig.fault, "warning") : null,
    ...rig.steps.map(card),
    rig.facts.length ? make("section", { className: "card" }, make("h2", { textContent: "In numbers" }), table([], rig.facts)) : null,
  ];
}

export function card(step) {
  const [kind] = step.step.split(" ");
  const isOptional = kind === "port" || kind === "mount";
  const word = step.is_calibrated ? (step.is_good ? "good" : step.is_usable ? "usable" : "not usable") : step.is_there ? "as written" : isOptional ? "none" : "missing";
  const tone = step.is_calibrated ? (step.is_good ? "good" : step.is_usable ? "warning" : "bad") : step.is_there || isOptional ? "plain" : "warning";
  const unused = Object.entries(step.unused);
  return make("section", { className: "card" },
    make("h2", {}, step.step[0].toUpperCase() + step.step.slice(1), make("span", { className: `badge ${tone}`, textContent: word })),
    step.is_calibrated
      ? [note(step.verdict, tone),
        make("p", { className: "muted", textContent: `${step.date}: ${step.views} of ${step.photos} photographs used, board ${step.board}; corners off by ${step.rms_px} px` }),
        step.errors.length ? table(["what", "at", "known to, 1σ"], step.errors.map((e) => [e.what, `${e.distance_mm.toFixed(0)} mm`, `± ${e.sigma_mm.toPrecision(2)} mm`])) : null,
        unused.length ? make("details", {}, make("summary", { textContent: `${unused.length} photographs not used, and why` }), table(["photograph", "reason"], unused)) : null]
      : note(step.is_there ? `Written by hand: how well it is known is not stated. ${NEXT[kind]}` : NEXT[kind]),
    make("div", { className: "row" },
      make("a", { className: "button", href: `#calibrate/${kind}`, textContent: step.is_calibrated ? "Again" : "Calibrate" }),
      step.page ? make("a", { className: "button", href: addressOf(step.page), target: "_blank", textContent: "All of it" }) : null));
}

// A board whose squares are as wide as they say, to print at 100 %.
function board() {
  const preview = make("div", { className: "board" });
  const form = commandForm({
    page: "rig", command: "calibrate board", run: "Make the file",
    fields: [
      { key: "wide", label: "Corners wide", kind: "number", value: 9, step: 1, min: 3, local: true },
      { key: "high", label: "Corners high", kind: "number", value: 6, step: 1, min: 3, local: true },
      { key: "square-mm", label: "Square", unit: "mm", kind: "number", value: 25, min: 1 },
      { key: "out", label: "File", value: "board.pdf" },
    ],
    onchange: sketch,
  });
  form.also = ({ wide, high }) => ({ board: `${wide}x${high}` });
  function sketch({ wide, high, "square-mm": square }) {
    const [w, h, s] = [Number(wide) + 1, Number(high) + 1, Number(square)];
    if (!(w > 1 && h > 1 && w < 60 && h < 60 && s > 0)) return;
    const squares = [];
    for (let y = 0; y < h; y += 1) for (let x = y % 2; x < w; x += 2) squares.push(draw("rect", { x, y, width: 1, height: 1 }));
    preview.replaceChildren(draw("svg", { viewBox: `-1 -1 ${w + 2} ${h + 2}`, role: "img", "aria-label": "Board" },
      draw("rect", { x: -1, y: -1, width: w + 2, height: h + 2, class: "paper" }), squares),
    note(`${((w + 2) * s / 10).toFixed(1)} × ${((h + 2) * s / 10).toFixed(1)} cm with its margin. Print it at 100 %, glue it on something flat, and measure a row of squares: the size that counts is the printed one.`));
  }
  form.write();
  return make("section", { className: "card wide" }, make("h2", { textContent: "A board to print" }), make("div", { className: "split" }, form, preview),
    make("div", { className: "row" }, make("small", { className: "muted", textContent: "Corners are those inside, where black squares touch. The file lies in the folder when it is made." })));
}
