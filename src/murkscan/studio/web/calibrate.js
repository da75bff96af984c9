// A calibration: the board, the photographs with their corners, what is missing, the verdict.

import { addressOf, ask, listen, question, studio } from "./ask.js";
import { draw, keep, make, note } from "./dom.js";
import { commandForm, fill, uploader } from "./form.js";
import { card } from "./rig.js";
import { sightCard } from "./sight.js";

const BOARD = [
  { key: "count", label: "Number of boards", kind: "number", value: 15, step: 1, min: 4, local: true, hint: "photographs that you mean to take", everywhere: true },
  { key: "wide", label: "Corners wide", kind: "number", value: 9, step: 1, min: 3, local: true, everywhere: true },
  { key: "high", label: "Corners high", kind: "number", value: 6, step: 1, min: 3, local: true, everywhere: true },
  { key: "square-mm", label: "Size of a square", unit: "mm", kind: "number", value: 25, everywhere: true },
];
const MARGIN = { key: "margin-mm", label: "Blank paper beyond the squares", placeholder: "120,80,60,60", hint: "left, right, top, bottom, in mm", more: true };
const LASER = { key: "laser", label: "Number of the laser", value: "0", more: true };
const STEPS = {
  camera: ["Camera", "A board in air, 15 times or more, tilted to every side and out to the corners of the picture.", [
    { key: "wavelength-nm", label: "Colour of the laser", unit: "nm", kind: "number", hint: "for a new rig file", more: true },
    { key: "charuco-marker-mm", label: "Side of a ChArUco marker", unit: "mm", kind: "number", more: true }]],
  port: ["Port", "The board under water, through the window: near and far, tilted to every side. Say first, on the page Rig, how far and how thick the window is, and what water is at hand.", [
    { key: "distance-mm", label: "Optical centre to window", placeholder: "30±2", hint: "in mm; else from the photographs alone" }]],
  laser: ["Laser", "The laser’s line across the board: near, far, and between, over all distances that you will scan at.", [
    { key: "kind", label: "The sheet", kind: "select", options: [["", "plane"], "fan"] }, LASER, MARGIN]],
  mount: ["Mount", "A board that stands still, from many places, with the vehicle turned about two axes.", [
    { key: "poses", label: "Log of poses", kind: "select" },
    { key: "fps", label: "Photographs a second", kind: "number", more: true },
    { key: "time-offset-s", label: "Added to their times", unit: "s", kind: "number", more: true }]],
  check: ["Check", "The board with the laser’s line in the water at hand: is what is known still right? Nothing is written.", [LASER, MARGIN]],
};

export function calibratePage(page, [named]) {
  const step = STEPS[named] ? named : "camera";
  const [, words, more] = STEPS[step];
  const tabs = Object.entries(STEPS).map(([name, [text]]) => make("a", {
    className: `button ${name === step ? "pressed" : ""}`, href: `#calibrate/${name}`, textContent: text,
  }));
  const photos = step === "check" ? "source" : "images";
  const form = commandForm({
    page: "calibrate", command: `calibrate ${step}`, run: "Calibrate",
    fields: [{ key: photos, label: "Photographs", kind: "select", required: true }, ...BOARD,
      step === "camera" ? { key: "rig", label: "Rig file", value: "rig.toml", hint: "made where it is missing" } : { key: "rig", label: "Rig file", kind: "select", required: true },
      ...more],
    onchange: () => { sight.write(); look(); },
  });
  form.also = ({ wide, high }) => ({ board: `${wide}x${high}` });
  const name = make("input", { value: `boards-${step}`, "aria-label": "Folder for photographs", autocomplete: "off" });
  const bring = make("div", { className: "toolbar" }, make("label", {}, make("span", { textContent: "Folder for what you bring" }), name),
    uploader({ label: "Bring photographs", accept: "image/*,video/*", nameOf: (file) => `${name.value.trim()}/${file.name}`, done: () => { form.set(photos, name.value.trim()); look(); } }));
  const sight = sightCard(step, form.read, (folder) => { form.set(photos, folder); look(); });
  const missing = make("section", { className: "card" }), verdict = make("div", {}), gallery = make("div", { className: "gallery" });
  page.append(make("h1", { textContent: "Calibrate" }), make("div", { className: "choice" }, tabs), note(words),
    make("section", { className: "card" }, form, bring), sight.element, missing, verdict, gallery);

  let isGone = false, timer = 0, asked = 0;
  async function look() {
    clearTimeout(timer);
    const { wide, high, count, [photos]: folder, ...given } = form.read(), { rig } = given;
    if (isGone) return;
    const mine = ++asked;
    if (folder) {
      try {
        const seen = await ask(question("api/boards", { ...given, step, folder, board: `${wide}x${high}` }));
        if (mine !== asked || isGone) return;
        keep(missing, [seen.so_far, seen.fault, seen.count, seen.photos.length, count], () => missingOf(seen, Number(count), step));
        keep(gallery, seen.photos, () => seen.photos.map(photo));
      } catch (error) {
        keep(missing, error.message, () => note(error.message, "warning"));
      }
    }
    missing.hidden = !folder;
    timer = setTimeout(look, 1500);
    if (studio.state?.found.rigs.includes(rig)) showVerdict(rig);
    else keep(verdict, "", () => null);
  }
  async function showVerdict(rig) {
    try {
      const told = await ask(question("api/rig", { name: rig }));
      const mine = told.steps.filter((one) => one.step.split(" ")[0] === step && one.is_calibrated);
      keep(verdict, mine, () => mine.map(card));
    } catch {
      keep(verdict, "", () => null);
    }
  }

  let last = "";
  const stop = listen((state) => {
    const { photos: folders, rigs, logs } = state.found;
    const key = JSON.stringify([folders, rigs, logs]);
    sight.sync(state);
    if (key === last) return;
    fill(form.input(photos), folders);
    if (step !== "camera") fill(form.input("rig"), rigs);
    else if (rigs.length && !last) form.offer("rig", rigs[0]);
    if (step === "mount") fill(form.input("poses"), logs);
    last = key;
    form.write();
    look();
  });
  return () => { isGone = true; clearTimeout(timer); stop(); sight.end(); };
}

