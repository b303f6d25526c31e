// Tries the lab and the lessons of the book that scripts/book has built, in Chromium without a graphics card:
// node page.cjs BOOK PROGRAM PICTURES.
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
const VIEW = { x: 245, y: 42, width: 713, height: 558 };
const EDGE = { x: 0, y: 325, width: 243, height: 240 };
const NOTICE = { x: 0, y: 36, width: 700, height: 40 };
const HINTS_CLOSED = [677, 218];
const GAIN = [[1110, 139], [1070, 139]];
const TIMELINE = { y: 18, left: 368, right: 1060 };
const RESTORE = [485, 55];
const SWEEP = { tab: [1140, 324], start: [1030, 515], panel: { x: 962, y: 340, width: 316, height: 258 } };
/** Where the selected set point of circle-three stands at the start, in the view of the scene. */
const SET_POINT = [790, 375];
/** Least likeness of a picture of the view and the program's, which lacks the prediction. A tenth of a second later it is 0.3. */
const LIKENESS = 0.9;
const SWIFTSHADER = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const WEBGPU = ["--enable-unsafe-webgpu", "--enable-features=Vulkan", "--use-vulkan=swiftshader", "--use-webgpu-adapter=swiftshader"];
const CLIPBOARD = ["clipboard-read", "clipboard-write"];
const work = fs.mkdtempSync(path.join(os.tmpdir(), "page-"));

/** Serves the book as any server of files does. */
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

/** What the program prints. */
const echelon = (...words) => execFileSync(program, words, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });

/** The digest that the native program comes to for a scene. */
function digestOf(scene, runs) {
  echelon("run", scene, "-o", runs);
  return JSON.parse(fs.readFileSync(path.join(runs, "manifest.json"))).digest;
}

/** A tab with the lab. */
class Tab {
  static async open(context, address, said) {
    const page = await context.newPage();
    page.on("console", (message) => said.push(message.text()));
    page.on("pageerror", (error) => said.push(String(error)));
    page.on("request", (request) => {
      const inside = [new URL(address).origin, "data:", "blob:"];
      if (!inside.some((start) => request.url().startsWith(start))) said.push(`a request outside: ${request.url()}`);
    });
    await page.goto(address);
    const tab = new Tab(page);
    await tab.until("it runs", (state) => state.time > 0);
    return tab;
  }

  constructor(page) {
    this.page = page;
  }

  /** What the lab says of itself: title, time in s, whether it plays, its branch, and the line of its status. */
  async state() {
    const words = (await this.page.locator("#lab").getAttribute("aria-label")) ?? "";
    const [, title, time, moves, branch, status] = words.match(/^(.*): ([\d.]+) s, (\w+), branch ([^.]*)(?:\. (.*))?$/) ?? [];
    return { title, time: Number(time), plays: moves === "playing", branch, status: status ?? "" };
  }

