// Undoes packing.py: base64, zlib, bytes by weight, folded differences.

const CHUNK = 1 << 22; // letters, a multiple of 4

function bytesOf(text) {
  const padding = text.endsWith("==") ? 2 : text.endsWith("=") ? 1 : 0;
  const bytes = new Uint8Array((text.length / 4) * 3 - padding);
  let at = 0;
  for (let start = 0; start < text.length; start += CHUNK) {
    const part = atob(text.slice(start, start + CHUNK));
    for (let i = 0; i < part.length; i++) bytes[at++] = part.charCodeAt(i);
  }
  return bytes;
}

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Gives the whole numbers that `pack` was given, one array a column.
export async function unpack(text, count, columns, width) {
  if (count === 0) return Array.from({ length: columns }, () => new Int32Array(0));
  const bytes = await inflate(bytesOf(text));
  const span = 256 ** width;
  return Array.from({ length: columns }, (_, column) => {
    const numbers = width < 4 ? new Int32Array(count) : new Uint32Array(count);
    const planes = Array.from({ length: width }, (_, weight) => {
      const start = (column * width + weight) * count;
      return bytes.subarray(start, start + count);
    });
    let last = 0;
    for (let i = 0; i < count; i++) {
      let folded = 0;
      for (let weight = width - 1; weight >= 0; weight--) folded = folded * 256 + planes[weight][i];
      last += folded % 2 ? -(folded + 1) / 2 : folded / 2;
      if (last < 0) last += span;
      else if (last >= span) last -= span;
      numbers[i] = last;
    }
    return numbers;
  });
}

// Takes the text out of the page, so that it is not held twice.
export function takeText(id) {
  const element = document.getElementById(id);
  const text = element.textContent.trim();
  element.remove();
  return text;
}

export function colourTable(text) {
  const rgb = bytesOf(text);
  const rgba = new Uint8Array(256 * 4).fill(255);
  for (let i = 0; i < 256; i++) rgba.set(rgb.subarray(3 * i, 3 * i + 3), 4 * i);
  return rgba;
}
