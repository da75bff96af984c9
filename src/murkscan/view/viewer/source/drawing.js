// A model on the graphics chip: its points, a fair sample of them, its surface, a profile.

import {
  BufferAttribute, BufferGeometry, DataTexture, Group, LinearFilter, Mesh, Points, RGBAFormat,
} from "three";
import { makeMaterials } from "./material.js";
import { colourTable } from "./unpack.js";

const SEED = 1;

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
    if (model.faces.length) {
      this.surface = new Mesh(this.geometry(model.faces), surface);
      if (model.surface !== model.positions) {
        this.surface.geometry.setAttribute("position", new BufferAttribute(model.surface, 3));
      }
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

  // With less, a fair sample of so many points stands for everything.
  choose(kind, budget) {
    const coarse = budget < this.model.measured;
    const asSurface = kind === "surface" && this.surface;
    this.sample.visible = coarse;
    this.points.visible = !coarse && !asSurface;
    if (this.surface) this.surface.visible = !coarse && asSurface;
    if (coarse) this.sample.geometry.setDrawRange(0, budget);
    return coarse ? budget : this.model.measured;
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
