// A distance between two measured points, and how far it may be off.

import { pointOf } from "./model.js";
import { scatterAround } from "./scatter.js";
import { stretchOf } from "./shared_errors.js";
import { dot, minus, norm, unit } from "./vectors.js";

const AT_95 = 1.96;

// Lengths in metres. `off` is half of the 95 % interval: from the sigma of both points, or from the
// scatter around them where that is larger, from the page's rounding, and from what the rig's own
// errors do to this distance; null where the scan states no sigma. `shared` is the rig's part of it,
// null where the rig states none.
export function distance(model, first, second) {
  const [a, b] = [pointOf(model, first), pointOf(model, second)];
  const step = minus(b, a);
  const along = unit(step);
  const stated = [first, second].map((i) => valueOf(model, "sigma", i) / 1e3);
  const isKnown = stated.every((sigma) => sigma > 0);
  const sigmas = isKnown
    ? [first, second].map((i, end) => Math.max(stated[end], scatterAround(model, i))) : stated;
  let variance = rounding(model);
  [first, second].forEach((i, end) => {
    variance += (sigmas[end] * share(model, i, [a, b][end], along)) ** 2;
  });
  const shared = stretchOf(model, [a, b], [first, second].map((i) => model.moments[i]), along);
  variance += (shared ?? 0) ** 2;
  return {
    length: norm(step),
    step,
    off: isKnown ? AT_95 * Math.sqrt(variance) : null,
    shared: shared === null ? null : AT_95 * shared,
  };
}

// Two roundings, each even over one step of the grid, along one direction.
function rounding({ grid }) {
  return (2 * grid.step ** 2) / 12;
}

function valueOf(model, name, i) {
  return model.values[name]?.[i] ?? NaN;
}

// Sigma is along the ray from the camera: how much of it lies along the distance.
function share(model, i, place, along) {
  const camera = model.path[model.moments[i]];
  return camera ? Math.abs(dot(unit(minus(place, camera)), along)) : 1;
}
