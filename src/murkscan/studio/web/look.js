// A scan: its model, its measures with their intervals, its report, its files; and a new scan.

import { addressOf, ask, listen, order, question, refresh, studio } from "./ask.js";
import { button, keep, make, note, table } from "./dom.js";
import { commandForm, fill, freeName, givePlace, uploader } from "./form.js";
import { measureForms } from "./measures.js";
import { motionFields, motionOf, showMotion } from "./motion.js";

const PLACE = /^-?\d+(\.\d+)?(,-?\d+(\.\d+)?){2}$/;

export function lookPage(page, [named]) {
  const chosen = make("select", { "aria-label": "Scan" });
  const none = note("There is no scan in this folder yet: scan a recording below.");
  const model = make("div", {});
  const measured = make("section", { className: "card" });
  const forms = make("section", { className: "card" });
  const stages = make("div", {});
  const fresh = scanForm(), merged = mergeForm();
  page.append(make("h1", { textContent: "Look and measure" }),
    make("div", { className: "toolbar" }, make("label", {}, make("span", { textContent: "Scan" }), chosen)),
    none, model, measured, forms, stages, fresh.element, merged.element);
  chosen.onchange = () => { location.hash = `#look/${encodeURIComponent(chosen.value)}`; };

  async function load() {
    const name = chosen.value;
    for (const part of [model, measured, forms, stages]) part.hidden = !name;
    if (!name) return;
    try {
      const scan = await ask(question("api/scan", { name }));
      keep(model, [name, scan.page, scan.pictures], () => modelOf(scan));
      keep(measured, [scan.measures, scan.unstated], () => measuresOf(scan));
      keep(forms, name, () => [make("h2", { textContent: "Measure" }), measureForms(name)]);
      keep(stages, [scan.stages, scan.files, scan.report, scan.accepted], () => stagesOf(scan));
    } catch (error) {
      keep(model, error.message, () => note(error.message, "warning"));
    }
  }

  function heard({ data, source }) {
    if (source !== model.querySelector("iframe")?.contentWindow) return;
    if (PLACE.test(data?.place)) givePlace(data.place);
    if (typeof data?.murkscan !== "string") return;
    const words = data.murkscan.match(/^murkscan measure \S+ distance --from-m (\S+) --to-m (\S+)$/);
    const cut = data.murkscan.match(/^murkscan measure \S+ section --point-m (\S+) --normal (\S+)$/);
    if (words) measure("distance", { "from-m": words[1], "to-m": words[2] });
    if (cut) measure("section", { "point-m": cut[1], normal: cut[2] });
  }
  async function measure(kind, values) {
    const count = 1 + page.querySelectorAll(".measure").length;
    try {
      await order("api/jobs", { command: `measure ${kind}`, page: "look", values: { out: chosen.value, name: `${kind}-${count}`, ...values } });
      await refresh();
      measured.scrollIntoView({ behavior: "smooth", block: "nearest" });
    } catch (error) {
      measured.prepend(note(error.message, "warning"));
    }
  }
  addEventListener("message", heard);

  let last = "";
  const stop = listen((state) => {
    const { scans } = state.found;
    none.hidden = scans.length > 0;
    chosen.closest("div").hidden = scans.length === 0;
    fresh.sync(state);
    merged.sync(state);
    const key = JSON.stringify([scans, state.jobs.map((job) => [job.name, job.state, job.progress?.[0]])]);
    if (key === last) return;
    last = key;
    fill(chosen, scans, last ? (named ?? chosen.value) : named);
    load();
  });
  return () => { stop(); removeEventListener("message", heard); };
}

function modelOf(scan) {
  if (!scan.page && !scan.pictures.length) return note("There is no model yet: it comes with the stage view.");
  if (!scan.page) return picturesOf(scan);
  if (!document.createElement("canvas").getContext("webgl2")) {
    return [note("This browser has no WebGL 2, so that the model cannot be turned here: these are its pictures. Measures are taken by typed places.", "warning"), picturesOf(scan)];
  }
  const frame = make("iframe", { className: "viewer", src: addressOf(scan.page), title: "The model, to turn, cut and measure" });
  return [frame, make("div", { className: "row" },
    make("a", { className: "button", href: addressOf(scan.page), target: "_blank", textContent: "Model on its own" }),
    scan.report ? make("a", { className: "button", href: addressOf(scan.report), target: "_blank", textContent: "Report" }) : null,
    make("small", { textContent: "Measure two places, or cut, in the model: “Take this measure” there puts it below. Or fit a ball, a pipe, a plane or a step: “Pick” below, then click the place." }))];
}

