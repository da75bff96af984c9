// A distance between two measured points, and how far it may be off.

import { pointOf } from "./model.js";
import { scatterAround } from "./scatter.js";
import { dot, minus, norm, unit } from "./vectors.js";

const AT_95 = 1.96;

// Lengths in metres. `off` is half of the 95 % interval: from the sigma of both points, or from the
// scatter around them where that is larger, and from the page's rounding; null where the scan
// states no sigma. `shared` is the larger of what the points share.
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
  const shared = [first, second].map((i) => valueOf(model, "sigma common", i) / 1e3 || 0);
  return {
    length: norm(step),
    step,
    off: isKnown ? AT_95 * Math.sqrt(variance) : null,
    shared: Math.max(...shared),
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
