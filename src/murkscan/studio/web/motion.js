// How the camera moved: the fields that a scan and a dive share.

export const motionFields = [
  { key: "how", label: "How the camera moves", kind: "select", local: true, options: [["speed-mm-s", "at a speed [mm/s]"], ["step-mm", "by a step a picture [mm]"], ["poses", "by a log of poses"], ["navigation", "by the vehicle’s instruments"]] },
  { key: "number", label: "Speed or step", kind: "number", local: true },
  { key: "speed-sigma-percent", label: "How well that is known", unit: "%", kind: "number", hint: "1σ; 10 of a speed and 1 of a step unless said", more: true, skip: ({ how }) => how === "poses" || how === "navigation" },
  { key: "log", label: "Log", local: true, placeholder: "nav.csv, or udp:14550", list: [] },
];

export const motionOf = ({ how, number, log }) => ({ [how]: how === "poses" || how === "navigation" ? log : number });

// Shows the field that the way of moving needs.
export function showMotion(form, how) {
  const isLog = how === "poses" || how === "navigation";
  form.input("number").closest("label").hidden = isLog;
  form.input("log").closest("label").hidden = !isLog;
}
