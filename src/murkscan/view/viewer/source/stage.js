// Camera, controls and the one place that draws: on demand, coarse while it moves if it must.

import { MOUSE, OrthographicCamera, Quaternion, Scene, TOUCH, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const QUICK = 40; // ms a frame that feels immediate
const REST = 180; // ms without movement until everything is drawn
const FEWEST = 20000; // points that still show a shape
const SIZE = 1.2; // of a point, in distances of neighbours
const COARSE_SIZE = 2; // the same of a sample's, which lie at random: smaller ones leave holes
// Pixels that the writing takes around the model, by the width of the canvas.
const RIMS = [
  { upTo: 600, left: 24, right: 24, top: 112, bottom: 64 },
  { upTo: Infinity, left: 130, right: 60, top: 84, bottom: 72 },
];
const SAMPLED = 20000; // vertices by which the model is placed
const STRAY = 0.003; // share of them at each end that may lie outside
const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = makeRenderer(canvas);
    this.scene = new Scene();
    this.camera = new OrthographicCamera(-1, 1, 1, -1, 0, 10);
    this.drawings = [];
    this.cost = 0; // ms of the last full frame
    this.drawn = 0; // vertices of it
    this.moving = false;
    this.listeners = []; // told before each frame
    this.kind = "surface";
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  start(up, size) {
    this.size = size;
    this.camera.up.set(...up);
    this.controls = new OrbitControls(this.camera, this.canvas);
    Object.assign(this.controls, {
      zoomToCursor: true,
      minZoom: 0.2,
      maxZoom: 2000,
      mouseButtons: { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN },
      touches: { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN },
    });
    this.controls.addEventListener("change", () => this.move());
    this.controls.addEventListener("start", () => { this.fitted = null; });
    this.resize();
  }

  // Whether all is drawn, and nothing will be until the reader does something.
  get isAtRest() { return !this.request && !this.moving && this.cost > 0; }
  get height() { return this.canvas.clientHeight; }
  get width() { return this.canvas.clientWidth; }
  // Pixels of the page a metre.
  get scale() { return (this.height * this.camera.zoom) / (this.camera.top - this.camera.bottom); }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height || !this.size) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    const tall = this.size;
    const wide = (tall * width) / height;
    Object.assign(this.camera, { left: -wide / 2, right: wide / 2, top: tall / 2, bottom: -tall / 2 });
    Object.assign(this.camera, { near: 0, far: 20 * this.size });
    this.camera.updateProjectionMatrix();
    if (this.fitted) this.fit(this.fitted);
    this.invalidate();
  }

  // Rows of the matrix point right, down and away from the viewer.
  lookAlong([, down, away], model) {
    const middle = model.box.low.map((low, axis) => (low + model.box.high[axis]) / 2);
    const forward = new Vector3(...away);
    const up = new Vector3(...down).negate();
    // Straight from above or below, what is up in the picture decides on the last thousandth.
    if (Math.abs(forward.dot(this.camera.up)) > 0.9999) forward.addScaledVector(up, 1e-4);
    this.controls.target.set(...middle);
    this.camera.position.copy(this.controls.target).addScaledVector(forward.normalize(), -10 * this.size);
    this.camera.zoom = 1;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.fit(model);
  }

  // Brings the surface into the middle, without the few points that stray from it.
  fit(model) {
    const { positions, faces, measured } = model;
    this.camera.updateMatrixWorld();
    const view = this.camera.matrixWorldInverse.elements;
    const corner = faces.length ? (i) => 3 * faces[i] : (i) => 3 * i;
    const count = faces.length || measured;
    const step = Math.max(Math.floor(count / SAMPLED), 1);
    const seen = [[], []];
    for (let i = 0; i < count; i += step) {
      const p = corner(i);
      seen.forEach((places, row) => places.push(view[row] * positions[p]
        + view[row + 4] * positions[p + 1] + view[row + 8] * positions[p + 2] + view[row + 12]));
    }
    const [[left, right], [bottom, top]] = seen.map(extentOfMost);
    const rim = RIMS.find(({ upTo }) => this.width <= upTo);
    const wide = Math.max(this.width - rim.left - rim.right, 40);
    const tall = Math.max(this.height - rim.top - rim.bottom, 40);
    const scale = Math.min(wide / (right - left), tall / (top - bottom));
    const { camera } = this;
    camera.zoom = (scale * (camera.top - camera.bottom)) / this.height;
    camera.updateProjectionMatrix();
    this.shift((left + right) / 2 - (rim.left - rim.right) / 2 / scale,
      (bottom + top) / 2 - (rim.bottom - rim.top) / 2 / scale);
    this.fitted = model; // until the reader moves it: then a change of the window leaves it alone
  }

  // Metres to the right and up in the picture.
  shift(right, up) {
    this.fitted = null;
    const step = new Vector3(right, up, 0).applyQuaternion(this.camera.quaternion);
    this.controls.target.add(step);
    this.camera.position.add(step);
    this.controls.update();
    this.move();
  }

  turn(right, up) {
    this.fitted = null;
    const off = this.camera.position.clone().sub(this.controls.target);
    const axis = new Vector3(1, 0, 0).applyQuaternion(this.camera.quaternion);
    const tilt = new Quaternion().setFromAxisAngle(axis, -up);
    const steep = off.clone().applyQuaternion(tilt).angleTo(this.camera.up);
    if (steep > 0.01 && steep < Math.PI - 0.01) off.applyQuaternion(tilt);
    off.applyQuaternion(new Quaternion().setFromAxisAngle(this.camera.up, right));
    this.camera.position.copy(this.controls.target).add(off);
    this.controls.update();
    this.move();
  }

  zoomBy(factor) {
    this.fitted = null;
    const { minZoom, maxZoom } = this.controls;
    this.camera.zoom = Math.min(Math.max(this.camera.zoom * factor, minZoom), maxZoom);
    this.camera.updateProjectionMatrix();
    this.move();
  }

  centreOn(point) {
    this.fitted = null;
    const step = new Vector3(...point).sub(this.controls.target);
    this.controls.target.add(step);
    this.camera.position.add(step);
    this.controls.update();
    this.move();
  }

  // Pixels of the canvas, and depth away from the viewer [m].
  project([x, y, z]) {
    this.camera.updateMatrixWorld();
    const at = new Vector3(x, y, z).applyMatrix4(this.camera.matrixWorldInverse);
    const { left, right, top, bottom, zoom } = this.camera;
    return [
      ((at.x * zoom) / (right - left) + 0.5) * this.width,
      (0.5 - (at.y * zoom) / (top - bottom)) * this.height,
      -at.z,
    ];
  }

  move() {
    this.moving = true;
    clearTimeout(this.rest);
    this.rest = setTimeout(() => {
      this.moving = false;
      if (this.isCoarse) this.invalidate();
    }, REST);
    this.invalidate();
  }

  invalidate() {
    this.request ??= requestAnimationFrame(() => {
      this.request = null;
      this.draw();
    });
  }

  draw() {
    const visible = this.drawings.find((one) => one.group.visible);
    if (!visible || !this.size) return;
    for (const listener of this.listeners) listener();
    const pixel = 1 / this.scale;
    if (!this.moving) visible.prepare(pixel);
    const budget = this.moving && this.cost > QUICK
      ? Math.max(FEWEST, (this.drawn * QUICK) / this.cost)
      : Infinity;
    const count = visible.choose(this.kind, Math.floor(budget), pixel);
    this.isCoarse = count < visible.model.measured;
    const gap = visible.model.spacing * Math.sqrt(visible.model.measured / count);
    const ratio = this.renderer.getPixelRatio();
    const wide = this.isCoarse ? COARSE_SIZE : SIZE;
    visible.uniforms.size.value = ratio * Math.min(Math.max(wide * gap * this.scale, 1.5), 14);
    const start = performance.now();
    this.renderer.render(this.scene, this.camera);
    if (this.isCoarse) return;
    // Reading a pixel waits for the chip: only so is the cost of the frame known.
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    this.cost = performance.now() - start;
    this.drawn = visible.drawn;
    this.canvas.dataset.frames = 1 + Number(this.canvas.dataset.frames ?? 0);
    this.canvas.dataset.cost = this.cost.toFixed(1);
  }
}

function extentOfMost(places) {
  places.sort((a, b) => a - b);
  const spare = Math.floor(STRAY * places.length);
  const [low, high] = [places[spare], places[places.length - 1 - spare]];
  const rim = Math.max((high - low) * STRAY * 4, 5e-4);
  return [low - rim, high + rim];
}

function makeRenderer(canvas) {
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) throw new Error("no WebGL");
  const name = probe.getParameter(
    probe.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? probe.RENDERER);
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  // Smooth edges cost four times the pixels: without a graphics chip that is too dear.
  const antialias = !SOFTWARE.test(String(name));
  const renderer = new WebGLRenderer({ canvas, alpha: true, antialias });
  renderer.setClearColor(0, 0);
  return renderer;
}