  async until(what, holds) {
    for (let tries = 0; tries < 300; tries++) {
      const state = await this.state();
      if (holds(state)) return state;
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
    throw new Error(`never: ${what}; it says ${JSON.stringify(await this.state())}`);
  }

  picture(name, clip) {
    return this.page.screenshot({ path: path.join(pictures, `${name}.png`), clip });
  }

  async differs(name, clip, act) {
    const before = await this.picture(`${name}-before`, clip);
    await act();
    for (let tries = 0; tries < 50; tries++) {
      if (!before.equals(await this.picture(name, clip))) return;
      await this.page.waitForTimeout(100);
    }
    throw new Error(`${name}: the picture has not changed`);
  }

  async drag([from, to]) {
    await this.page.mouse.move(...from);
    await this.page.mouse.down();
    await this.page.mouse.move(...to, { steps: 4 });
    await this.page.waitForTimeout(500);
    await this.page.mouse.up();
  }

  /** What comes down when a key is pressed. */
  async download(key, name) {
    const download = this.page.waitForEvent("download");
    await this.page.keyboard.press(key);
    const file = path.join(work, name);
    await (await download).saveAs(file);
    return file;
  }

  /** Keeps the run, whose digest is that of the program, and saves the scene, so that nothing is left to ask about. */
  async keep(scene) {
    const kept = await this.download("k", `${scene}.toml`);
    const [, samples, digest] = fs.readFileSync(kept, "utf8").match(/^# (\d+) samples, digest (\w+)\n/);
    assert.strictEqual(digestOf(kept, path.join(work, scene)), digest, `${scene}: the program comes to another digest`);
    console.log(`${scene}: ${samples} samples, digest ${digest}, the same in the program`);
    await this.download("Control+s", `${scene}-saved.toml`);
    return kept;
  }
}

/** A shipped scene of the address: a gain is dragged while it goes, and the run is that of the program; so is the picture. */
async function runsAsTheProgram(context, home, said, scene) {
  const tab = await Tab.open(context, `${home}#${scene}`, said);
  await tab.page.mouse.click(...HINTS_CLOSED);
  await tab.differs(`${scene}-playing`, VIEW, () => tab.until("it goes on", (state) => state.time > 1));
  await tab.drag(GAIN);
  const { time } = await tab.state();
  await tab.until("it goes on", (state) => state.time > time + 0.5);
  await tab.page.keyboard.press("Space");
  const paused = await tab.until("it pauses", (state) => !state.plays);
  await tab.page.waitForTimeout(1000);
  await tab.picture(`${scene}-paused`);
  const drawn = await tab.download("p", `${scene}.png`);
  await provesItself(context, tab, said, scene);
  const kept = await tab.keep(scene);
  assert.strictEqual((await tab.state()).time, paused.time);
  drawnAlike(scene, drawn, kept, paused.time);
  await tab.page.close();
}

/** A picture that the page has drawn of a scene at a time is that of the program. */
function drawnAlike(name, drawn, scene, at) {
  const wanted = path.join(work, `${name}-wanted`);
  echelon("capture", scene, "--at", String(at), "--view", "snake", "--without", "inset", "--size", "1920x1080", "-o", wanted);
  const [picture] = fs.readdirSync(wanted).filter((file) => file.endsWith(".png"));
  fs.copyFileSync(drawn, path.join(pictures, `${name}-drawn.png`));
  fs.copyFileSync(path.join(wanted, picture), path.join(pictures, `${name}-wanted.png`));
  const compared = JSON.parse(echelon("compare", path.join(wanted, picture), drawn, "--threshold", "0", "--json"));
  const [{ likeness }] = compared.pictures;
  console.log(`${name}: at ${at} s its picture and the program's are alike by ${likeness.toFixed(3)}`);
  assert(likeness > LIKENESS, `${name}: the picture is not that of the program`);
}

/** Where the browser has a graphics card for WebGPU; here a processor passes itself off as one. */
async function drawsWithWebGpu(home, said) {
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: [...SWIFTSHADER, ...WEBGPU] });
  const context = await browser.newContext({ viewport: SIZE, acceptDownloads: true });
  await context.addInitScript(() => {
    const parameter = WebGL2RenderingContext.prototype.getParameter;
    WebGL2RenderingContext.prototype.getParameter = function (name) {
      const unmasked = 0x9246;
      return name === unmasked ? "A graphics card" : parameter.call(this, name);
    };
    const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...options) {
      globalThis.drawnWith = kind;
      return get.call(this, kind, ...options);
    };
  });
  const tab = await Tab.open(context, `${home}#line-three`, said);
  assert.strictEqual(await tab.page.evaluate(() => globalThis.drawnWith), "webgpu");
  await tab.page.keyboard.press("Space");
  const paused = await tab.until("it pauses", (state) => !state.plays);
  await tab.page.waitForTimeout(1000);
  await tab.picture("webgpu-paused");
  drawnAlike("webgpu", await tab.download("p", "webgpu.png"), "line-three", paused.time);
  await browser.close();
}

/** The link that *Share* copies leads another page, and the program, to the same run; one that was tampered with does not. */
async function provesItself(context, tab, said, scene) {
  await tab.page.keyboard.press("l");
  await tab.until("a link is copied", (state) => state.status.includes("copied"));
  const link = await tab.page.evaluate(() => navigator.clipboard.readText());
  assert.match(link, new RegExp(`#${scene}\\?`), "a readable link");
  assert.match(echelon("run", link, "--no-record"), /the same run, bit for bit/);
  const { time } = await tab.state();
  const other = await Tab.open(context, link, said);
  const opened = await other.until("it compares", (state) => state.status.startsWith("Link: "));
  assert.match(opened.status, /^Link: the same run, bit for bit, up to t = /);
  assert.strictEqual(opened.time, time);
  assert(!opened.status.includes("is offered"), "nobody offers the work of a tab that is open");
  await other.page.waitForTimeout(1000);
  await other.picture(`${scene}-shared`);
  await other.page.close({ runBeforeUnload: false });
  if (scene !== "circle-three") return;
  const wrong = await Tab.open(context, link.replace(/&d=\w+/, "&d=00000000"), said);
  await wrong.until("it differs", (state) => state.status.startsWith("Link: DIFFERENT"));
  await wrong.picture("tampered-link");
  await wrong.page.close({ runBeforeUnload: false });
}

