// A command as a form: what is filled in is written below it as it would be typed.

import { order, refresh, studio } from "./ask.js";
import { button, make, note } from "./dom.js";

// What somebody typed into a form and has not begun, for when its page is shown again.
const typed = new Map();
const everywhere = new Map();

// fields: { key, label, kind: number | text | select | switch, value, options, unit, hint, more, pick, required,
// everywhere: typed once, it holds in each form that asks for it }
export function commandForm({ page, command, fields, run = "Begin", values: fixed = {}, onchange = () => {} }) {
  const nameOf = () => (typeof command === "function" ? command(read()) : command);
  const inputs = new Map(fields.map((field) => [field.key, input(field)]));
  const said = make("code", { className: "typed", textContent: " " });
  const fault = note("", "warning");
  fault.hidden = true;
  const start = button(run, begin, { className: "main" });
  const row = (field, element) => rowOf(field, element, write);
  const plain = fields.filter((field) => !field.more).map((field) => row(field, inputs.get(field.key)));
  const more = fields.filter((field) => field.more).map((field) => row(field, inputs.get(field.key)));
  const element = make("form", { className: "form", onsubmit: (event) => { event.preventDefault(); begin(); } },
    make("div", { className: "fields" }, plain),
    more.length ? make("details", {}, make("summary", { textContent: "More" }), make("div", { className: "fields" }, more)) : null,
    make("div", { className: "typing" }, said, start), fault);
  element.addEventListener("input", write);
  const own = [page, typeof command === "string" ? command : "", ...inputs.keys(), JSON.stringify(fixed)].join(" ");
  const left = typed.get(own) ?? new Map();
  typed.set(own, left);
  const placeOf = (key) => (fields.find((field) => field.key === key)?.everywhere ? everywhere : left);
  for (const [key, element] of inputs) if (placeOf(key).has(key)) give(element, placeOf(key).get(key));
  element.addEventListener("input", ({ target }) => placeOf(target.name).set(target.name, target.type === "checkbox" ? target.checked : target.value));

  function read() {
    const values = { ...fixed };
    for (const [key, element] of inputs) {
      const field = fields.find((one) => one.key === key);
      if (field.skip?.(values)) continue;
      values[key] = element.type === "checkbox" ? element.checked : element.value.trim();
    }
    return values;
  }

  function asked() {
    const values = read();
    for (const field of fields) if (field.local) delete values[field.key];
    return { command: nameOf(), values: Object.assign(values, element.also?.(read()) ?? {}), page };
  }

  let last = 0;
  async function write() {
    onchange(read());
    const mine = ++last;
    await new Promise((resolve) => setTimeout(resolve, 150));
    if (mine !== last) return;
    try {
      const { text } = await order("api/command", asked());
      if (mine === last) tell(text, "");
    } catch (error) {
      if (mine === last) tell("", error.message);
    }
  }

  async function begin() {
    if (!element.reportValidity()) return;
    start.disabled = true;
    try {
      tell((await order("api/jobs", asked())).text, "");
      left.clear();
      await refresh();
    } catch (error) {
      tell(said.textContent, error.message);
    }
    start.disabled = false;
  }

  function tell(text, sentence) {
    said.textContent = text || " ";
    fault.textContent = sentence;
    fault.hidden = !sentence;
  }

  element.write = write;
  element.read = read;
  element.set = (key, value) => { inputs.get(key).value = value; write(); };
  // What somebody typed stays, whatever is offered meanwhile.
  element.offer = (key, value) => { if (!placeOf(key).has(key) && inputs.get(key).value !== value) element.set(key, value); };
  element.input = (key) => inputs.get(key);
  element.suggest = (key, names) => inputs.get(key)?.list?.replaceChildren(...names.map((name) => make("option", { value: name })));
  queueMicrotask(write);
  return element;
}

function give(element, value) {
  if (element.type === "checkbox") element.checked = value;
  else element.value = element.dataset.typed = value; // a choice that is not there yet waits for its list
}

function input({ key, kind = "text", value = "", options = [], step = "any", min, max, placeholder = "", required = false }) {
  if (kind === "select") return fill(make("select", { name: key, required }), options, value);
  if (kind === "switch") return make("input", { type: "checkbox", name: key, checked: Boolean(value) });
  const more = kind === "number" ? { type: "number", step, inputMode: "decimal" } : { type: "text" };
  const element = make("input", { name: key, value, placeholder, required, autocomplete: "off", ...more });
  if (min !== undefined) element.min = min;
  if (max !== undefined) element.max = max;
  return element;
}

export function fill(select, options, value) {
  const pairs = options.map((option) => (Array.isArray(option) ? option : [option, option]));
  const before = value ?? (select.value || select.dataset.typed);
  if (!pairs.length) pairs.push(["", "none in this folder yet"]);
  select.replaceChildren(...pairs.map(([key, text]) => make("option", { value: key, textContent: text })));
  if (pairs.some(([key]) => key === before)) select.value = before;
  return select;
}

// The name, or the first with a number behind it, that nothing in the folder has.
export function freeName(name, taken) {
  for (let number = 1; ; number += 1) {
    const tried = number > 1 ? `${name}-${number}` : name;
    if (!taken.includes(tried)) return tried;
  }
}

function rowOf({ label, unit, hint, list, pick }, element, write) {
  return make("label", { className: element.type === "checkbox" ? "check" : "" },
    make("span", { textContent: unit ? `${label} [${unit}]` : label }),
    pick ? make("span", { className: "picked" }, element, picker(element, write)) : element,
    list ? suggestions(element) : null,
    hint ? make("small", { textContent: hint }) : null);
}

// A button that has the next place which is clicked in the model written into its field.
let picking = null;
function picker(element, write) {
  const toggle = button("Pick", () => {
    const isOn = picking?.toggle === toggle;
    stopPicking();
    if (isOn) return;
    picking = { element, toggle, write };
    toggle.setAttribute("aria-pressed", true);
    toggle.textContent = "Click in the model";
  }, { title: "Take the next place that is clicked in the model" });
  return toggle;
}

function stopPicking() {
  picking?.toggle.setAttribute("aria-pressed", false);
  if (picking) picking.toggle.textContent = "Pick";
  picking = null;
}

// Writes a place into the field that waits for one; says whether one did.
export function givePlace(text) {
  if (!picking?.element.isConnected) return false;
  picking.element.value = text;
  picking.write();
  stopPicking();
  return true;
}

// Names that are offered while one is typed; others may be typed, too.
let lists = 0;
function suggestions(element) {
  const list = make("datalist", { id: `names-${lists += 1}` });
  element.setAttribute("list", list.id);
  return list;
}

// A button that brings files into the folder; each answer is one sentence.
export function uploader({ label, accept, multiple = true, nameOf, done = () => {} }) {
  const said = make("small", {});
  const chooser = make("input", { type: "file", accept, multiple, hidden: true, onchange: take });
  async function take() {
    const chosen = [...chooser.files];
    let count = 0, fault = "";
    for (const file of chosen) {
      said.textContent = `${count + 1} of ${chosen.length}: ${file.name} …`;
      try {
        const path = nameOf(file).split("/").map(encodeURIComponent).join("/");
        const answer = await fetch(`api/upload/${path}`, { method: "PUT", body: file });
        if (!answer.ok) throw new Error(await answer.text());
        count += 1;
      } catch (error) {
        fault = error.message;
      }
    }
    said.textContent = `${count} of ${chosen.length} brought. ${fault}`;
    chooser.value = "";
    await refresh();
    done(studio.state);
  }
  return make("div", { className: "bring" }, chooser, button(label, () => chooser.click()), said);
}
