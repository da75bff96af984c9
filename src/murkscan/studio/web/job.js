// What runs, or ran last: the command as it would be typed, how far it is, what it said.

import { listen, order, refresh } from "./ask.js";
import { button, keep, make } from "./dom.js";

const WORDS = { running: "at work", done: "done", refused: "not done", stopped: "stopped", failed: "failed" };
const pageOf = (address) => new URL(address, location.href).hash.slice(1).split("/")[0];
let closed = "", newest = null;

export function showJobs(element) {
  // What is done was seen; on another page it would only take room.
  addEventListener("hashchange", ({ oldURL, newURL }) => {
    if (newest?.state === "done" && pageOf(oldURL) !== pageOf(newURL)) { closed = newest.name; element.hidden = true; }
  });
  listen(({ jobs }) => {
    const job = newest = jobs[0];
    const isShown = job && (job.state === "running" || job.name !== closed) && isRecent(job);
    element.hidden = !isShown;
    if (isShown) keep(element, job, () => describe(job));
  });
}

const isRecent = (job) => job.state === "running" || Date.now() / 1e3 - job.began < 12 * 3600;

function describe(job) {
  const isRunning = job.state === "running";
  return [
    make("div", { className: "line" },
      make("span", { className: `state ${job.state}`, textContent: WORDS[job.state] }),
      make("code", { textContent: job.text }),
      isRunning
        ? job.page === "live" ? make("a", { className: "button", href: "#live", textContent: "To the dive" })  // which takes two clicks to end
          : button("Stop", async () => { await order(`api/jobs/${job.name}/stop`, {}); refresh(); }, { className: "stop" })
        : button("×", () => { closed = job.name; refresh(); }, { className: "quiet", title: "Hide", "aria-label": "Hide" })),
    isRunning && (job.progress || job.page !== "live") ? progress(job.progress) : null,
    job.sentence && job.state !== "done" && !isRunning ? make("p", { className: "sentence", textContent: job.sentence }) : null,
    job.said || job.errors ? make("details", { open: false }, make("summary", { textContent: "What it said" }),
      make("pre", { textContent: job.said + job.errors })) : null,
  ];
}

function progress(told) {
  if (!told) return make("div", { className: "progress" }, make("progress"), make("span", { textContent: "begins …" }));
  const [stage, done, total] = told;
  const bar = total ? make("progress", { max: total, value: done }) : make("progress");
  const text = total ? `${stage}: ${done.toLocaleString()} of ${total.toLocaleString()}` : `${stage}: ${done.toLocaleString()}`;
  return make("div", { className: "progress" }, bar, make("span", { textContent: text }));
}

export const jobsOf = (state, page) => state.jobs.filter((job) => job.page === page);
