// What a rig will see in a water, while sliders are moved.

import { ask, listen, question } from "./ask.js";
import { chart } from "./chart.js";
import { keep, make, note } from "./dom.js";
import { commandForm, fill } from "./form.js";

const SLIDERS = [
  ["visibility-m", "A diver sees", "m", 0.5, 30, 3, true],
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
  const sliders = SLIDERS.map((one) => slider(...one, changed));
  const none = note("There is no rig file in this folder yet; bring one on the page Rig, or calibrate a camera.");
  const form = commandForm({
    page: "plan", command: "plan", run: "Write the whole plan",
    fields: [{ key: "out", label: "Folder for its page", value: "plan" }],
  });
  form.also = () => Object.fromEntries([["rig", rig.value], ...sliders.filter((one) => one.isMoved()).map((one) => [one.key, one.value()])]);
  const plan = make("p", { className: "muted" });
  page.append(make("h1", { textContent: "Plan" }), none,
    make("div", { className: "planner" },
      make("section", { className: "card sliders" }, make("label", {}, make("span", { textContent: "Rig" }), rig), sliders.map((one) => one.element)),
      make("div", { className: "outcome" }, facts, said, out, make("section", { className: "card" }, form, plan))));
  rig.onchange = changed;

  let abort = new AbortController(), timer = 0;
  function changed() {
    form.write();
    clearTimeout(timer);
    timer = setTimeout(compute, 120);
  }
  async function compute() {
    if (!rig.value) return;
    abort.abort();
    abort = new AbortController();
    page.classList.add("computing");
    const values = Object.fromEntries([["rig", rig.value], ...sliders.map((one) => [one.key, one.value()])]);
    try {
      show(await ask(question("api/plan", values), { signal: abort.signal }));
      said.hidden = true;
      page.classList.remove("computing");
    } catch (error) {
      if (error.name === "AbortError") return;
      said.textContent = error.message;
      said.hidden = false;
      page.classList.remove("computing");
    }
  }

  function show(seen) {
    const reach = seen.reach_m;
    facts.replaceChildren(
      fact(reach ? `${reach[0].toFixed(2)} – ${reach[1].toFixed(2)} m` : "nothing", reach ? "here half of the points or more are found" : seen.sentence),
      fact(`${seen.fastest_mm_s.toFixed(0)} mm/s`, `fastest for this spacing; ${seen.smear_mm.toPrecision(2)} mm while a frame is exposed`),
      fact(sigmaAt(seen), "σ of a point along its ray, noise and speckle, in the middle of that range"),
      fact(`${seen.attenuation_per_m.toFixed(2)} /m`, "beam attenuation of this water"),
      fact(`${seen.baseline_mm.toFixed(0)} mm, ${seen.angle_deg.toFixed(1)}°`, "baseline and angle of the laser as it is"));
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
    keep(plan, state.jobs.filter((job) => job.page === "plan" && job.state === "done").slice(0, 1).map((job) => job.text), () => {
      const job = state.jobs.find((one) => one.page === "plan" && one.state === "done");
      return job ? make("span", { textContent: "Written: open index.html in its folder." }) : null;
    });
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
  const number = make("input", { type: "number", step: "any", value: start, name: key, "aria-label": label });
  const range = make("input", { type: "range", min: 0, max: STEPS, value: toPlace(start), "aria-label": label });
  range.oninput = () => { number.value = Number(toValue(Number(range.value)).toPrecision(2)); changed(); };
  number.oninput = () => { range.value = toPlace(Math.max(Number(number.value), isLog ? low : 0)); changed(); };
  const element = make("div", { className: "slider" }, make("span", { textContent: unit ? `${label} [${unit}]` : label }), range, number);
  return { key, element, value: () => number.value, isMoved: () => key === "visibility-m" || Number(number.value) !== start };
}
