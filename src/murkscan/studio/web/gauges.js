// What a pilot must see at a glance: gauges with a word, and warnings in sentences.

import { make, note } from "./dom.js";

const TONES = { good: "good", weak: "warning", low: "warning", lost: "bad", full: "bad", "too near": "bad", "too far": "bad", "too fast": "bad", unknown: "plain" };
const WORDS = { "too near": "too near: go back", "too far": "too far: go nearer", "too fast": "too fast: go slower" };

// What the pilot steers by: it stands above the picture.
export function steeringGauges({ stand_off: off, speed, stripe, coverage }) {
  return [
    gauge("Stand-off", off.value_m === null ? "–" : `${off.value_m.toFixed(2)} m`, off.state, scale(off.value_m, off.near_m, off.far_m)),
    gauge("Speed", speed.value_mm_s === null ? "–" : `${speed.value_mm_s.toFixed(0)} mm/s`, speed.state, scale(speed.value_mm_s, 0, speed.highest_mm_s, 0),
      speed.highest_mm_s === null ? "" : `at most ${speed.highest_mm_s.toFixed(0)} mm/s`),
    gauge("Stripe", stripe.signal === null ? "–" : `${stripe.signal.toFixed(0)} grey`, stripe.state, null,
      stripe.share === null ? "" : `in ${(100 * stripe.share).toFixed(0)} % of the lines, noise ${(stripe.noise ?? 0).toFixed(1)}`),
    gauge("Covered", coverage.share === null ? "–" : `${(100 * coverage.share).toFixed(0)} %`, coverage.share === null ? "unknown" : coverage.share > 0.95 ? "good" : "weak", null,
      `${coverage.covered_m2.toFixed(2)} m², ${coverage.missing_m2.toFixed(2)} m² missing`),
  ];
}

// What he looks at now and then.
export function otherGauges({ water, preview, recorded, disk }) {
  return [
    gauge("Water", water.attenuation_per_m === null ? "–" : `c ${water.attenuation_per_m.toFixed(1)} /m`, "unknown", null,
      water.reach_m === null ? "" : `the stripe reaches ${water.reach_m.toFixed(1)} m`),
    gauge("Preview", preview.latency_s === null ? "–" : `${(1e3 * preview.latency_s).toFixed(0)} ms`, "unknown", null,
      `${preview.dropped.toLocaleString()} of ${(preview.frames + preview.dropped).toLocaleString()} frames left out here; all are recorded`),
    gauge("Recorded", clock(recorded.time_s), recorded.losses ? "weak" : "good", null,
      `${(recorded.bytes / 1e6).toFixed(0)} MB${recorded.losses ? `, broken off ${recorded.losses} times` : ""}`),
    gauge("Disk", disk.free_bytes === null ? "–" : `${(disk.free_bytes / 1e9).toFixed(0)} GB`, disk.state, null,
      disk.time_left_s === null ? "" : `enough for ${clock(disk.time_left_s)}`),
  ];
}

export const warningsOf = (status) => status.warnings.map((text) => note(text, "alarm"));

export const clock = (seconds) => {
  const [h, m, s] = [Math.floor(seconds / 3600), Math.floor(seconds / 60) % 60, Math.floor(seconds % 60)];
  return h > 99 ? "days" : `${h ? `${h}:` : ""}${String(m).padStart(h ? 2 : 1, "0")}:${String(s).padStart(2, "0")}`;
};

function gauge(name, value, state, bar, more = "") {
  const tone = TONES[state] ?? "plain";
  const word = WORDS[state] ?? (state === "unknown" ? "" : state);
  return make("div", { className: `gauge ${tone}`, data: { name, state } },
    make("span", { className: "name" }, name, word ? make("b", { textContent: word }) : null),
    make("strong", { textContent: value }), bar, make("small", { textContent: more }));
}

// A needle over what is good; the ends are half as much beyond it again, unless the first is given.
function scale(value, low, high, from = low - (high - low) / 2) {
  if (value === null || low === null || high === null || !(high > low)) return null;
  const span = high + (high - low) / 2 - from;
  const percent = (x) => `${(100 * Math.min(Math.max((x - from) / span, 0), 1)).toFixed(1)}%`;
  const good = make("i", { className: "range" }), needle = make("i", { className: "needle" });
  Object.assign(good.style, { left: percent(low), right: `calc(100% - ${percent(high)})` });
  needle.style.left = percent(value);
  return make("div", { className: "scale" }, good, needle);
}
