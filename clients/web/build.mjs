// Bundles the page, or its unit tests.
//
// usage: node build.mjs FOLDER          the page: index.html, page.js, page.css
//        node build.mjs --tests FOLDER  one program for `node --test` per file of tests/
import { build } from "esbuild";
import { copyFile, mkdir, readdir } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const isTests = process.argv[2] === "--tests";
const folder = process.argv[isTests ? 3 : 2];
if (!folder) {
  console.error("usage: node build.mjs [--tests] FOLDER");
  process.exit(1);
}
await mkdir(folder, { recursive: true });

if (isTests) {
  const names = (await readdir(join(here, "tests"))).filter((name) => name.endsWith(".test.ts"));
  await build({
    entryPoints: names.map((name) => join(here, "tests", name)),
    outdir: folder,
    outExtension: { ".js": ".mjs" },
    bundle: true,
    platform: "node",
    target: "node18",
    format: "esm",
    logLevel: "warning",
  });
} else {
  await build({
    entryPoints: [join(here, "source/page.ts"), join(here, "source/page.css")],
    outdir: folder,
    bundle: true,
    minify: true,
    format: "esm",
    target: "es2022",
    legalComments: "linked", // licences of the libraries: page.js.LEGAL.txt
    logLevel: "warning",
  });
  await copyFile(join(here, "source/index.html"), join(folder, "index.html"));
}