/** A tab that sleeps for an hour goes on where it was. */
async function sleeps(browser, home, said) {
  const context = await browser.newContext({ viewport: SIZE });
  await context.addInitScript(() => {
    for (const clock of [Performance.prototype, Date]) {
      const now = clock.now;
      clock.now = function () {
        return now.call(this) + (globalThis.slept ?? 0);
      };
    }
  });
  const tab = await Tab.open(context, `${home}#circle-three`, said);
  const session = await context.newCDPSession(tab.page);
  await session.send("Page.setWebLifecycleState", { state: "frozen" });
  const before = await tab.state();
  await session.send("Page.setWebLifecycleState", { state: "active" });
  await tab.page.evaluate(() => {
    globalThis.slept = 3_600_000;
  });
  const after = await tab.until("it goes on", (state) => state.time > before.time + 0.3);
  assert(after.plays && after.time < before.time + 5, `it slept: ${before.time} s, and then ${after.time} s`);
  await context.close();
}

/** Somebody drags a set point, looks back, branches, closes the tab and finds the work again. */
async function worksByHand(context, home, said) {
  const tab = await Tab.open(context, `${home}#circle-three`, said);
  const { page } = tab;
  await page.keyboard.press("Space");
  await page.keyboard.press("Shift+Home");
  await tab.until("it stands at the start", (state) => !state.plays && state.time < 0.02);
  // The numbers of the edge change, and in the view the ghosts.
  await tab.differs("set-point-numbers", EDGE, () =>
    tab.differs("set-point", VIEW, () => tab.drag([SET_POINT, [SET_POINT[0] + 60, SET_POINT[1] + 30]])));
  await page.waitForTimeout(1000);
  await tab.picture("set-point-dropped");
  await page.keyboard.press("Space");
  await tab.until("it goes on", (state) => state.time > 1.5);
  await page.keyboard.press("Space");
  await tab.until("it pauses", (state) => !state.plays);
  const { left, right, y } = TIMELINE;
  await tab.drag([[left + 0.06 * (right - left), y], [left + 0.03 * (right - left), y]]);
  const back = await tab.until("it looks back", (state) => state.time < 1);
  await page.keyboard.press("b");
  const branched = await tab.until("it branches", (state) => state.branch !== back.branch);
  assert(branched.time <= back.time + 0.02, "the branch begins where one looked");
  await page.keyboard.press("Space");
  await tab.until("the branch goes on", (state) => state.time > back.time + 0.5);
  await page.keyboard.press("Space");
  await tab.picture("branch");
  // The autosave comes within a second of the change.
  await page.waitForTimeout(1500);
  const asked = page.waitForEvent("dialog");
  await page.close({ runBeforeUnload: true });
  const dialog = await asked;
  assert.strictEqual(dialog.type(), "beforeunload");
  const closed = page.waitForEvent("close");
  await dialog.accept();
  await closed;
  const next = await Tab.open(context, `${home}#peaking`, said);
  assert.match((await next.state()).status, /is offered$/);
  await next.differs("work-offered", NOTICE, async () => {
    await next.picture("work-offered-whole");
    await next.page.mouse.click(...RESTORE);
    await next.until("the work is back", (state) => state.title === back.title);
  });
  const text = fs.readFileSync("scenes/seven-v.toml", "utf8");
  await next.page.evaluate((text) => navigator.clipboard.writeText(text), text);
  const saved = fs.readFileSync(await next.download("Control+s", "recovered.toml"), "utf8");
  assert.notStrictEqual(saved, fs.readFileSync("scenes/circle-three.toml", "utf8"), "the change is in the work that is restored");
  await next.page.keyboard.press("Control+v");
  await next.until("the pasted scene opens", (state) => state.title === "A V of seven");
  await next.page.close({ runBeforeUnload: false });
}

/** Runs of a sweep are made between frames, and the scene goes on meanwhile. */
async function sweeps(context, home, said) {
  const tab = await Tab.open(context, `${home}#circle-three`, said);
  await tab.page.mouse.click(...SWEEP.tab);
  await tab.page.waitForTimeout(500);
  await tab.picture("sweep-panel");
  await tab.differs("sweep-map", SWEEP.panel, () => tab.page.mouse.click(...SWEEP.start));
  const { time } = await tab.state();
  // Its last run was made where its map and its count stay as they are.
  let [last, same] = [null, 0];
  for (let seconds = 0; same < 5 && seconds < 120; seconds++) {
    await tab.page.waitForTimeout(1000);
    const now = await tab.picture("sweep-done", SWEEP.panel);
    [last, same] = [now, last && now.equals(last) ? same + 1 : 0];
  }
  assert(same >= 5, "the sweep never ends");
  assert((await tab.state()).time > time + 1, "the run has not gone on beside the sweep");
  await tab.page.close({ runBeforeUnload: false });
}

