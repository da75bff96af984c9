// Where a plane meets a model: pieces of line through its triangles, or the points beside it.

import { cross, dot, minus, unit } from "./vectors.js";

// The planes on offer, in the axes of the front view: normal, and what lies right and down in the
// drawing of the section, with the words for them.
export function planeAxes(views, along) {
  const [right, down, away] = views.front;
  const planes = {
    across: { label: "left to right", normal: right, u: away, v: down, words: ["far", "down"] },
    level: { label: "top to bottom", normal: down, u: right, v: away, words: ["right", "far"] },
    deep: { label: "near to far", normal: away, u: right, v: down, words: ["right", "down"] },
  };
  if (along) planes.measured = { label: "through the last distance", ...along };
  return planes;
}

// The plane that holds both ends of a distance and the line of sight.
export function planeThrough(a, b, sight) {
  const u = unit(minus(b, a));
  const normal = unit(cross(sight, u));
  const v = unit(cross(normal, u));
  return { normal, u, v, at: dot(normal, a), words: ["first to second point", "along the sight"] };
}

export function extentAlong({ positions }, [x, y, z]) {
  let [low, high] = [Infinity, -Infinity];
  for (let p = 0; p < positions.length; p += 3) {
    const at = x * positions[p] + y * positions[p + 1] + z * positions[p + 2];
    if (at < low) low = at;
    if (at > high) high = at;
  }
  return [low, high];
}

// Pieces of line, six numbers each: both ends [m].
export function meetTriangles({ surface, faces }, normal, offset) {
  const sides = sidesOf(surface, normal, offset);
  const found = [];
  for (let f = 0; f < faces.length; f += 3) {
    const corners = [faces[f], faces[f + 1], faces[f + 2]];
    const above = (sides[corners[0]] > 0) + (sides[corners[1]] > 0) + (sides[corners[2]] > 0);
    if (above === 0 || above === 3) continue;
    for (let k = 0; k < 3; k++) {
      const [i, j] = [corners[k], corners[(k + 1) % 3]];
      if (sides[i] > 0 === sides[j] > 0) continue;
      const share = sides[i] / (sides[i] - sides[j]);
      for (let axis = 0; axis < 3; axis++) {
        const start = surface[3 * i + axis];
        found.push(start + share * (surface[3 * j + axis] - start));
      }
    }
  }
  return Float32Array.from(found);
}

// Points within half the usual spacing of the plane, three numbers each [m].
export function meetPoints({ positions, measured, spacing }, normal, offset) {
  const sides = sidesOf(positions, normal, offset);
  const found = [];
  for (let i = 0; i < measured; i++) {
    if (Math.abs(sides[i]) < spacing / 2) found.push(...positions.subarray(3 * i, 3 * i + 3));
  }
  return Float32Array.from(found);
}

function sidesOf(positions, [x, y, z], offset) {
  const sides = new Float32Array(positions.length / 3);
  for (let i = 0, p = 0; i < sides.length; i++, p += 3) {
    sides[i] = x * positions[p] + y * positions[p + 1] + z * positions[p + 2] - offset;
  }
  return sides;
}