function missingOf({ is_folder: isFolder, so_far: told, fault, count, photos }, wanted, step) {
  const title = make("h2", {}, "What the photographs tell so far");
  if (!isFolder) return [title, note("A video: about a hundred of its pictures are looked at when it is calibrated on.")];
  const looked = photos.length, found = photos.filter((one) => !one.reason).length;
  const bars = [
    bar("boards found", found, Math.max(wanted, 1), `${found} of ${wanted}`),
    looked < count ? bar("photographs looked at", looked, count, `${looked} of ${count}`) : null,
  ];
  if (fault) return [title, ...bars, note(fault, "warning")];
  if (!told && found) return [title, ...bars, note("Working out what they tell …")];
  if (!told) return [title, ...bars, note(looked < count ? "Looking for the board …" : "The board is in none of them: count its inner corners, where black squares touch.", looked < count ? "" : "warning")];
  const judged = told.precisions.filter((one) => one.share !== null), others = told.precisions.filter((one) => one.share === null);
  return [title, ...bars, ...judged.map(precision),
    others.length ? note(`Known by now (1σ): ${others.map((one) => `${one.what} ± ${one.said}`).join("; ")}.`, "muted") : null,
    make("div", { className: "so-far" }, map(told.cells), make("div", { className: "form" },
    note(told.verdict, told.is_good ? "good" : "warning"),
    step === "check" ? null : told.missing.length ? make("div", {}, make("h3", { textContent: "Still to show" }), make("ul", { className: "todo" }, told.missing.map((text) => make("li", { textContent: text })))) : told.precisions.length ? note("Nothing is missing.", "good") : null))];
}

// Half full is good enough; each half is a factor of ten.
const precision = ({ what, said, share }) => bar(what, Math.max(0, 1 - Math.log10(share)), 2, `± ${said} (1σ${share <= 1 ? ", good" : ""})`);

const bar = (name, value, max, text) => make("div", { className: "progress named" }, make("b", { textContent: name }), make("progress", { max, value: Math.min(value, max) }), make("span", { textContent: text }));

// The picture in ten by ten cells: in which of them a corner has been.
function map(cells) {
  const squares = cells.flatMap((row, y) => row.map((is, x) => draw("rect", { x: x + 0.05, y: y + 0.05, width: 0.9, height: 0.9, class: is ? "seen" : "unseen" })));
  return make("figure", { className: "cells" }, draw("svg", { viewBox: "0 0 10 10", role: "img", "aria-label": "Where in the picture corners were" }, squares),
    make("figcaption", { textContent: "where in the picture corners were" }));
}

function photo({ name, file, size: [width, height], corners, reason }) {
  const radius = width / 110;
  return make("figure", { className: reason ? "unused" : "" }, make("a", { className: "photo", href: addressOf(file), target: "_blank" },
    make("img", { src: addressOf(file), alt: name, loading: "lazy" }),
    width ? draw("svg", { viewBox: `0 0 ${width} ${height}` },
      draw("polyline", { points: corners.map((at) => at.join(",")).join(" "), "stroke-width": radius / 3 }),
      corners.map(([u, v]) => draw("circle", { cx: u, cy: v, r: radius }))) : null),
  make("figcaption", { textContent: reason ? `${name} is not used: ${reason}` : name }));
}
