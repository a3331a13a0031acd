// SPDX-License-Identifier: MIT
// Bundles the page, or its unit tests.
//
// usage: node build.mjs FOLDER          the page: index.html, page-HASH.js, page-HASH.css, each in gzip, too; and player.html, the
//                                       same in one file
//        node build.mjs --tests FOLDER  one program for `node --test` per file of tests/
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { mkdir, readFile, readdir, rm, writeFile } from "node:fs/promises";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

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
  for (const name of await readdir(folder)) if (/^(page|worker)[-.\w]*\.(js|css)(\.gz)?$/.test(name)) await rm(join(folder, name));
  const { metafile } = await build({
    entryPoints: [join(here, "source/page.ts"), join(here, "source/worker.ts"), join(here, "source/page.css")],
    outdir: folder,
    entryNames: "[name]-[hash]", // browsers keep what has another name when it changes
    bundle: true,
    minify: true,
    format: "esm",
    target: "es2022",
    legalComments: "none", // see licences.txt
    metafile: true,
    logLevel: "warning",
  });
  await writeFile(join(folder, "licences.txt"), await licencesOf(metafile));
  const names = Object.keys(metafile.outputs).map((path) => basename(path));
  const [script, worker, style] = [/^page.*\.js$/, /^worker/, /\.css$/].map((form) => names.find((name) => form.test(name)));
  await writeFile(join(folder, "index.html"), await makePage(script, worker, style));
  for (const name of ["index.html", script, style]) {
    await writeFile(join(folder, `${name}.gz`), gzipSync(await readFile(join(folder, name)), { level: 9 }));
  }
  await writeFile(join(folder, "player.html"), await makePlayer(folder, script, style));
}

function replaced(text, from, to) {
  if (!from.test(text)) throw new Error(`index.html has no ${from}`);
  return text.replace(from, () => to);
}

/** The page with the names of its files. */
async function makePage(script, worker, style) {
  let page = replaced(await readFile(join(here, "source/index.html"), "utf8"), /(?<=href=")page\.css/, style);
  page = replaced(page, /(?<=data-worker=")worker\.js/, worker);
  return replaced(page, /(?<=src=")page\.js/, script);
}

/** The licences of all libraries that are in the bundle. */
async function licencesOf({ inputs }) {
  const names = new Set(Object.keys(inputs).map((path) => /.*node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(path)?.[1]).filter(Boolean));
  const texts = [...names].sort().map(async (name) => {
    const library = join(here, "node_modules", name);
    const { version, license, author } = JSON.parse(await readFile(join(library, "package.json"), "utf8"));
    const file = (await readdir(library)).find((entry) => /^licen[cs]e/i.test(entry));
    const text = file ? await readFile(join(library, file), "utf8") : `Copyright ${author?.name ?? author ?? ""}`;
    return `${name} ${version}, ${license}\n\n${text.trim()}\n`;
  });
  return (await Promise.all(texts)).join(`\n${"-".repeat(72)}\n\n`);
}

/**
 * The page in one file, which plays a recording without a server: `ziggurat export --html` puts the recording in the
 * place of @RECORDING@. Its security policy allows its own script and style, by their hashes, and no network.
 */
async function makePlayer(folder, scriptName, styleName) {
  // In a script element, only "</script" and "<!--" end or change it.
  const script = (await readFile(join(folder, scriptName), "utf8")).replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
  const style = await readFile(join(folder, styleName), "utf8");
  const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
  const policy = `default-src 'none'; script-src ${hash(script)}; style-src ${hash(style)}; img-src data: blob:; `
    + "base-uri 'none'; form-action 'none'";
  const page = await readFile(join(here, "source/index.html"), "utf8");
  let player = replaced(page, /(?<=Security-Policy" content=")[^"]*/, policy);
  player = replaced(player, /<link rel="stylesheet"[^>]*>/, `<style>${style}</style>`);
  return replaced(player, /<script type="module"[^>]*><\/script>/,
    `<!--@RECORDING@-->\n<script type="module">${script}</script>\n`
    + `<!--\n${(await readFile(join(folder, "licences.txt"), "utf8")).replaceAll(/-{2,}|[<>]/g, " ")}-->`);
}
