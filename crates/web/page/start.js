// Starts the program that `scripts/web` has built: its `main` looks for the canvas.
import start from "./web.js";

const context = globalThis.WebGL2RenderingContext?.prototype;
if (context) {
  withoutUnusedBranches(context);
  withDrawnPictures(context);
}

// A browser that denies storage may deny its locks as well; the lab goes on without.
await holdWork(document.getElementById("lab").dataset).catch(() => {});
start().catch((error) => {
  document.getElementById("fault").textContent =
    `The lab cannot be started: ${error}. \`echelon lab\` opens the same window without a browser.`;
});
// An address that is edited names another scene.
addEventListener("hashchange", () => location.reload());

/**
 * A tab holds the key under which it keeps unsaved work for as long as it is open, so that no other tab offers that work as
 * lost. Browsers have such locks for pages of this machine and for those by https.
 */
async function holdWork(data) {
  // A lab beside the text of a lesson is for trying.
  const embedded = window.self !== window.top;
  data.work = embedded ? "" : `echelon-work-${Date.now()}`;
  if (embedded || !navigator.locks) return;
  const { held } = await navigator.locks.query();
  data.open = held.map((lock) => lock.name).join(" ");
  navigator.locks.request(data.work, () => new Promise(() => {})).catch(() => {});
}

/**
 * egui's shader holds a second way to filter, for pictures in tests, and dithering, each behind a uniform that is 0 here. A
 * processor that draws computes them for every pixel all the same, which costs five times as much as the rest of the window.
 */
function withoutUnusedBranches(context) {
  const take = context.shaderSource;
  context.shaderSource = function (shader, text) {
    take.call(this, shader, text.replace(/ = \w+\.(predictable_texture_filtering|dithering);/g, " = 0u;"));
  };
}

/**
 * wgpu draws a frame into a texture and then copies that, upside down, to the canvas. A processor that draws copies on one
 * core alone; it draws the texture onto the canvas in half that time.
 */
function withDrawnPictures(context) {
  const copy = context.blitFramebuffer;
  const programs = new WeakMap();
  context.blitFramebuffer = function (x0, y0, x1, y1, left, bottom, right, top, mask, filter) {
    const onto = this.getParameter(this.DRAW_FRAMEBUFFER_BINDING);
    const whole = left === 0 && bottom === 0 && right === this.drawingBufferWidth && top === this.drawingBufferHeight;
    const from = this.getFramebufferAttachmentParameter(
      this.READ_FRAMEBUFFER, this.COLOR_ATTACHMENT0, this.FRAMEBUFFER_ATTACHMENT_OBJECT_NAME);
    if (onto !== null || !whole || y0 !== top || y1 !== 0 || !(from instanceof WebGLTexture)) {
      return copy.call(this, x0, y0, x1, y1, left, bottom, right, top, mask, filter);
    }
    if (!programs.has(this)) programs.set(this, flipping(this));
    // wgpu sets all of this anew before it draws again.
    for (const test of [this.DEPTH_TEST, this.STENCIL_TEST, this.SCISSOR_TEST, this.BLEND, this.CULL_FACE]) this.disable(test);
    this.viewport(0, 0, right, top);
    this.colorMask(true, true, true, true);
    this.bindSampler(0, null);
    this.activeTexture(this.TEXTURE0);
    this.bindTexture(this.TEXTURE_2D, from);
    this.useProgram(programs.get(this));
    this.drawArrays(this.TRIANGLES, 0, 3);
  };
}

/** A program that draws a texture upside down over everything, with one triangle. */
function flipping(context) {
  const program = context.createProgram();
  const add = (kind, text) => {
    const shader = context.createShader(kind);
    context.shaderSource(shader, `#version 300 es\n${text}`);
    context.compileShader(shader);
    context.attachShader(program, shader);
  };
  add(context.VERTEX_SHADER, `out vec2 place;
    void main() {
      vec2 corner = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
      place = vec2(corner.x, 1.0 - corner.y);
      gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);
    }`);
  add(context.FRAGMENT_SHADER, `precision highp float;
    in vec2 place;
    uniform sampler2D picture;
    out vec4 colour;
    void main() { colour = texture(picture, place); }`);
  context.linkProgram(program);
  return program;
}
