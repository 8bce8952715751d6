// Bundles the pages: each one HTML file with its script and style inside, and the hashes of both in its content security policy.
// Usage: node build.mjs FOLDER_OF_NODE_MODULES PAGE.html LIVE.html
import { createHash } from "node:crypto";
import { readFile, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const [modules, page, live] = process.argv.slice(2);
const esbuild = createRequire(join(resolve(modules), "package.json"))("esbuild");

async function bundled(entry) {
  const built = await esbuild.build({
    entryPoints: [join(here, "src", entry)],
    nodePaths: [join(resolve(modules), "node_modules")],
    bundle: true,
    minify: true,
    write: false,
    charset: "utf8",
    target: ["chrome109", "firefox115", "safari16"],
    legalComments: "none",
    logLevel: "warning",
  });
  // What stands in an element may not end it.
  return built.outputFiles[0].text.trim().replaceAll("</script", "<\\/script");
}

const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

/** @param more  Of its policy. */
async function write(out, name, entry, more) {
  const [markup, script, style] = await Promise.all([
    readFile(join(here, "src", name), "utf8"),
    bundled(entry),
    bundled("style.css"),
  ]);
  const policy = [
    "default-src 'none'",
    `script-src ${hash(script)}`,
    `style-src-elem ${hash(style)}`,
    "style-src-attr 'unsafe-inline'", // the plotting library places its elements by style attributes
    "img-src data: blob:",
    "base-uri 'none'",
    "form-action 'none'",
    ...more,
  ].join("; ");
  const parts = { "<!--POLICY-->": policy, "<!--STYLE-->": style, "<!--SCRIPT-->": script };
  await writeFile(out, markup.replace(/<!--(POLICY|STYLE|SCRIPT)-->/g, (mark) => parts[mark]));
}

await Promise.all([
  write(page, "page.html", "main.js", []),
  write(live, "live.html", "live.js", ["connect-src 'self'"]), // its program, and nobody else
]);
