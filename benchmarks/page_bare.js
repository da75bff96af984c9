// The least that shows a million points by three.js: what the page of `murkscan view` is held to.

import {
  BufferAttribute, BufferGeometry, OrthographicCamera, Points, PointsMaterial, Scene, WebGLRenderer,
} from "three";

const COUNT = 1_000_000;
const canvas = document.getElementById("canvas");
const renderer = new WebGLRenderer({ canvas });
renderer.setSize(innerWidth, innerHeight, false);
const places = new Float32Array(3 * COUNT);
const colours = new Float32Array(3 * COUNT);
for (let i = 0; i < COUNT; i++) {
  const [x, y] = [(i % 1000) / 500 - 1, Math.floor(i / 1000) / 500 - 1];
  places.set([x, y, 0.05 * Math.sin(6 * x) * Math.cos(5 * y)], 3 * i);
  colours.set([(x + 1) / 2, (y + 1) / 2, 0.5], 3 * i);
}
const geometry = new BufferGeometry();
geometry.setAttribute("position", new BufferAttribute(places, 3));
geometry.setAttribute("color", new BufferAttribute(colours, 3));
const points = new Points(geometry, new PointsMaterial({ size: 2, sizeAttenuation: false, vertexColors: true }));
const scene = new Scene();
scene.add(points);
const camera = new OrthographicCamera(-1.6, 1.6, 1, -1, 0, 10);
camera.position.set(3, 2, 3);
camera.lookAt(0, 0, 0);

window.bare = () => {
  points.rotation.y += 0.05;
  const start = performance.now();
  renderer.render(scene, camera);
  const gl = renderer.getContext();
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  return performance.now() - start;
};
window.bare();
canvas.dataset.frames = 1;
