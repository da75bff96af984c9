// The tools: side by side on a wide screen, one at a time on a small one.

import { make, setPressed } from "./dom.js";
import { grouped } from "./numbers.js";
import { swapTheme } from "./theme.js";

export function buildPanel(app, tools) {
  const panel = document.getElementById("panel");
  const sections = tools.map(({ name, title, element }) => make(
    "section", { id: `tool-${name}` }, make("h2", { textContent: title }), element));
  const tabs = tools.map(({ title, name }, number) => make("button", {
    type: "button", textContent: title, "aria-controls": `tool-${name}`,
    onclick: () => open(panel.dataset.open === String(number) ? null : number),
  }));
  function open(number) {
    if (number === null) delete panel.dataset.open;
    else panel.dataset.open = String(number);
    sections.forEach((one, k) => one.classList.toggle("open", k === number));
    tabs.forEach((one, k) => setPressed(one, k === number));
  }
  open(null);
  panel.append(make("nav", { "aria-label": "Tools" }, ...tabs), ...sections, foot(app));
}

// A word where there is room, a sign where there is not.
function twoWays(word, sign) {
  return [make("span", { className: "long", textContent: word }),
    make("span", { className: "short", textContent: sign, "aria-hidden": "true" })];
}

function foot(app) {
  const button = (word, sign, title, onclick) =>
    make("button", { type: "button", title, "aria-label": word, onclick }, ...twoWays(word, sign));
  const parts = [
    button("Light / dark", "◐", "Key T", () => { swapTheme(); app.update({}); }),
    button("Help", "?", "Key ?", () => app.help.showModal()),
  ];
  const { pictures } = app.content;
  if (pictures) {
    parts.push(make("a", { href: pictures, "aria-label": "Pictures" }, ...twoWays("Pictures for print", "▦")));
  }
  return make("footer", {}, ...parts);
}

export function describeModel({ measured, faces, name }, isOneOfMany) {
  const parts = [`${grouped(measured)} points`];
  if (faces.length) parts.push(`${grouped(faces.length / 3)} triangles`);
  return (isOneOfMany ? `${name}: ` : "") + parts.join(" · ");
}
