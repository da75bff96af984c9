// The command that does the same in a terminal, and a button that copies it.

import { make } from "./dom.js";

const DIGITS = 5; // behind the point of a metre: as fine as the page's places

// The scan's folder, which holds view/index.html; of a page from elsewhere, or another scan's, a word.
export function folderOf(app) {
  const { protocol, pathname } = window.location;
  if (protocol !== "file:" || app.state.scan !== 0 || !pathname.endsWith("/view/index.html")) return "OUT";
  const path = decodeURIComponent(pathname.slice(0, -"/view/index.html".length));
  return quoted(/^\/[A-Za-z]:/.test(path) ? path.slice(1) : path);
}

export const numbersOf = (place) => place.map((x) => Number(x.toFixed(DIGITS))).join(",");

const quoted = (text) => (/^[\w./:@+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

// A page that shows this one, such as the studio's, may take the measure itself: it is told the command.
const isShownWithin = window.parent !== window;

// Such a page may also want the place that was clicked, in metres.
export function tellPlace(place) {
  if (isShownWithin) window.parent.postMessage({ place: numbersOf(place) }, "*");
}

export function copyButton(text) {
  if (isShownWithin && text.startsWith("murkscan measure ")) {
    return make("button", {
      type: "button", className: "copy", textContent: "Take this measure", title: text,
      onclick: () => window.parent.postMessage({ murkscan: text }, "*"),
    });
  }
  const button = make("button", {
    type: "button", className: "copy", textContent: "Copy as command", title: text,
    onclick: async () => {
      button.textContent = await copy(text) ? "Copied" : "Select it here and copy:";
      if (button.textContent !== "Copied") button.after(make("code", { textContent: text }));
    },
  });
  return button;
}

// Pages opened from a file may not have the clipboard; the old way works there.
async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = make("textarea", { value: text });
    document.body.append(area);
    area.select();
    const isDone = document.execCommand("copy");
    area.remove();
    return isDone;
  }
}
