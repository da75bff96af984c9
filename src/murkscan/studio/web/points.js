// A cloud that grows, drawn by WebGL as plain points; turned by a drag, drawn only when something changed.

const VERTEX = `#version 300 es
in vec4 point; uniform mat3 turn; uniform vec3 middle; uniform vec2 scale; uniform vec2 depths; uniform float size;
out float shade;
void main() {
  vec3 seen = turn * (point.xyz - middle);
  gl_Position = vec4(seen.x * scale.x, -seen.y * scale.y, seen.z * 0.01, 1.0);
  gl_PointSize = size;
  shade = clamp((point.z - depths.x) / max(depths.y - depths.x, 1e-6), 0.0, 1.0);
}`;
const FRAGMENT = `#version 300 es
precision mediump float; in float shade; out vec4 colour;
const vec3 stops[5] = vec3[5](vec3(.99,.91,.14), vec3(.37,.79,.38), vec3(.13,.57,.55), vec3(.23,.32,.55), vec3(.27,.05,.35));
void main() { float at = shade * 3.999; int k = int(at); colour = vec4(mix(stops[k], stops[k + 1], at - float(k)), 1.0); }`;
const ROW = 4, SAMPLE = 2000;
// Points that are drawn at most, some for each pixel: an hour's dive would have millions, of which a page
// without a graphics chip draws no ten a second.
const MOST = 200_000;
// Milliseconds from one picture to the next, while the model is turned, above which every second point is left
// out until it stands again; and every how many are drawn at least.
const SLOW = 60, SPARSEST = 16;

export function pointView(canvas) {
  const gl = canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: false });
  if (!gl) return null;
  const program = link(gl);
  const buffer = gl.createBuffer();
  const place = Object.fromEntries(["turn", "middle", "scale", "depths", "size"].map((name) => [name, gl.getUniformLocation(program, name)]));
  let data = new Float32Array(1 << 16), count = 0, room = 0, yaw = 0, pitch = 0, zoom = 1, isDue = false, from = null;
  let every = 1;
  let low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  gl.useProgram(program);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.enableVertexAttribArray(0);

  function add(rows) {
    const added = rows.length / ROW;
    while (count && count + added > MOST) thin();
    while ((count + added) * ROW > data.length) {
      const larger = new Float32Array(data.length * 2);
      larger.set(data);
      data = larger;
    }
    data.set(rows, count * ROW);
    for (let i = 0; i < rows.length; i += ROW) {
      for (let k = 0; k < 3; k += 1) {
        low[k] = Math.min(low[k], rows[i + k]);
        high[k] = Math.max(high[k], rows[i + k]);
      }
    }
    if (data.length > room) {
      room = data.length;
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    } else gl.bufferSubData(gl.ARRAY_BUFFER, count * ROW * 4, rows);
    count += added;
    draw();
  }

  // Every second point of those that are there goes: the oldest become the sparsest.
  function thin() {
    let kept = 0;
    for (let i = 0; i < count; i += 2, kept += 1) data.copyWithin(kept * ROW, i * ROW, (i + 1) * ROW);
    count = kept;
    room = 0;
  }

  // Where most depths lie: a few strays would take the colours from all others.
  function depths() {
    const step = Math.max(1, Math.floor(count / SAMPLE)) * ROW, some = [];
    for (let i = 2; i < count * ROW; i += step) some.push(data[i]);
    some.sort((a, b) => a - b);
    return [0.02, 0.98].map((share) => some[Math.floor(share * (some.length - 1))]);
  }

  function clear() {
    count = 0;
    low = [Infinity, Infinity, Infinity];
    high = [-Infinity, -Infinity, -Infinity];
    draw();
  }

  function draw() {
    if (isDue) return;
    isDue = true;
    requestAnimationFrame(() => { isDue = false; paint(); });
  }

  function paint() {
    const ratio = Math.min(devicePixelRatio, 2);
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!count) return;
    gl.enable(gl.DEPTH_TEST);
    const shown = Math.floor(count / every);
    const middle = low.map((value, k) => (value + high[k]) / 2);
    const turn = turned(yaw, pitch);
    const [w, h] = extent(turn, low, high);
    const most = 1.8 * zoom / Math.max(w / width, h / height, 1e-6);
    gl.uniformMatrix3fv(place.turn, false, turn);
    gl.uniform3fv(place.middle, middle);
    gl.uniform2f(place.scale, most / width, most / height);
    gl.uniform2f(place.depths, ...depths());
    gl.uniform1f(place.size, Math.max(1.5 * ratio, Math.min(6 * ratio, 1.2 * Math.sqrt(width * height / shown))));
    gl.vertexAttribPointer(0, ROW, gl.FLOAT, false, every * ROW * 4, 0);
    gl.drawArrays(gl.POINTS, 0, shown);
    canvas.dataset.points = count;
  }

  // While the model is turned it keeps up with the hand: of so many points one is drawn.
  function beat(before, now) {
    if (from === null) return;
    if (now - before > SLOW) every = Math.min(2 * every, SPARSEST);
    requestAnimationFrame((next) => beat(now, next));
  }

  canvas.onpointerdown = (event) => {
    from = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
    requestAnimationFrame((now) => beat(now, now));
  };
  canvas.onpointerup = canvas.onpointercancel = () => { from = null; every = 1; draw(); };
  canvas.onpointermove = (event) => {
    if (!from) return;
    yaw += (event.clientX - from[0]) / 150;
    pitch += (event.clientY - from[1]) / 150;
    from = [event.clientX, event.clientY];
    draw();
  };
  canvas.ondblclick = () => { yaw = 0; pitch = 0; zoom = 1; draw(); };
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); zoom *= Math.exp(-event.deltaY / 600); draw(); }, { passive: false });
  const watcher = new ResizeObserver(draw);
  watcher.observe(canvas);
  return { add, clear, end: () => { watcher.disconnect(); gl.getExtension("WEBGL_lose_context")?.loseContext(); } };
}

// Columns of the rotation by yaw about y, then by pitch about x.
function turned(yaw, pitch) {
  const [c, s, d, t] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
  return new Float32Array([c, t * s, -d * s, 0, d, t, s, -t * c, d * c]);
}

function extent(turn, low, high) {
  const half = low.map((value, k) => (high[k] - value) / 2);
  return [0, 1].map((row) => 2 * half.reduce((sum, value, k) => sum + Math.abs(turn[3 * k + row]) * value, 0));
}

function link(gl) {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.bindAttribLocation(program, 0, "point");
  gl.linkProgram(program);
  return program;
}
