// The isometric view, the six standard ones, and the model in the middle.

import { make } from "./dom.js";

export function viewsTool(app) {
  const names = Object.keys(app.model.views);
  const buttons = names.map((name, number) => make("button", {
    type: "button", textContent: name, title: `Key ${number + 1}`, onclick: () => app.lookFrom(name),
  }));
  const reset = make("button", {
    type: "button", textContent: "reset", title: "Key R", onclick: () => app.reset(),
  });
  const element = make("div", { className: "grid" }, ...buttons, reset);
  return { name: "views", title: "Views", element, sync() {} };
}
