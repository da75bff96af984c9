// Joins source/*.js and three.js into viewer.js: `make viewer`, from the top of the project.

import { createHash } from "node:crypto";
import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { build } from "esbuild";

const require = createRequire(import.meta.url);
const three = join(dirname(require.resolve("three")), "..");
const digest = createHash("sha256");
const sources = readdirSync("source").sort().map((name) => join("source", name));
for (const file of ["build.js", "package.json", ...sources]) digest.update(readFileSync(file));

await build({
  entryPoints: ["source/main.js"],
  outfile: "viewer.js",
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  legalComments: "none",
  banner: {
    js: `/*! sources ${digest.digest("hex")}\n\nIn this script: three.js\n\n`
      + `${readFileSync(join(three, "LICENSE"), "utf8").trim()}\n*/`,
  },
});