const picturesOf = ({ pictures }) => make("div", { className: "gallery" }, pictures.map((name) => {
  const side = name.split("?")[0].split("/").at(-1).replace(".png", "");
  return make("figure", {}, make("a", { href: addressOf(name), target: "_blank" }, make("img", { src: addressOf(name), alt: `The scanned surface, ${side}` })), make("figcaption", { textContent: side }));
}));

const UNITS = { m: ["mm", 1e3], m2: ["cm²", 1e4], m3: ["cm³", 1e6], rad: ["°", 180 / Math.PI] };

function measuresOf({ measures, unstated }) {
  return [make("h2", { textContent: "Measures" }),
    measures.length ? null : note("None yet."),
    ...measures.map((one) => make("div", { className: "measure" },
      make("h3", { textContent: `${one.name}: ${one.kind}` }),
      table([], one.rows.map(([key, value, half, isUnknown]) => rowOf(key, value, half, isUnknown))),
      one.command ? make("code", { textContent: one.command }) : null,
      one.files.length ? make("div", { className: "row" }, one.files.map(linkOf)) : null)),
    measures.length ? make("small", { textContent: "In 95 of 100 scans the truth lies within value ± what follows it." }) : null,
    ...unstated.map((text) => note(text, "warning"))];
}

function rowOf(key, value, half, isUnknown) {
  const [, name, unit] = key.match(/^(.*?)(?:_(m3|m2|m|rad))?$/);
  const isPlace = ["x", "y", "z"].includes(name);
  const [word, scale] = isPlace ? ["m", 1] : UNITS[unit] ?? [unit ?? "", 1];
  const digits = half > 0 ? Math.min(Math.max(1 - Math.floor(Math.log10(half * scale)), 0), 6) : 4;
  const doubt = half * scale < 5e-7 ? "" : ` ± ${(half * scale).toFixed(digits)}`;
  return [name.replaceAll("_", " "), `${(value * scale).toFixed(digits)}${doubt} ${word}${isUnknown ? " (points’ noise only)" : ""}`];
}

const linkOf = (name) => make("a", { href: addressOf(name), target: "_blank", textContent: name.split("/").at(-1) });
const size = (bytes) => (bytes > 1e6 ? `${(bytes / 1e6).toFixed(1)} MB` : `${Math.ceil(bytes / 1e3)} kB`);

function stagesOf({ name, stages, files, report, accepted }) {
  const accept = commandForm({
    page: "look", command: "accept", run: "Test", values: { out: name },
    fields: [{ key: "test", label: "File of the artefacts and limits", list: [], placeholder: "acceptance.toml" }],
  });
  const lay = commandForm({
    page: "look", command: "georeference", run: "Lay on control points", values: { out: name },
    fields: [{ key: "control", label: "Table of control points", list: [], placeholder: "control.csv" }, { key: "crs", label: "Coordinate system", placeholder: "EPSG:25832" }],
  });
  accept.suggest("test", studio.state?.found.tests ?? []);
  lay.suggest("control", studio.state?.found.logs ?? []);
  const export_ = commandForm({
    page: "look", command: "cloud", run: "Export the cloud", values: { out: name },
    fields: [{ key: "export", label: "File: .laz, .copc.laz, .las, .e57, .ply, .xyz", value: `${name.split("/").at(-1)}.laz` }],
  });
  const view = commandForm({
    page: "look", command: "view", run: "Make the page anew", values: { out: name },
    fields: [{ key: "title", label: "Title on the page", placeholder: "client, place, date" }],
  });
  const wrote = commandForm({
    page: "look", command: "report", run: "Write the report anew", values: { out: name },
    fields: [{ key: "title", label: "Title" }, { key: "client", label: "Client" }, { key: "place", label: "Place", placeholder: "ship, pier, date" },
      { key: "spacing-mm", label: "Wanted spacing", unit: "mm", kind: "number", more: true }],
  });
  return make("div", { className: "cards" },
    make("section", { className: "card" }, make("h2", { textContent: "What was made" }),
      make("ul", { className: "stages" }, stages.map((one) => make("li", {}, make("b", { textContent: one.stage }),
        one.fault ? make("span", { className: "sentence", textContent: one.fault })
          : make("span", { className: one.made ? "" : "missing" }, one.made || "not yet", one.quality.map((text) => make("small", { className: "block", textContent: ` ${text}.` })))))),
      report ? make("div", { className: "row" }, make("a", { className: "button", href: addressOf(report), target: "_blank", textContent: "Open the report" })) : null),
    make("section", { className: "card" }, make("h2", { textContent: "Report, page and exports" }), wrote, view, export_),
    make("section", { className: "card" }, make("h2", { textContent: "Acceptance" }),
      note("Hold a scan of calibrated balls, bars, plates or steps against limits; makes a page to sign."), accept,
      accepted ? make("div", { className: "row" }, make("a", { className: "button", href: addressOf(accepted), target: "_blank", textContent: "Open the page to sign" })) : null,
      make("h2", { textContent: "Place on the Earth" }),
      note("Lay the scan on control points; what is exported afterwards lies in their coordinate system."), lay),
    make("section", { className: "card" }, make("h2", { textContent: "Files" }),
      make("ul", { className: "files" }, files.map(([path, bytes]) => make("li", {},
        make("a", { href: addressOf(path), target: "_blank", textContent: path.slice(name.length + 1) }), ` ${size(bytes)}`)))));
}

