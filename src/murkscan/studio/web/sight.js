// Photographs by a live picture: the corners drawn over it, taken by a click or by themselves.

import { addressOf, ask, order, question } from "./ask.js";
import { button, draw, make, note } from "./dom.js";
import { commandForm } from "./form.js";

// `board` gives what the page has of the board; `taken` is told of the folder when a photo comes.
export function sightCard(step, board, taken) {
  const form = commandForm({
    page: "sight", command: "calibrate photograph", run: "Begin",
    fields: [
      { key: "source", label: "Camera", placeholder: "rtsp://…", list: [], required: true, hint: "a stream (rtsp://…, udp://…, an SDP file), or the number of a camera here" },
      { key: "folder", label: "Folder for the photographs", value: `boards-${step}` }],
  });
  form.also = () => { const { wide, high, count } = board(); return { board: `${wide}x${high}`, boards: count }; };
  const picture = make("img", { alt: "What the camera sees" }), over = draw("svg", {});
  const said = note(""), take = button("Take a photograph", click, { className: "large main" });
  const seen = make("div", { className: "sight" }, make("div", { className: "photo" }, picture, over), make("div", { className: "form" }, said, take));
  const element = make("details", { className: "card" }, make("summary", { textContent: "Take photographs by a live picture" }), form, seen);
  seen.hidden = true;
  let running = null, isGone = false, timer = 0, before = 0, isLoading = false;

  async function look() {
    clearTimeout(timer);
    if (running && !document.hidden) {
      try { show(await ask(question("api/sight", { folder: running.out }))); } catch { /* told by the banner */ }
    }
    if (!isGone) timer = setTimeout(look, running ? 300 : 1500);
  }

  async function show({ status, picture: file }) {
    seen.hidden = !status;
    if (!status || !file || isLoading) return;
    isLoading = true;
    const fresh = new Image();
    fresh.src = addressOf(file);
    try { await fresh.decode(); picture.src = fresh.src; } catch { /* it was just replaced */ }
    isLoading = false;
    const [width, height] = status.size, radius = width / 130;
    over.setAttribute("viewBox", `0 0 ${width} ${height}`);
    over.replaceChildren(draw("polyline", { points: status.corners_px.map((at) => at.join(",")).join(" "), "stroke-width": radius / 3 }),
      ...status.corners_px.map(([u, v]) => draw("circle", { cx: u, cy: v, r: radius })));
    said.textContent = `${status.taken} of ${status.wanted}: ${status.message}`;
    said.className = `note ${status.message === "taken" ? "good" : ""}`;
    if (status.taken !== before) { before = status.taken; taken(running?.out); }
  }

  async function click() {
    if (running) await order(question("api/sight/take", { folder: running.out }), {});
  }

  look();
  return {
    element,
    write: form.write,
    sync(state) {
      const now = state.jobs.find((job) => job.page === "sight" && job.state === "running") ?? null;
      if (now && !running) { element.open = true; before = 0; }
      if (running && !now) { taken(running.out); seen.hidden = true; }
      running = now;
      form.hidden = Boolean(running);
    },
    end() { isGone = true; clearTimeout(timer); },
  };
}
