// Elements made from code: texts are always texts, so that no name of a file can be markup.

export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name === "data") Object.assign(element.dataset, value);
    else if (name.startsWith("aria-") || name === "for" || name === "role") element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

export function draw(tag, attributes = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children.flat());
  return element;
}

export const note = (text, tone = "") => make("p", { className: `note ${tone}`, textContent: text });

export const button = (text, onclick, more = {}) => make("button", { type: "button", textContent: text, onclick, ...more });

export function table(head, rows) {
  const line = (cells, tag) => make("tr", {}, cells.map((cell) => {
    const element = make(tag, { className: typeof cell === "number" ? "number" : "" });
    element.append(cell instanceof Node ? cell : String(cell ?? "–"));
    return element;
  }));
  return make("div", { className: "scroll" }, make("table", {},
    head.length ? make("thead", {}, line(head, "th")) : null,
    make("tbody", {}, rows.map((row) => line(row, "td")))));
}

// Draws only what has changed: a list that is shown anew each second must not lose its focus.
export function keep(element, key, fill) {
  const said = JSON.stringify(key);
  if (element.dataset.shown === said) return;
  element.dataset.shown = said;
  element.replaceChildren(...[fill()].flat().filter(Boolean));
}
