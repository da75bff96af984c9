// Clicks and taps on the model: to measure, to read a point, to turn about it.

import { tellPlace } from "./command.js";
import { NO_VALUE, pointOf, worldPlace } from "./model.js";
import { place, valueText } from "./numbers.js";
import { pick } from "./pick.js";
import { placeWords } from "./place.js";
import { wordFor } from "./words.js";

const STILL = 6; // px that a click may move
const NEAR = { mouse: 12, pen: 14, touch: 24 };

export function startPointer(app) {
  const { canvas } = app.stage;
  let down = null;
  canvas.addEventListener("pointerdown", (event) => {
    down = event.isPrimary ? event : null;
    canvas.classList.add("pointed"); // no ring round what a hand already holds
  });
  canvas.addEventListener("blur", () => canvas.classList.remove("pointed"));
  canvas.addEventListener("pointerup", (event) => {
    const is = down && event.button === 0
      && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < STILL;
    down = null;
    if (is) click(app, find(app, event));
  });
  let waiting = false;
  canvas.addEventListener("pointermove", (event) => {
    if (!(app.state.measuring || app.state.picking) || event.buttons || waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      const snapped = find(app, event);
      if (snapped !== app.state.snapped) app.update({ snapped });
    });
  });
  canvas.addEventListener("dblclick", (event) => {
    const found = find(app, event);
    if (found !== null && !app.state.measuring && !app.state.picking) app.stage.centreOn(pointOf(app.model, found));
  });
}

function find(app, event) {
  const { left, top } = app.stage.canvas.getBoundingClientRect();
  return pick(app, event.clientX - left, event.clientY - top, NEAR[event.pointerType] ?? NEAR.mouse);
}

function click(app, found) {
  const { measuring, first, picking, picks, scan } = app.state;
  if (picking) {
    if (found === null || picks.some((one) => one.scan === scan && one.point === found)) return undefined;
    return app.update({ picks: [...picks, { scan, point: found, cells: {} }] });
  }
  if (!measuring) {
    if (found !== null) tellPlace(worldPlace(app.model, pointOf(app.model, found)));
    return app.update({ read: found });
  }
  if (found === null || found === first) return undefined;
  if (first === null) return app.update({ first: found });
  return app.measure(first, found);
}

// Everything that is known of a point.
export function showReading(app) {
  const element = document.getElementById("reading");
  const { read } = app.state;
  element.hidden = read === null;
  if (read === null) return;
  const { model } = app;
  const world = worldPlace(model, pointOf(model, read));
  const places = world.map((x, k) => `${"xyz"[k]} ${place(x)}`);
  const known = model.layers.filter(({ name }) => model.values[name][read] !== NO_VALUE)
    .map(({ name, unit }) => `${wordFor(name)} ${valueText(model.values[name][read], unit)}`);
  element.textContent = [...placeWords(model, world), ...places, ...known, `profile ${model.moments[read] + 1}`].join("  ·  ");
}
