// A dive while it goes on: picture with the stripe, model growing, gaps, gauges, warnings, large buttons.

import { addressOf, ask, listen, order, question, refresh, studio } from "./ask.js";
import { button, keep, make, note } from "./dom.js";
import { commandForm, fill, freeName } from "./form.js";
import { gapMap } from "./gap_map.js";
import { clock, otherGauges, steeringGauges, warningsOf } from "./gauges.js";
import { motionFields, motionOf, showMotion } from "./motion.js";
import { pointView } from "./points.js";

const STATES = { waiting: "waiting for the stream", learning: "learning the picture", live: "live", lost: "stream lost", scanning: "scanning", done: "done", failed: "failed" };
const STALE = 4;

export function livePage(page) {
  const head = make("div", { className: "dive" }), alarms = make("div", { className: "alarms", role: "alert" });
  const picture = make("img", { alt: "The newest picture", className: "picture" });
  const canvas = make("canvas", { className: "cloud" });
  const map = gapMap(), dials = make("div", { className: "gauges" }), others = make("div", { className: "gauges" });
  const pictureTile = make("figure", { className: "tile" }, make("figcaption", { textContent: "Picture, with the stripe as it is found" }), make("div", { className: "held" }, picture));
  const model = make("figure", { className: "tile" }, make("figcaption", { textContent: "Model: a preview, and no part of the scan; a drag turns it" }), make("div", { className: "held" }, canvas));
  const scene = make("div", { className: "scene" }, pictureTile, model, map.element);
  const end = button("End the dive", stop, { className: "large stop" });
  const dive = make("select", { "aria-label": "Dive" });
  const start = startForm();
  const keys = make("small", { className: "muted keys", textContent: "Keys: S picture or stripe · F whole screen · E end the dive (twice)" });
  page.append(make("div", { className: "lead" }, head, make("div", { className: "row ending" }, keys, end)), alarms, dials, scene, others, start.element,
    make("div", { className: "toolbar" }, make("label", {}, make("span", { textContent: "Show the dive" }), dive)));

  let isGone = false, shown = "", next = 0, mapped = "", timer = 0, isPlain = false, running = null, isLoading = false;
  const cloud = pointView(canvas);
  if (!cloud) canvas.replaceWith(note("This browser has no WebGL 2: the model is not drawn; pictures, gaps and gauges are.", "warning"));

  async function look() {
    clearTimeout(timer);
    const name = dive.value;
    if (name && !isGone && !document.hidden) {
      if (name !== shown) { shown = name; next = 0; mapped = ""; cloud?.clear(); map.clear(); picture.removeAttribute("src"); delete picture.dataset.shown; }
      try { await show(name); } catch { /* the banner says that the studio is gone */ }
    }
    if (!isGone) timer = setTimeout(look, running ? 250 : 1500);
  }

  async function show(name) {
    const told = await ask(question("api/dive", { name }));
    const { status } = told;
    // Of a dive that never came to a picture there is nothing to show but why.
    const isEmpty = !status || (status.state === "failed" && !status.recorded.pictures);
    for (const part of [scene, dials, others, alarms]) part.hidden = isEmpty;
    if (!status || isGone) return;
    const isStale = Date.now() / 1e3 - status.updated_s > STALE;
    const isOver = ["done", "failed"].includes(status.state);
    keep(head, [status.state, status.message, isStale, Math.floor(status.recorded.time_s), status.scan], () => headOf(status, isStale && !isOver, name));
    for (const part of [dials, others]) part.classList.toggle("over", isOver);
    keep(alarms, [status.warnings, isStale], () => (isStale ? [] : warningsOf(status)));
    keep(dials, [status.stand_off, status.speed, status.stripe, status.coverage], () => steeringGauges(status));
    keep(others, [status.water, status.preview, Math.floor(status.recorded.time_s), status.disk.state], () => otherGauges(status));
    const image = isPlain ? told.picture : told.stripe ?? told.picture;
    if (image && picture.dataset.shown !== image && !isLoading) load(image);
    if (told.gaps && told.gaps !== mapped) { mapped = told.gaps; map.show(addressOf(told.gaps), told.map).catch(() => { mapped = ""; }); }
    if (cloud && told.parts > next) await grow(name);
  }

  // A picture is swapped when it is whole, so that it never flickers.
  async function load(image) {
    isLoading = true;
    const fresh = new Image();
    fresh.src = addressOf(image);
    try {
      await fresh.decode();
      picture.src = fresh.src;
      picture.dataset.shown = image;
    } catch { /* it was just replaced: the next one comes */ }
    isLoading = false;
  }

  async function grow(name) {
    const answer = await fetch(question("api/points", { name, first: next }), { cache: "no-store" });
    if (!answer.ok || name !== shown) return;
    cloud.add(new Float32Array(await answer.arrayBuffer()));
    next = Number(answer.headers.get("x-next"));
  }

  let sure = 0;
  async function stop() {
    if (!running) return;
    if (Date.now() - sure > 4000) {
      sure = Date.now();
      end.textContent = "Really end it? Once more";
      setTimeout(() => { end.textContent = "End the dive"; }, 4000);
      return;
    }
    sure = 0;
    await order(`api/jobs/${running.name}/stop`, {});
    refresh();
  }

  function key(event) {
    if (event.target.matches("input, select, textarea") || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "s") { isPlain = !isPlain; pictureTile.firstChild.textContent = isPlain ? "Picture as it comes" : "Picture, with the stripe as it is found"; }
    if (event.key === "f") { if (document.fullscreenElement) document.exitFullscreen(); else document.documentElement.requestFullscreen(); }
    if (event.key === "e") stop();
  }
  addEventListener("keydown", key);

  const leave = listen((state) => {
    running = state.jobs.find((job) => job.page === "live" && job.state === "running") ?? null;
    const isScanning = running?.progress != null;
    end.textContent = sure && Date.now() - sure < 4000 ? end.textContent : isScanning ? "Stop the scan" : "End the dive";
    end.hidden = keys.hidden = !running;
    start.element.hidden = Boolean(running);
    const dives = [...new Set([...(running ? [running.out] : []), ...state.found.dives])];
    fill(dive, dives, running ? running.out : dive.value);
    dive.closest("div").hidden = dives.length < 2 || Boolean(running);
    for (const part of [scene, dials, others, alarms]) if (!dives.length) part.hidden = true;
    if (!dives.length) keep(head, "none", () => make("h1", { textContent: "Record and scan live" }));
    start.sync(state);
  });
  look();
  return () => { isGone = true; clearTimeout(timer); leave(); removeEventListener("keydown", key); cloud?.end(); };
}