/** Every command of the lessons has a button that opens its lab beside the text, and its link leads to a run. */
async function teaches(context, home, said) {
  const page = await context.newPage();
  page.on("console", (message) => said.push(message.text()));
  page.on("pageerror", (error) => said.push(String(error)));
  await page.goto(new URL("../lessons.html", home).href);
  const buttons = page.locator("button.live-lab");
  const commands = await page.locator("main code", { hasText: /^echelon lab '#/ }).allTextContents();
  assert(commands.length >= 8 && (await buttons.count()) === commands.length, `${commands.length} labs in the lessons`);
  for (const [index, command] of commands.entries()) {
    await buttons.nth(index).click();
    const lab = new Tab(page.frameLocator("div.live-lab iframe"));
    const link = command.match(/'(#.*)'/)[1];
    await lab.until(`${link} runs`, (state) => state.time > 0);
    assert.strictEqual(await page.locator("iframe").count(), 1, "one lab at a time");
    await page.waitForTimeout(500);
    await page.screenshot({ path: path.join(pictures, `lesson-${index + 1}.png`) });
  }
  console.log(`${commands.length} labs of the lessons run`);
  await page.close({ runBeforeUnload: false });
}

/** A telephone: a narrow window, and two fingers. */
async function fitsTelephones(browser, home, said) {
  const context = await browser.newContext({ viewport: { width: 320, height: 480 }, hasTouch: true, isMobile: true });
  const tab = await Tab.open(context, `${home}#line-three`, said);
  await tab.page.waitForTimeout(1000);
  await tab.page.touchscreen.tap(17, 18);
  await tab.until("it pauses", (state) => !state.plays);
  await tab.page.waitForTimeout(1000);
  const view = { x: 0, y: 42, width: 320, height: 200 };
  const session = await context.newCDPSession(tab.page);
  const touch = (type, places) =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints: places.map(([x, y], id) => ({ x, y, id })) });
  await tab.differs("telephone", view, async () => {
    await touch("touchStart", [[140, 140], [180, 140]]);
    for (let step = 1; step <= 5; step++) {
      await touch("touchMove", [[140 - 12 * step, 140], [180 + 12 * step, 140]]);
      await tab.page.waitForTimeout(60);
    }
    await touch("touchEnd", []);
  });
  await tab.picture("telephone-whole");
  await context.close();
}

/** Where the browser gives less than it could, the page says so. */
async function saysWhatIsMissing(browser, home, said) {
  const context = await browser.newContext({ viewport: SIZE });
  await context.addInitScript(() => {
    const denied = { get: () => { throw new DOMException("denied", "SecurityError"); } };
    Object.defineProperty(window, "localStorage", denied);
    LockManager.prototype.query = LockManager.prototype.request = () => Promise.reject(new DOMException("denied", "SecurityError"));
  });
  const tab = await Tab.open(context, `${home}#circle-three`, said);
  await tab.until("it runs without storage", (state) => state.time > 0.2);
  await context.close();
  const blind = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--disable-3d-apis"] });
  const page = await (await blind.newContext({ viewport: SIZE })).newPage();
  await page.goto(home);
  await page.waitForFunction(() => document.getElementById("fault").textContent !== "");
  const words = await page.textContent("#fault");
  assert.match(words, /WebGL 2.*`echelon lab`/s);
  await page.screenshot({ path: path.join(pictures, "no-webgl.png") });
  await blind.close();
}

async function main() {
  const server = await serve();
  const home = `http://localhost:${server.address().port}/lab/`;
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: SWIFTSHADER });
  const context = await browser.newContext({ viewport: SIZE, acceptDownloads: true, permissions: CLIPBOARD });
  const said = [];
  for (const scene of ["circle-three", "seven-v", "cars-yard"]) await runsAsTheProgram(context, home, said, scene);
  await worksByHand(context, home, said);
  await sweeps(context, home, said);
  await teaches(context, home, said);
  await sleeps(browser, home, said);
  await drawsWithWebGpu(home, said);
  await fitsTelephones(browser, home, said);
  await saysWhatIsMissing(browser, home, said);
  assert.deepStrictEqual(said, [], "the console is silent, and nothing outside is asked for");
  fs.rmSync(work, { recursive: true });
  await browser.close();
  server.close();
}

main().catch((error) => {
  console.error(error.stderr ?? error);
  console.error(error.stdout ?? "");
  process.exit(1);
});
