// Making elements.

export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name in element && name !== "list") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

// A button that stays pressed.
export function setPressed(button, is) {
  button.setAttribute("aria-pressed", String(Boolean(is)));
}

// One of several, side by side. Options are [value, label].
export function choice(label, options, choose) {
  const buttons = options.map(([value, text]) =>
    make("button", { type: "button", textContent: text, value, onclick: () => choose(value) }));
  const element = make("div", { className: "choice", role: "group", "aria-label": label }, ...buttons);
  return {
    element,
    show(value) { for (const one of buttons) setPressed(one, one.value === String(value)); },
  };
}
