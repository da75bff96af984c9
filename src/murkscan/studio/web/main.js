// The frame: pages by the part of the address behind #, what runs, day and night.

import { watch } from "./ask.js";
import { make } from "./dom.js";
import { calibratePage } from "./calibrate.js";
import { showJobs } from "./job.js";
import { livePage } from "./live.js";
import { lookPage } from "./look.js";
import { planPage } from "./plan.js";
import { rigPage } from "./rig.js";
import { startTheme } from "./theme.js";

const PAGES = {
  rig: ["Rig", rigPage],
  calibrate: ["Calibrate", calibratePage],
  live: ["Live", livePage],
  look: ["Look", lookPage],
  plan: ["Plan", planPage],
};
let leave = () => {}, shown = "";

const tabs = Object.entries(PAGES).map(([name, [title]]) => make("a", { href: `#${name}`, textContent: title, data: { name } }));
document.getElementById("tabs").append(...tabs);

function show() {
  const [name, ...rest] = location.hash.slice(1).split("/").map(decodeURIComponent);
  const known = PAGES[name] ? name : "rig";
  const address = [known, ...rest].join("/");
  if (address === shown) return; // an address of the same page; what was typed stays
  shown = address;
  const [title, page] = PAGES[known];
  for (const tab of tabs) tab.toggleAttribute("aria-current", tab.dataset.name === known);
  document.title = `${title} – murkscan studio`;
  leave();
  const main = document.getElementById("page");
  main.replaceChildren();
  leave = page(main, rest) ?? (() => {});
  scrollTo(0, 0);
}

addEventListener("hashchange", show);
startTheme(document.getElementById("theme"));
showJobs(document.getElementById("job"));
show();
watch();
document.documentElement.dataset.ready = "yes";
