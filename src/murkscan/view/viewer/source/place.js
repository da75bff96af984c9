// Where a point lies on the Earth or on a ship, of a scan that was laid on control points.

const ON_CENTRELINE = 5e-4; // m: on neither side

// Easting, northing and height, or aft, to starboard and up [m].
function placed({ rotation, translation, scale, origin }, world) {
  const ground = rotation.map((row, axis) =>
    row.reduce((sum, x, k) => sum + x * world[k], translation[axis]));
  return ground.map((x, axis) => origin[axis] + x * (axis < 2 ? scale : 1));
}

// Words for a place of the world [m]; none where nobody has said where it lies.
export function placeWords({ place }, world) {
  if (!place) return [];
  const [first, second, up] = placed(place, world);
  if (!place.hull) {
    return [`easting ${first.toFixed(3)}`, `northing ${second.toFixed(3)}`, `height ${up.toFixed(3)} m`];
  }
  const { spacing, framesFrom, heightsAbove } = place.hull;
  const station = spacing === null ? `${first.toFixed(3)} m from the bow`
    : `frame ${((framesFrom === "bow" ? first : -first) / spacing).toFixed(2)}`;
  const side = Math.abs(second) < ON_CENTRELINE ? "on the centreline"
    : `${Math.abs(second).toFixed(3)} m to ${second > 0 ? "starboard" : "port"}`;
  return [station, `${up.toFixed(3)} m above the ${heightsAbove}`, side];
}
