// How the errors of rig and motion stretch a distance: what shift_field.py has fitted, at two points,
// and what the poses are off by.

import { cross, dot, minus } from "./vectors.js";

// Standard deviation of a distance from what its ends share [m]; null where nothing is stated.
export function stretchOf(model, ends, profiles, along) {
  const { shifts, path, attitudes, poseErrors } = model;
  if (!(shifts || poseErrors) || !path.length) return null;
  const [first, second] = ends.map((place, end) => {
    const [profile, camera] = [profiles[end], path[profiles[end]]];
    return [
      ...(shifts ? shiftsAt(shifts, place, camera, attitudes[profile]) : []),
      ...(poseErrors ? movesAt(poseErrors, profile, minus(place, camera)) : []),
    ];
  });
  return Math.hypot(...first.map((shift, error) => dot(along, minus(second[error], shift))));
}

// How each error of the poses moves a point at the end of an arm from the camera [m].
function movesAt({ profiles, modes, columns }, profile, arm) {
  const after = profiles.findIndex((knot) => knot >= profile);
  const before = Math.max(after - 1, 0);
  const share = after > before
    ? (profile - profiles[before]) / (profiles[after] - profiles[before]) : 0;
  const errors = Array.from({ length: modes }, () => [0, 0, 0, 0, 0, 0]);
  for (const [mode, axis, values] of columns) {
    errors[mode][axis] = values[before] + share * (values[after] - values[before]);
  }
  return errors.map((error) => {
    const turned = cross(error.slice(3), arm);
    return turned.map((part, axis) => part + error[axis]);
  });
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
