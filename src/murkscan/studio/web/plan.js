// What a rig will see in a water, while sliders are moved.

import { addressOf, ask, listen, question } from "./ask.js";
import { chart } from "./chart.js";
import { button, keep, make, note } from "./dom.js";
import { commandForm, fill } from "./form.js";

// One of them says how murky the water is; they begin at the same one.
const WATERS = [
  ["visibility-m", "A diver sees", "m", 0.5, 30, 3, true],
  ["secchi-m", "A Secchi disc is seen", "m", 0.5, 40, 4.3, true],
  ["attenuation-per-m", "Beam attenuation", "1/m", 0.1, 10, 1.6, true],
];
// Where the laser sits, as if; what is not moved stays as the rig has it.
const PLACES = [
  ["baseline-mm", "Laser from the camera", "mm", 50, 1500, null, true],
  ["angle-deg", "Its angle with that line", "°", 20, 90, null, false],
];
const SLIDERS = [
  ["power-mw", "Laser power", "mW", 1, 1000, 30, true],
  ["exposure-ms", "Exposure", "ms", 0.1, 40, 10, true],
  ["albedo", "The surface throws back", "", 0.02, 0.9, 0.1, true],
  ["spacing-mm", "Spacing of profiles", "mm", 0.5, 50, 5, true],
  ["frame-rate-hz", "Frames a second", "", 5, 120, 25, false],
  ["daylight-w-m2", "Daylight", "W/m²", 0, 5, 0, false],
];
const STEPS = 200;

export function planPage(page) {
  const out = make("div", { className: "charts" });
  const facts = make("div", { className: "facts" });
  const said = note("", "warning");
  said.hidden = true;
  const rig = make("select", { "aria-label": "Rig" });
  const water = make("select", { "aria-label": "Water by" }, WATERS.map(([value, textContent]) => make("option", { value, textContent })));
  const waters = WATERS.map((one) => slider(...one, changed)), places = PLACES.map((one) => slider(...one, changed));
  const sliders = [...waters, ...places, ...SLIDERS.map((one) => slider(...one, changed))];
  const none = make("div", { className: "row" }, note("There is no rig in this folder yet: say on the page Rig what is known of it, bring its file, or calibrate a camera."),
    make("a", { className: "button", href: "#rig", textContent: "Describe a rig" }));
  const form = commandForm({
    page: "plan", command: "plan", run: "Write the whole plan",
    fields: [{ key: "out", label: "Folder for its page", value: "plan" }],
  });
  const asked = (isWhole) => Object.fromEntries([["rig", rig.value], ...sliders
    .filter((one) => (waters.includes(one) ? one.key === water.value : one.isMoved() || (isWhole && !places.includes(one))))
    .map((one) => [one.key, one.value()])]);
  form.also = () => asked(false);
  const better = button("Where would the laser better sit?", place), bestSaid = make("div", { className: "form" });
  const plan = make("p", { className: "muted" });
  page.append(make("h1", { textContent: "Plan" }), none,
    make("div", { className: "planner" },
      make("section", { className: "card sliders" }, make("label", {}, make("span", { textContent: "Rig" }), rig), make("label", {}, make("span", { textContent: "How murky the water is, by" }), water), sliders.map((one) => one.element)),
      make("div", { className: "outcome" }, facts, make("div", { className: "row" }, better), bestSaid, said, out, make("section", { className: "card" }, form, plan))));
  rig.onchange = () => { for (const one of places) one.reset(); changed(); };
  water.onchange = changed;

  let abort = new AbortController(), timer = 0;
  function changed() {
    for (const one of waters) one.element.hidden = one.key !== water.value;
    bestSaid.replaceChildren();
    form.write();
    clearTimeout(timer);
    timer = setTimeout(compute, 120);
  }
  async function compute() {
    if (!rig.value) return;
    abort.abort();
    abort = new AbortController();
    page.classList.add("computing");
    try {
      show(await ask(question("api/plan", asked(true)), { signal: abort.signal }));
      said.hidden = true;
      page.classList.remove("computing");
    } catch (error) {
      if (error.name === "AbortError") return;
      said.textContent = error.message;
      said.hidden = false;
      page.classList.remove("computing");
    }
  }

  // It takes a hundred times as many forecasts as one place does, so it is asked for.
  async function place() {
    better.disabled = true;
    bestSaid.replaceChildren(note("Trying places …"));
    const values = asked(true);
    try {
      const best = await ask(question("api/plan/best", values));
      if (JSON.stringify(values) === JSON.stringify(asked(true))) bestSaid.replaceChildren(...wordsOf(best));
    } catch (error) {
      bestSaid.replaceChildren(note(error.message, "warning"));
    }
    better.disabled = false;
  }
  function wordsOf(best) {
    const [baseline, angle] = [best.baseline_mm.toFixed(0), best.angle_deg.toFixed(1)];
    return [note(`${best.sentence} Baselines up to ${best.longest_mm.toFixed(0)} mm were tried; σ is that along the ray.`, "good"),
    make("div", { className: "row" }, button("Try it", () => { places[0].set(baseline); places[1].set(angle); changed(); }))];
  }

  function show(seen) {
    const reach = seen.reach_m;
    places[0].suggest(seen.baseline_mm.toFixed(0));
    places[1].suggest(seen.angle_deg.toFixed(1));
    facts.replaceChildren(
      fact(reach ? `${reach[0].toFixed(2)} – ${reach[1].toFixed(2)} m` : "nothing", reach ? "here half of the points or more are found" : seen.sentence),
      fact(`${seen.fastest_mm_s.toFixed(0)} mm/s`, `fastest for this spacing; ${seen.smear_mm.toPrecision(2)} mm while a frame is exposed`),
      fact(sigmaAt(seen), "σ of a point along its ray, noise and speckle, in the middle of that range"),
      fact(`${seen.attenuation_per_m.toFixed(2)} /m`, "beam attenuation of this water"),
      fact(`${seen.baseline_mm.toFixed(0)} mm, ${seen.angle_deg.toFixed(1)}°`, places.some((one) => one.isMoved()) ? "baseline and angle of the laser, as if" : "baseline and angle of the laser as it is"));
    const x = seen.depths_m, xMost = reach ? Math.min(Math.max(...x), reach[1] * 1.4) : Math.max(...x);
    const { noise, speckle, across, common } = seen.sigma_mm;
    const lines = [
      { values: noise, name: "noise, along the ray", colour: "accent" },
      { values: speckle, name: "speckle, along the ray", colour: "accent", dash: "5 4" },
      { values: across, name: "across the ray", colour: "second" },
    ];
    if (common.some((v) => v > 0)) lines.push({ values: common, name: "calibration, common", colour: "ink", dash: "2 3" });
    const share = (values) => values.map((v) => 100 * v);
    out.replaceChildren(
      chart({ x, lines, xLabel: "distance [m]", yLabel: "σ of a point [mm]", isLog: true, band: reach, xMost }),
      chart({
        x, xMost, band: reach, xLabel: "distance [m]", yLabel: "points [%]", yRange: [0, 104], lines: [
          { values: share(seen.found), name: "found", colour: "accent" },
          { values: share(seen.in_view), name: "in the picture", colour: "second", dash: "5 4" }],
      }));
  }

  let last = "";
  return listen((state) => {
    none.hidden = state.found.rigs.length > 0;
    const written = state.jobs.find((one) => one.page === "plan" && one.state === "done");
    keep(plan, written?.name ?? "", () => (written
      ? make("a", { className: "button", href: addressOf(`${written.out}/index.html`), target: "_blank", textContent: "Open the whole plan" }) : null));
    if (JSON.stringify(state.found.rigs) === last) return;
    last = JSON.stringify(state.found.rigs);
    fill(rig, state.found.rigs);
    changed();
  });
}

