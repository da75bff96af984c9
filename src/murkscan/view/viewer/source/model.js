// One scan as arrays: what is drawn, and what is measured on.

import { takeText, unpack } from "./unpack.js";

const NO_CODE = 65535;
// A place of the picture as the world has it [m].
export const worldPlace = (model, place) => place.map((x, axis) => x + model.centre[axis]);

export const NO_VALUE = -1e30; // a shader cannot be trusted with NaN

export async function loadModel(about, number, centre) {
  const blob = (name, count, columns, width) =>
    unpack(takeText(`blob-${number}-${name}`), count, columns, width);
  const count = about.vertices;
  const model = { ...about, number, centre, grid: about.positions };
  const { low, step, bytes } = about.positions;
  model.positions = interleave(await blob("positions", count, 3, bytes), (code, axis) =>
    low[axis] - centre[axis] + code * step);
  // A smoothed surface passes its points by: its corners lie elsewhere than what is measured on.
  model.surface = about.moves === null ? model.positions
    : moved(model.positions, await blob("moves", count, 3, bytes + 1), about.moves, step);
  model.normals = directions(await blob("normals", count, 2, 2));
  model.faces = interleaveWhole(await blob("faces", about.faces, 3, 4));
  model.moments = (await blob("moments", count, 1, 4))[0];
  model.values = {};
  for (const layer of about.layers) {
    model.values[layer.name] = layer.blob
      ? decode((await blob(layer.blob, count, 1, 2))[0], layer)
      : depths(model, about.views.front[2], layer.start);
  }
  model.starts = startsOf(model.moments, about.measured, about.times.length);
  model.path = about.path.map((p) => p.map((x, axis) => x + low[axis] - centre[axis]));
  model.box = boxOf(model.positions);
  return model;
}

function interleave(columns, value) {
  const count = columns[0].length;
  const rows = new Float32Array(3 * count);
  for (let axis = 0; axis < 3; axis++) {
    const codes = columns[axis];
    for (let i = 0; i < count; i++) rows[3 * i + axis] = value(codes[i], axis);
  }
  return rows;
}

function moved(positions, columns, least, step) {
  const rows = new Float32Array(positions.length);
  columns.forEach((steps, axis) => {
    for (let i = 0, p = axis; i < steps.length; i++, p += 3) {
      rows[p] = positions[p] + (least + steps[i]) * step;
    }
  });
  return rows;
}

function interleaveWhole(columns) {
  const rows = new Uint32Array(3 * columns[0].length);
  columns.forEach((codes, axis) => {
    for (let i = 0; i < codes.length; i++) rows[3 * i + axis] = codes[i];
  });
  return rows;
}

// Folds the octahedron of packing.py up again.
function directions([us, vs]) {
  const rows = new Int16Array(4 * us.length); // a fourth number aligns them for the chip
  for (let i = 0; i < us.length; i++) {
    let x = us[i] / 511 - 1;
    let y = vs[i] / 511 - 1;
    const z = 1 - Math.abs(x) - Math.abs(y);
    if (z < 0) {
      const [flatX, flatY] = [x, y];
      x = (1 - Math.abs(flatY)) * (flatX < 0 ? -1 : 1);
      y = (1 - Math.abs(flatX)) * (flatY < 0 ? -1 : 1);
    }
    const scale = 32767 / Math.hypot(x, y, z);
    rows[4 * i] = x * scale;
    rows[4 * i + 1] = y * scale;
    rows[4 * i + 2] = z * scale;
  }
  return rows;
}

function decode(codes, { low, step }) {
  const values = new Float32Array(codes.length);
  for (let i = 0; i < codes.length; i++) {
    values[i] = codes[i] === NO_CODE ? NO_VALUE : low + codes[i] * step;
  }
  return values;
}

// Along the front view, counted from where the camera was on average [mm].
function depths({ positions, centre }, [x, y, z], start) {
  const values = new Float32Array(positions.length / 3);
  const offset = x * centre[0] + y * centre[1] + z * centre[2] - start;
  for (let i = 0; i < values.length; i++) {
    const p = 3 * i;
    values[i] = 1e3 * (x * positions[p] + y * positions[p + 1] + z * positions[p + 2] + offset);
  }
  return values;
}

// The measured points lie in order of time: profile k has those from starts[k] to starts[k + 1].
function startsOf(moments, measured, profiles) {
  const starts = new Uint32Array(profiles + 1);
  for (let i = 0; i < measured; i++) starts[moments[i] + 1]++;
  for (let k = 0; k < profiles; k++) starts[k + 1] += starts[k];
  return starts;
}

function boxOf(positions) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i++) {
    const axis = i % 3;
    if (positions[i] < low[axis]) low[axis] = positions[i];
    if (positions[i] > high[axis]) high[axis] = positions[i];
  }
  return { low, high };
}

export const pointOf = (model, i) => Array.from(model.positions.subarray(3 * i, 3 * i + 3));
