// How the camera moved: the fields that a scan and a dive share, and the vehicle that a dive listens to.

const WAYS = [["speed-mm-s", "at a speed [mm/s]"], ["step-mm", "by a step a picture [mm]"], ["poses", "by a log of poses"], ["navigation", "by the vehicle’s instruments"]];
const LINK = ["mavlink", "by the vehicle, over MAVLink"];
const isLog = (how) => how === "poses" || how === "navigation";

export const motionFields = (isLive = false) => [
  { key: "how", label: "How the camera moves", kind: "select", local: true, options: isLive ? [...WAYS, LINK] : WAYS },
  { key: "number", label: "Speed or step", kind: "number", local: true },
  { key: "speed-sigma-percent", label: "How well that is known", unit: "%", kind: "number", hint: "1σ; 10 of a speed and 1 of a step unless said", more: true, skip: ({ how }) => isLog(how) },
  { key: "log", label: "Log", local: true, placeholder: "nav.csv", list: [] },
  ...(isLive ? [{ key: "mavlink", label: "Listen to the vehicle at", value: "0.0.0.0:14550", hint: "a speed may stand beside it", skip: ({ how }) => how !== "mavlink" }] : []),
];

export function motionOf({ how, number, log }) {
  if (how === "mavlink") return { "speed-mm-s": number };
  return { [how]: isLog(how) ? log : number };
}

// Shows the fields that the way of moving needs.
export function showMotion(form, how) {
  const shown = { number: !isLog(how), log: isLog(how), mavlink: how === "mavlink" };
  for (const [key, isShown] of Object.entries(shown)) {
    const row = form.input(key)?.closest("label");
    if (row) row.hidden = !isShown;
  }
  form.input("number").required = !isLog(how) && how !== "mavlink";
  // A recording may hold the instruments' log itself.
  form.input("log").required = how === "poses";
}