function sigmaAt({ reach_m: reach, depths_m: depths, sigma_mm: sigma }) {
  if (!reach) return "–";
  const middle = (reach[0] + reach[1]) / 2;
  const k = depths.reduce((best, depth, i) => (Math.abs(depth - middle) < Math.abs(depths[best] - middle) ? i : best), 0);
  return sigma.noise[k] === null ? "–" : `${Math.hypot(sigma.noise[k], sigma.speckle[k]).toPrecision(2)} mm`;
}

const fact = (value, name) => make("div", {}, make("b", { textContent: value }), make("small", { textContent: name }));

// Sliders of what spans decades move evenly in its logarithm.
function slider(key, label, unit, low, high, start, isLog, changed) {
  const toPlace = (value) => Math.round(STEPS * (isLog ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low)));
  const toValue = (place) => (isLog ? low * (high / low) ** (place / STEPS) : low + (high - low) * (place / STEPS));
  const number = make("input", { type: "number", step: "any", value: start ?? "", name: key, "aria-label": label });
  const range = make("input", { type: "range", min: 0, max: STEPS, value: toPlace(start ?? low), "aria-label": label });
  range.oninput = () => { number.value = Number(toValue(Number(range.value)).toPrecision(2)); changed(); };
  number.oninput = () => { range.value = toPlace(Math.max(Number(number.value), isLog ? low : 0)); changed(); };
  const element = make("div", { className: "slider" }, make("span", { textContent: unit ? `${label} [${unit}]` : label }), range, number);
  const set = (value) => { number.value = value; range.value = toPlace(Number(value)); };
  let isAsked = false;  // of what the rig itself says, until it is moved
  element.addEventListener("input", () => { isAsked = true; }, true);
  return {
    key, element, value: () => number.value,
    isMoved: () => (start === null ? isAsked && number.value !== "" : Number(number.value) !== start),
    set: (value) => { isAsked = true; set(value); },
    suggest: (value) => { if (!isAsked) set(value); },
    reset: () => { isAsked = false; },
  };
}
