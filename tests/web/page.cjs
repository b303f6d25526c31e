// Tries the page of scripts/web in Chromium without a graphics card: node page.cjs PAGE PROGRAM PICTURES.
"use strict";
const assert = require("node:assert");
const { execFileSync } = require("node:child_process");
const fs = require("node:fs");
const http = require("node:http");
const os = require("node:os");
const path = require("node:path");
const { chromium } = require("playwright-core");

const [folder, program, pictures] = process.argv.slice(2);
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".png": "image/png" };
// Where things stand in a window of this size, pixels.
const SIZE = { width: 1280, height: 800 };
const HINTS_CLOSED = [677, 218];
const VIEW = { x: 245, y: 240, width: 713, height: 350 };
const GAIN = [[1110, 139], [1070, 139]];
const SWIFTSHADER = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

/** Serves the page as any server of files does. */
function serve() {
  const server = http.createServer((request, answer) => {
    const name = new URL(request.url, "http://page").pathname.replace(/\/$/, "/index.html");
    const file = path.join(folder, name);
    if (!fs.existsSync(file)) return answer.writeHead(404).end();
    answer.writeHead(200, { "content-type": TYPES[path.extname(file)] ?? "application/octet-stream" });
    answer.end(fs.readFileSync(file));
  });
  return new Promise((resolve) => server.listen(0, "localhost", () => resolve(server)));
}

/** The digest that the native program comes to for a scene. */
function digestOf(scene, runs) {
  execFileSync(program, ["run", scene, "-o", runs], { stdio: "ignore" });
  return JSON.parse(fs.readFileSync(path.join(runs, "manifest.json"))).digest;
}

async function main() {
  const server = await serve();
  const home = `http://localhost:${server.address().port}/`;
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: SWIFTSHADER });
  const context = await browser.newContext({ viewport: SIZE, acceptDownloads: true });
  const page = await context.newPage();
  const said = [];
  page.on("console", (message) => said.push(message.text()));
  page.on("pageerror", (error) => said.push(String(error)));
  page.on("request", (request) => {
    if (!request.url().startsWith(home) && !request.url().startsWith("data:") && !request.url().startsWith("blob:"))
      said.push(`a request outside: ${request.url()}`);
  });
  const picture = async (name, clip) => page.screenshot({ path: path.join(pictures, `${name}.png`), clip });
  const differs = async (name, act) => {
    const before = await picture(`${name}-before`, VIEW);
    await act();
    assert(!before.equals(await picture(name, VIEW)), `${name}: the picture has not changed`);
  };
  const work = fs.mkdtempSync(path.join(os.tmpdir(), "page-"));

  await page.goto(home);
  await page.waitForTimeout(4000);
  await page.mouse.click(...HINTS_CLOSED);
  await differs("playing", () => page.waitForTimeout(2000));
  for (const scene of ["circle-three", "seven-v", "cars-yard"]) {
    const text = fs.readFileSync(`scenes/${scene}.toml`, "utf8");
    await differs(scene, async () => {
      await page.evaluate((pasted) => {
        const clipboardData = new DataTransfer();
        clipboardData.setData("text/plain", pasted);
        const paste = new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true });
        (document.activeElement ?? document.body).dispatchEvent(paste);
      }, text);
      await page.waitForTimeout(3000);
    });
    // A gain is dragged while the run goes: a change at its time.
    const [from, to] = GAIN;
    await page.mouse.move(...from);
    await page.mouse.down();
    await page.mouse.move(...to, { steps: 4 });
    await page.mouse.up();
    await page.waitForTimeout(1500);
    await page.keyboard.press("Space");
    await page.waitForTimeout(1500);
    const download = page.waitForEvent("download");
    await page.keyboard.press("k");
    const kept = path.join(work, `${scene}.toml`);
    await (await download).saveAs(kept);
    const [, samples, digest] = fs.readFileSync(kept, "utf8").match(/^# (\d+) samples, digest (\w+)\n/);
    assert.strictEqual(digestOf(kept, path.join(work, scene)), digest, `${scene}: the program comes to another digest`);
    console.log(`${scene}: ${samples} samples, digest ${digest}, the same in the program`);
    await picture(`${scene}-kept`);
    // Its changes go with the file, so that the next scene replaces it without a question.
    const saved = page.waitForEvent("download");
    await page.keyboard.press("Control+s");
    await saved;
    await page.keyboard.press("Space");
  }
  assert.deepStrictEqual(said, [], "the console is silent, and nothing outside is asked for");
  fs.rmSync(work, { recursive: true });
  await browser.close();
  server.close();
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
