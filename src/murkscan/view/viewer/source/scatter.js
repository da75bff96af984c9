// How much the points around a place scatter: the stated sigma knows neither speckle nor a finder's
// slips. The same as `noise_at` of the measure stage, without its leaving out of points.

const NEIGHBOURS = 40;
const REACH = 6; // usual spacings within which they are looked for

// The standard deviation of the nearest points about their plane [m]; 0 for too few of them.
export function scatterAround({ positions, measured, spacing }, i) {
  const place = positions.subarray(3 * i, 3 * i + 3);
  const most = (REACH * spacing) ** 2;
  const found = [];
  for (let p = 0; p < 3 * measured; p += 3) {
    const off = (positions[p] - place[0]) ** 2 + (positions[p + 1] - place[1]) ** 2
      + (positions[p + 2] - place[2]) ** 2;
    if (off < most) found.push({ p, off });
  }
  found.sort((a, b) => a.off - b.off);
  const near = found.slice(0, NEIGHBOURS).map(({ p }) =>
    [0, 1, 2].map((axis) => positions[p + axis] - place[axis]));
  return near.length < 4 ? 0 : Math.sqrt(Math.max(leastVariance(near), 0));
}

// The smallest eigenvalue of the points' covariance, by the roots of its cubic.
function leastVariance(points) {
  const mean = [0, 1, 2].map((axis) => points.reduce((sum, p) => sum + p[axis], 0) / points.length);
  const of = (a, b) => points.reduce(
    (sum, p) => sum + (p[a] - mean[a]) * (p[b] - mean[b]), 0) / points.length;
  const [xx, yy, zz, xy, xz, yz] = [of(0, 0), of(1, 1), of(2, 2), of(0, 1), of(0, 2), of(1, 2)];
  const third = (xx + yy + zz) / 3;
  const [a, b, c] = [xx - third, yy - third, zz - third];
  const size = Math.sqrt((a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6);
  if (size === 0) return third;
  const determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
  const angle = Math.acos(Math.min(Math.max(determinant / (2 * size ** 3), -1), 1)) / 3;
  return third + 2 * size * Math.cos(angle + (2 * Math.PI) / 3);
}
