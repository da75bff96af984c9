// Opens the page: reads what is in it, or says why it cannot be shown.

import { App } from "./app.js";
import { loadModel } from "./model.js";
import { Stage } from "./stage.js";
import { startTheme } from "./theme.js";

async function open() {
  startTheme();
  const wait = document.getElementById("wait");
  try {
    const content = JSON.parse(document.getElementById("content").textContent);
    if (!("DecompressionStream" in window)) throw new Error("no DecompressionStream");
    const stage = new Stage(document.getElementById("canvas"));
    // The page has no script after it, but the wait must be seen before the work begins.
    await new Promise((resolve) => setTimeout(resolve));
    const models = [];
    for (const [number, about] of content.models.entries()) {
      models.push(await loadModel(about, number, content.models[0].positions.low));
    }
    window.murkscan = new App(content, models, stage);
    wait.remove();
    document.documentElement.dataset.ready = "yes";
  } catch (error) {
    wait.textContent = `This browser cannot show the model (${error.message}). It needs WebGL 2: `
      + "try a newer one, or switch on hardware acceleration.";
    console.error(error);
  }
}

open();
