// How vertices and triangles look: coloured by a layer or plain, lit from the upper left, cut by a
// plane, and hidden before their time. The light is that of light.py.

import { DoubleSide, GLSL3, ShaderMaterial } from "three";

const SHARED = /* glsl */ `
  uniform sampler2D map;
  uniform vec2 range;
  uniform bool plain;
  const vec3 OUTSIDE = vec3(0.89, 0.87, 0.83);
  const vec3 INSIDE = vec3(0.62, 0.71, 0.83);
  const vec3 NO_VALUE = vec3(0.55);
  const vec3 KEY = vec3(-0.52, 0.62, 0.59);
  vec3 colourOf(float value, vec3 normal, bool outside) {
    vec3 n = outside ? normal : -normal;
    float key = 0.5 + 0.5 * clamp(dot(n, KEY), -1.0, 1.0);
    float light = 0.22 + 0.74 * key * key + 0.10 * max(n.z, 0.0);
    if (plain) return (outside ? OUTSIDE : INSIDE) * light;
    float share = (value - range.x) / (range.y - range.x);
    vec3 colour = value < -1e20 ? NO_VALUE
      : texture(map, vec2(clamp(share, 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0, 0.5)).rgb;
    return colour * (0.5 + 0.5 * light);
  }`;

const HIDING = /* glsl */ `
  uniform vec4 cut;
  uniform float now;
  bool isHidden(vec3 place, float moment) {
    return dot(cut.xyz, place) > cut.w || moment > now;
  }`;

const POINT_VERTEX = /* glsl */ `
  in float value;
  in float moment;
  uniform float size;
  out vec3 colour;
  ${SHARED}
  ${HIDING}
  void main() {
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    if (isHidden(position, moment)) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = size;
    vec3 n = normalize(normalMatrix * normal);
    colour = colourOf(value, n, n.z >= 0.0);
  }`;

const POINT_FRAGMENT = /* glsl */ `
  in vec3 colour;
  uniform float size;
  out vec4 pixel;
  void main() {
    vec2 off = gl_PointCoord - 0.5;
    if (size > 3.0 && dot(off, off) > 0.25) discard;
    pixel = vec4(colour, 1.0);
  }`;

const SURFACE_VERTEX = /* glsl */ `
  in float value;
  in float moment;
  out vec3 towards;
  out vec3 place;
  out float shown;
  out float when;
  void main() {
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    towards = normalMatrix * normal;
    place = position;
    shown = value;
    when = moment;
  }`;

const SURFACE_FRAGMENT = /* glsl */ `
  in vec3 towards;
  in vec3 place;
  in float shown;
  in float when;
  out vec4 pixel;
  ${SHARED}
  ${HIDING}
  void main() {
    if (isHidden(place, when)) discard;
    pixel = vec4(colourOf(shown, normalize(towards), gl_FrontFacing), 1.0);
  }`;

// Both share their uniforms: what is set for one is set for the other.
export function makeMaterials(texture) {
  const uniforms = {
    map: { value: texture },
    range: { value: [0, 1] },
    plain: { value: true },
    cut: { value: [0, 0, 0, 1] },
    now: { value: Infinity },
    size: { value: 2 },
  };
  const common = { uniforms, glslVersion: GLSL3 };
  return {
    uniforms,
    points: new ShaderMaterial({
      ...common, vertexShader: POINT_VERTEX, fragmentShader: POINT_FRAGMENT,
    }),
    surface: new ShaderMaterial({
      ...common, vertexShader: SURFACE_VERTEX, fragmentShader: SURFACE_FRAGMENT, side: DoubleSide,
    }),
  };
}
