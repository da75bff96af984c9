// How the rig's own errors stretch a distance: what shift_field.py has fitted, at two points.

import { dot, minus } from "./vectors.js";

// Standard deviation of a distance from what its ends share [m]; null where the rig states nothing.
export function stretchOf(model, ends, profiles, along) {
  const { shifts, path, attitudes } = model;
  if (!shifts || !path.length) return null;
  const [first, second] = ends.map((place, end) =>
    shiftsAt(shifts, place, path[profiles[end]], attitudes[profiles[end]]));
  return Math.hypot(...first.map((shift, error) => dot(along, minus(second[error], shift))));
}

// One triple an error, in the world [m].
function shiftsAt({ centre, scale, powers, coefficients }, place, camera, [w, x, y, z]) {
  const inCamera = rotate([w, -x, -y, -z], minus(place, camera));
  const at = inCamera.map((value, axis) => (value - centre[axis]) / scale);
  const errors = coefficients[0][0].map(() => [0, 0, 0]);
  powers.forEach(([i, j, k], term) => {
    const value = at[0] ** i * at[1] ** j * at[2] ** k;
    errors.forEach((shift, error) => {
      for (let axis = 0; axis < 3; axis++) shift[axis] += value * coefficients[term][axis][error];
    });
  });
  return errors.map((shift) => rotate([w, x, y, z], shift));
}

function rotate([w, x, y, z], [a, b, c]) {
  const [s, t, u] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * s + y * u - z * t, b + w * t + z * s - x * u, c + w * u + x * t - y * s];
}
