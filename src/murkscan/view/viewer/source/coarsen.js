// Fewer triangles: the vertices in each cell of a cubic grid become the first of them, and triangles
// that lose a side are left out (Rossignac and Borrel 1993). The same as `cluster_vertices`.

export function coarsen(places, faces, cell) {
  const owner = owners(places, cell);
  const kept = new Uint32Array(faces.length);
  let count = 0;
  for (let f = 0; f < faces.length; f += 3) {
    const [a, b, c] = [owner[faces[f]], owner[faces[f + 1]], owner[faces[f + 2]]];
    if (a === b || b === c || c === a) continue;
    kept[count++] = a;
    kept[count++] = b;
    kept[count++] = c;
  }
  return kept.slice(0, count);
}

// The first vertex in the cell of each.
function owners(places, cell) {
  const count = places.length / 3;
  const mask = 2 ** Math.ceil(Math.log2(2 * count + 2)) - 1;
  const table = new Int32Array(mask + 1).fill(-1); // open addressing
  const owner = new Uint32Array(count);
  const cellOf = (i, axis) => Math.floor(places[3 * i + axis] / cell);
  for (let i = 0; i < count; i++) {
    const [x, y, z] = [cellOf(i, 0), cellOf(i, 1), cellOf(i, 2)];
    let at = (Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791)) & mask;
    let first = table[at];
    while (first >= 0 && (cellOf(first, 0) !== x || cellOf(first, 1) !== y || cellOf(first, 2) !== z)) {
      at = (at + 1) & mask;
      first = table[at];
    }
    if (first < 0) {
      table[at] = i;
      first = i;
    }
    owner[i] = first;
  }
  return owner;
}