function headOf(status, isStale, name) {
  const scan = status.scan;
  const left = scan?.time_left_s == null ? "" : `, ${clock(scan.time_left_s)} left`;
  return [
    make("h1", {}, "Dive ", make("span", { textContent: name })),
    make("span", { className: `badge big ${isStale || ["lost", "failed"].includes(status.state) ? "bad" : "good"}`, textContent: isStale ? "no word" : STATES[status.state] ?? status.state }),
    make("span", { className: "clock", textContent: clock(status.recorded.time_s) }),
    note(isStale ? "The dive’s process does not answer. What it recorded is safe up to the last second; begin it again with the same folder, and it goes on." : `${status.message}${scan ? ` (${scan.stage}${left})` : ""}`, isStale ? "alarm" : ""),
    status.state === "done" ? make("a", { className: "button", href: `#look/${encodeURIComponent(name)}`, textContent: "Look at the scan" }) : null,
  ];
}

function startForm() {
  const form = commandForm({
    page: "live", command: "live", run: "Record and scan live",
    fields: [
      { key: "source", label: "Source", placeholder: "rtsp://…", list: [], required: true, hint: "a stream (rtsp://…, udp://…, an SDP file), a camera’s number, or a recording to replay" },
      { key: "rig", label: "Rig", kind: "select", required: true },
      ...motionFields(true),
      { key: "spacing-mm", label: "Wanted spacing", unit: "mm", kind: "number", value: 5 },
      { key: "out", label: "Folder for the dive", value: "dive", required: true },
      { key: "extractor", label: "How the stripe is found", kind: "select", options: [["", "murk"], "gray-gravity"], hint: "gray-gravity is quicker, for clear water", more: true },
      { key: "laser", label: "Number of the laser", hint: "all of them unless given", more: true },
    ],
    onchange: ({ how }) => showMotion(form, how),
  });
  form.also = motionOf;
  showMotion(form, "speed-mm-s");
  form.classList.add("wet");
  let last = "";
  return {
    element: make("section", { className: "card" }, make("h2", { textContent: "A new dive" }), form),
    sync({ found: { rigs, recordings, logs, scans, dives } }) {
      const key = JSON.stringify([rigs, recordings, logs, scans, dives]);
      if (key === last) return;
      last = key;
      fill(form.input("rig"), rigs);
      form.offer("out", freeName("dive", [...scans, ...dives]));
      form.suggest("source", recordings);
      form.suggest("log", logs);
      form.write();
    },
  };
}
