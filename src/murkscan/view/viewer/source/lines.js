// Lines in space that stand out from the model: the camera's path, the section.

import { Group, Points, PointsMaterial, BufferGeometry, BufferAttribute } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

const PATH = 0x2f7fd0;
const CAMERA = 0x2f7fd0;
const SECTION = 0xe0561b;
const FRESH = 0x19d36b; // as the laser

export class Lines {
  constructor() {
    this.group = new Group();
    this.path = this.line(PATH, 2.5);
    this.section = this.line(SECTION, 3);
    this.rays = this.line(CAMERA, 1.2);
    this.dots = this.spots(SECTION, 4);
    this.fresh = this.spots(FRESH, 5);
    this.camera = this.spots(CAMERA, 10);
  }

  line(color, linewidth) {
    const line = new LineSegments2(
      new LineSegmentsGeometry(), new LineMaterial({ color, linewidth, depthTest: false }));
    return this.add(line);
  }

  spots(color, size) {
    const material = new PointsMaterial({ color, size, sizeAttenuation: false, depthTest: false });
    return this.add(new Points(new BufferGeometry(), material));
  }

  add(part) {
    part.frustumCulled = false;
    part.visible = false;
    part.renderOrder = 1;
    this.group.add(part);
    return part;
  }

  // Six numbers a piece; nothing hides it.
  setLine(name, ends) {
    const line = this[name];
    line.visible = ends.length > 0;
    line.geometry.dispose();
    if (!line.visible) return;
    line.geometry = new LineSegmentsGeometry();
    line.geometry.setPositions(ends);
  }

  setSpots(name, places) {
    const spots = this[name];
    spots.visible = places.length > 0;
    spots.geometry.dispose();
    spots.geometry = new BufferGeometry();
    spots.geometry.setAttribute("position", new BufferAttribute(Float32Array.from(places), 3));
  }
}

// A path as pieces, up to a profile.
export function pieces(path, last) {
  const ends = [];
  for (let k = 1; k < path.length && k <= last; k++) ends.push(...path[k - 1], ...path[k]);
  return ends;
}
