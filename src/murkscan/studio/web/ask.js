// Questions to the studio's server, by addresses relative to the page, which carry its token.

class Refusal extends Error {}

export async function ask(path, options = {}) {
  let answer;
  try {
    answer = await fetch(path, { cache: "no-store", ...options });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Error("The studio does not answer.");
  }
  if (answer.status === 503) {
    await new Promise((resolve) => setTimeout(resolve, 500));
    return ask(path, options);
  }
  if (!answer.ok) throw new Refusal(await answer.text());
  return answer.json();
}

export const isRefusal = (error) => error instanceof Refusal;

export const question = (path, values) => `${path}?${new URLSearchParams(values)}`;

export const order = (path, content) => ask(path, {
  method: "POST", body: JSON.stringify(content), headers: { "content-type": "application/json" },
});

export const addressOf = (name) => `files/${name.split("?")[0].split("/").map(encodeURIComponent).join("/")}`
  + (name.includes("?") ? `?${name.split("?").at(-1)}` : "");

// What the folder holds and what runs: asked for each second, told to whoever listens.
const PATIENCE = 5000;
const listeners = new Set();
export const studio = { state: null, isGone: false };

export function listen(listener) {
  listeners.add(listener);
  if (studio.state) listener(studio.state);
  return () => listeners.delete(listener);
}

export async function refresh() {
  try {
    // A server that is asleep takes the question, and never answers it.
    studio.state = await ask("api/folder", { signal: AbortSignal.timeout(PATIENCE) });
    studio.isGone = false;
  } catch {
    studio.isGone = true;
  }
  const banner = document.getElementById("gone");
  banner.hidden = !studio.isGone;
  banner.textContent = "The studio does not answer. What it had begun goes on without it; this page goes on when "
    + "`murkscan studio` runs again at this address.";
  if (!studio.isGone) for (const listener of [...listeners]) listener(studio.state);
}

export async function watch() {
  for (;;) {
    await refresh();
    const isBusy = studio.state?.jobs.some((job) => job.state === "running");
    await new Promise((resolve) => setTimeout(resolve, studio.isGone || isBusy ? 1000 : 2000));
  }
}
