// A model on the graphics chip: its points, a fair sample of them, its surface, a profile.

import {
  BufferAttribute, BufferGeometry, DataTexture, Group, LinearFilter, Mesh, Points, RGBAFormat,
} from "three";
import { coarsen } from "./coarsen.js";
import { makeMaterials } from "./material.js";
import { colourTable } from "./unpack.js";

const SEED = 1;
const CELL = 3; // of the coarse surface, in usual spacings: about a ninth of the triangles is left

export class Drawing {
  constructor(model, maps) {
    this.model = model;
    this.group = new Group();
    this.maps = maps;
    const { points, surface, uniforms } = makeMaterials(new DataTexture());
    this.uniforms = uniforms;
    this.attributes = {
      position: new BufferAttribute(model.positions, 3),
      normal: new BufferAttribute(model.normals, 4, true),
      moment: new BufferAttribute(Float32Array.from(model.moments), 1),
    };
    this.points = new Points(this.geometry(), points);
    this.points.geometry.setDrawRange(0, model.measured);
    this.sample = new Points(this.geometry(shuffled(model.measured)), points);
    this.parts = [this.points, this.sample];
    this.coarse = null;
    if (model.faces.length) {
      this.material = surface;
      this.corners = model.surface === model.positions
        ? this.attributes.position : new BufferAttribute(model.surface, 3);
      this.surface = this.meshOf(model.faces);
      this.parts.push(this.surface);
    }
    for (const part of this.parts) part.frustumCulled = false;
    this.group.add(...this.parts);
    this.textures = {};
    this.colourBy(null);
  }

  geometry(index) {
    const geometry = new BufferGeometry();
    for (const [name, attribute] of Object.entries(this.attributes)) {
      geometry.setAttribute(name, attribute);
    }
    if (index) geometry.setIndex(new BufferAttribute(index, 1));
    return geometry;
  }

  meshOf(faces) {
    const mesh = new Mesh(this.geometry(faces), this.material);
    mesh.geometry.setAttribute("position", this.corners);
    return mesh;
  }

  // Makes the coarse surface, once it is finer than a pixel [m].
  prepare(pixel) {
    if (!this.surface || this.coarse || CELL * this.model.spacing > pixel) return;
    const { model } = this;
    this.coarse = this.meshOf(coarsen(model.surface, model.faces, CELL * model.spacing));
    this.coarse.geometry.setAttribute("value", this.surface.geometry.getAttribute("value"));
    this.coarse.frustumCulled = this.coarse.visible = false;
    this.parts.push(this.coarse);
    this.group.add(this.coarse);
  }

  // Null for plain.
  colourBy(layer, range) {
    this.uniforms.plain.value = !layer;
    const name = layer?.name ?? "depth";
    if (this.shown !== name) {
      const attribute = new BufferAttribute(this.model.values[name], 1);
      for (const part of this.parts) part.geometry.setAttribute("value", attribute);
      this.shown = name;
    }
    if (!layer) return;
    this.uniforms.map.value = this.textures[layer.map] ??= asTexture(this.maps[layer.map]);
    this.uniforms.range.value = range;
  }

  cutBy(plane) {
    this.uniforms.cut.value = plane ? [...plane.normal, plane.offset] : [0, 0, 0, 1];
  }

  // With less, a fair sample of so many points stands for everything. Where even the coarse surface
  // is finer than a pixel [m], it stands for the whole one.
  choose(kind, budget, pixel) {
    const { model } = this;
    const less = budget < model.measured;
    const asSurface = kind === "surface" && Boolean(this.surface);
    const asCoarse = asSurface && !less && Boolean(this.coarse) && CELL * model.spacing < pixel;
    this.sample.visible = less;
    this.points.visible = !less && !asSurface;
    if (this.surface) this.surface.visible = asSurface && !less && !asCoarse;
    if (this.coarse) this.coarse.visible = asCoarse;
    if (less) this.sample.geometry.setDrawRange(0, budget);
    this.drawn = asCoarse ? model.vertices / CELL ** 2 : model.vertices;
    return less ? budget : model.measured;
  }
}

function asTexture(text) {
  const texture = new DataTexture(colourTable(text), 256, 1, RGBAFormat);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

// The same order on every day: a page that is opened twice looks the same.
function shuffled(count) {
  const order = new Uint32Array(count);
  let seed = SEED;
  for (let i = 0; i < count; i++) {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    const other = Math.floor((seed / 4294967296) * (i + 1));
    order[i] = order[other];
    order[other] = i;
  }
  return order;
}