// A new scan of a recording.
function scanForm() {
  const form = commandForm({
    page: "look", command: "scan", run: "Scan",
    fields: [
      { key: "recording", label: "Recording", kind: "select", required: true },
      { key: "rig", label: "Rig", kind: "select", required: true },
      ...motionFields(),
      { key: "out", label: "Folder for the scan", value: "scan", required: true },
      { key: "fps", label: "Pictures a second", kind: "number", hint: "of a folder without times.csv", more: true },
      { key: "extractor", label: "How the stripe is found", kind: "select", options: [["", "murk"], "gray-gravity", "gaussian", "steger", "threshold-skeleton"], more: true },
      { key: "mesher", label: "How the surface is made", kind: "select", options: [["", "grid"], "poisson"], more: true },
      { key: "start-time", label: "When the video began", hint: "seconds or ISO 8601, by the log’s clock", more: true },
      { key: "time-offset-s", label: "Added to recording times", unit: "s", kind: "number", more: true },
    ],
    onchange: ({ how }) => showMotion(form, how),
  });
  form.also = motionOf;
  showMotion(form, "speed-mm-s");
  let last = "";
  return {
    element: make("section", { className: "card" }, make("h2", { textContent: "A new scan" }), form,
      uploader({ label: "Bring a recording, a log or a drawing", accept: ".mkv,.mp4,.mov,.avi,.ts,.mcap,.bag,.tlog,.csv,.txt,.stl,.obj,.ply,.glb", nameOf: (file) => file.name })),
    sync(state) {
      const { recordings, rigs, logs, scans } = state.found;
      const key = JSON.stringify([recordings, rigs, logs, scans]);
      if (key === last) return;
      last = key;
      fill(form.input("recording"), recordings);
      form.offer("out", freeName("scan", scans));
      fill(form.input("rig"), rigs);
      form.suggest("log", logs);
      form.write();
    },
  };
}

// Several passes of one object laid on another, as one cloud; then its surface and its page.
function mergeForm() {
  const places = ["first", "second", "third", "fourth"];
  const form = commandForm({
    page: "look", command: "merge", run: "Merge",
    fields: [
      ...places.map((key, k) => ({ key, label: `Pass ${k + 1}`, kind: "select" })),
      { key: "out", label: "Folder for the whole", value: "merged" },
      { key: "as-logged", label: "Leave the passes where their logs put them", kind: "switch", more: true },
    ],
  });
  const element = make("section", { className: "card" }, make("h2", { textContent: "Merge passes" }), form,
    make("small", { className: "muted", textContent: "Then mesh, view and report make its surface, its page and its report:" }));
  const after = ["mesh", "view", "report"].map((command) => commandForm({
    page: "look", command, run: command, fields: [{ key: "out", label: "Folder of the whole", kind: "select" }],
  }));
  element.append(make("div", { className: "cards" }, after));
  let last = "";
  return {
    element,
    sync({ found: { scans } }) {
      element.hidden = scans.length < 2;
      if (JSON.stringify(scans) === last) return;
      last = JSON.stringify(scans);
      places.forEach((key, k) => fill(form.input(key), k < 2 ? scans : [["", "–"], ...scans]));
      if (scans.length > 1) form.offer("second", scans[1]);
      form.offer("out", freeName("merged", scans));
      for (const one of after) { fill(one.input("out"), scans); one.write(); }
      form.write();
    },
  };
}
