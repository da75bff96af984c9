// Where the camera went, and the profiles as they came in.

import { make, setPressed } from "./dom.js";

const WHOLE = 12; // seconds that playing takes

export function pathTool(app) {
  const play = make("button", { type: "button", title: "Key P", onclick: () => app.play(!app.state.playing) });
  const path = make("button", {
    type: "button", textContent: "Camera path", onclick: () => app.update({ path: !app.state.path }),
  });
  const slider = make("input", {
    type: "range", min: 0, step: 1, "aria-label": "Profiles shown",
    oninput: () => app.update({ playing: false, profile: atEnd(app, Number(slider.value)) }),
  });
  const readout = make("output");
  const lone = make("p", { className: "note", textContent: "There is one profile only: nothing to play." });
  const element = make("div", {}, make("div", { className: "row" }, play, path), slider, readout, lone);

  function sync() {
    const { times, timed } = app.model;
    const last = times.length - 1;
    const at = Math.min(Math.floor(app.state.profile), last);
    play.textContent = app.state.playing ? "Pause" : "Play";
    setPressed(play, app.state.playing);
    setPressed(path, app.state.path);
    path.hidden = app.model.path.length === 0;
    play.hidden = slider.hidden = readout.hidden = last === 0;
    lone.hidden = last > 0;
    slider.max = last;
    slider.value = at;
    readout.textContent = `profile ${at + 1} of ${last + 1}${
      timed ? ` · ${(times[at] - times[0]).toFixed(2)} s` : ""}`;
  }
  return { name: "path", title: "Path and time", element, sync };
}

export const atEnd = (app, at) => (at >= app.model.times.length - 1 ? Infinity : at);

// Moves time on while the app plays, at an even pace; the page rests when it is done.
export function startPlaying(app) {
  const { times } = app.model;
  const span = times.at(-1) - times[0];
  let since = null;
  let at = Number.isFinite(app.state.profile) ? times[app.state.profile] : times[0];
  function tick(now) {
    if (!app.state.playing) return;
    at += since === null ? 0 : ((now - since) / 1e3) * (span / WHOLE);
    since = now;
    const next = times.findLastIndex((time) => time <= at);
    const isDone = next >= times.length - 1;
    app.update({ profile: isDone ? Infinity : next, playing: !isDone });
    app.stage.move();
    if (!isDone) requestAnimationFrame(tick);
  }
  requestAnimationFrame(tick);
}
