// Which measured point a finger or a mouse means: the nearest one in the picture that is in front.

const CLOSE = 3; // px

// Gives the point's number, or null where there is none within so many pixels.
export function pick(app, x, y, radius) {
  const { model, stage, cut, now } = app;
  stage.camera.updateMatrixWorld();
  const view = stage.camera.matrixWorldInverse.elements;
  const scale = stage.scale;
  const middle = centreOf(stage);
  const [wantedX, wantedY] = [(x - middle[0]) / scale, (middle[1] - y) / scale];
  const reach = radius / scale;
  const { positions, measured, moments } = model;
  const found = [];
  for (let i = 0, p = 0; i < measured; i++, p += 3) {
    const [px, py, pz] = [positions[p], positions[p + 1], positions[p + 2]];
    const right = view[0] * px + view[4] * py + view[8] * pz + view[12] - wantedX;
    if (right > reach || right < -reach) continue;
    const up = view[1] * px + view[5] * py + view[9] * pz + view[13] - wantedY;
    const off = right * right + up * up;
    if (off > reach * reach || moments[i] > now) continue;
    if (cut && cut.normal[0] * px + cut.normal[1] * py + cut.normal[2] * pz > cut.offset) continue;
    found.push({ i, off, depth: -(view[2] * px + view[6] * py + view[10] * pz + view[14]) });
  }
  if (!found.length) return null;
  // What lies right under the pointer is meant before anything in front of it but beside.
  const close = Math.max(CLOSE / scale, model.spacing);
  const under = found.filter(({ off }) => off < close * close);
  const meant = under.length ? under : found;
  const front = meant.reduce((least, { depth }) => Math.min(least, depth), Infinity);
  const near = meant.filter(({ depth }) => depth < front + reach + 3 * model.spacing);
  return near.reduce((best, one) => (one.off < best.off ? one : best)).i;
}

// The pixel that shows the origin of the camera's own axes.
function centreOf({ width, height, camera }) {
  const { left, right, top, bottom } = camera;
  return [(-left / (right - left)) * width, (top / (top - bottom)) * height];
}
