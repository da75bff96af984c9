// What the reader has chosen, and everything that follows from it.

import { controlTool } from "./control_tool.js";
import { cutModel, cutTool, firstCut, shareThrough } from "./cut_tool.js";
import { Drawing } from "./drawing.js";
import { showAxes, showLegend, showScale } from "./furniture.js";
import { makeHelp, startKeys } from "./keys.js";
import { Lines, pieces } from "./lines.js";
import { drawMeasures, measureTool } from "./measure_tool.js";
import { pointOf } from "./model.js";
import { buildPanel, describeModel } from "./panel.js";
import { pathTool, startPlaying } from "./path_tool.js";
import { showReading, startPointer } from "./pointer.js";
import { distance } from "./ruler.js";
import { planeThrough } from "./section.js";
import { showTool } from "./show_tool.js";
import { colourTable } from "./unpack.js";
import { viewsTool } from "./views_tool.js";

const OVER = new Set(["measuring", "first", "snapped", "measures", "along", "read", "picking", "picks", "controlKind"]);

export class App {
  constructor(content, models, stage) {
    this.content = content;
    this.models = models;
    this.stage = stage;
    this.colours = Object.fromEntries(
      Object.entries(content.maps).map(([name, text]) => [name, colourTable(text)]));
    const preferred = models[0].values.deviation ? "deviation" : "depth";
    this.state = {
      scan: 0, kind: "surface", layer: preferred, ranges: {}, cut: null, along: null,
      measuring: false, first: null, snapped: null, measures: [], read: null,
      picking: false, picks: [], controlKind: "earth",
      path: false, profile: Infinity, playing: false,
    };
    this.lines = new Lines();
    stage.drawings = models.map((model) => new Drawing(model, content.maps));
    stage.scene.add(...stage.drawings.map(({ group }) => group), this.lines.group);
    const { box, views } = models[0];
    const size = Math.hypot(...box.high.map((high, axis) => high - box.low[axis]));
    stage.start(views.front[1].map((x) => -x), Math.max(size, 1e-4));
    stage.listeners.push(() => this.follow());
    this.help = makeHelp(models);
    this.tools = [showTool, viewsTool, measureTool, cutTool, pathTool, controlTool].map((tool) => tool(this));
    buildPanel(this, this.tools);
    startKeys(this);
    startPointer(this);
    this.update({ scan: 0 });
    this.lookFrom("isometric");
  }

  get model() { return this.models[this.state.scan]; }
  get layer() { return this.model.layers.find(({ name }) => name === this.state.layer) ?? null; }
  get range() { return this.state.ranges[this.layer.name] ?? this.layer.range; }
  get now() { return this.state.profile; }
  get cut() { return this.section?.plane ?? null; }
  get picks() { return this.state.picks.filter(({ scan }) => scan === this.state.scan); }
  get measures() { return this.state.measures.filter(({ scan }) => scan === this.state.scan); }

  update(patch) {
    if ("scan" in patch && patch.scan !== this.state.scan) {
      Object.assign(patch, { first: null, snapped: null, read: null, along: null, profile: Infinity, playing: false });
      if (this.state.cut?.axis === "measured") patch.cut = null;
    }
    if (patch.measuring || patch.picking) patch.read = null; // it would lie over what is measured
    Object.assign(this.state, patch);
    const isIn = (name) => name in patch;
    if (["scan", "cut", "along"].some(isIn)) this.findSection();
    if (["scan", "profile", "path"].some(isIn)) this.showTime();
    this.sync();
    // What lies over the picture needs no new one, which without a graphics chip takes its time.
    const names = Object.keys(patch);
    if (names.length && names.every((name) => OVER.has(name))) this.follow();
    else this.stage.invalidate();
  }

  findSection() {
    const { cut, along } = this.state;
    this.section = cut ? cutModel(this.model, cut, along) : null;
    const { places = [], isLines } = this.section ?? {};
    this.lines.setLine("section", isLines ? places : []);
    this.lines.setSpots("dots", isLines ? [] : places);
  }

  sync() {
    const { model, layer, state, stage } = this;
    stage.kind = state.kind;
    stage.drawings.forEach((drawing, number) => {
      drawing.group.visible = number === state.scan;
    });
    const drawing = stage.drawings[state.scan];
    drawing.colourBy(layer, layer && this.range);
    drawing.cutBy(this.cut);
    drawing.uniforms.now.value = state.profile;
    showLegend(layer, layer && this.range, layer && this.colours[layer.map]);
    showReading(this);
    document.getElementById("about").textContent = describeModel(model, this.models.length > 1);
    stage.canvas.classList.toggle("measuring", state.measuring || state.picking);
    for (const tool of this.tools) tool.sync();
  }

  // The newest profile bright, and the camera that sees it.
  showTime() {
    const { model, lines, state } = this;
    const isPartial = Number.isFinite(state.profile);
    const [start, end] = isPartial ? [model.starts[state.profile], model.starts[state.profile + 1]] : [0, 0];
    const fresh = model.positions.slice(3 * start, 3 * end);
    const camera = isPartial ? model.path[state.profile] : undefined;
    lines.setSpots("fresh", fresh);
    lines.setSpots("camera", camera ?? []);
    const ends = camera && end > start ? [start, end - 1].map((i) => pointOf(model, i)) : [];
    lines.setLine("rays", ends.flatMap((place) => [...camera, ...place]));
    lines.setLine("path", state.path || camera ? pieces(model.path, state.profile) : []);
  }

  // What moves with the view.
  follow() {
    showScale(this.stage);
    showAxes(this.stage);
    drawMeasures(this);
  }

  lookFrom(name) { this.stage.lookAlong(this.model.views[name], this.model); }

  reset() {
    this.update({ cut: null, profile: Infinity, playing: false, ranges: {} });
    this.lookFrom("isometric");
  }

  toggleCut() { this.update({ cut: this.state.cut ? null : firstCut() }); }

  cutWith(patch) {
    const cut = { ...this.state.cut, ...patch };
    if (patch.axis === "measured") cut.share = shareThrough(this.model, this.state.along);
    this.update({ cut });
  }

  measure(first, second) {
    const { scan, cut, measures } = this.state;
    const sight = this.model.views.front[2].map((_, axis) =>
      -this.stage.camera.matrixWorld.elements[8 + axis]);
    const along = planeThrough(pointOf(this.model, first), pointOf(this.model, second), sight);
    const found = { scan, first, second, ...distance(this.model, first, second) };
    this.update({ first: null, along, measures: [...measures, found] });
    if (cut?.axis === "measured") this.cutWith({ axis: "measured" });
  }

  play(playing) {
    if (this.model.times.length < 2) return;
    this.update({ playing });
    if (playing) startPlaying(this);
  }
}

