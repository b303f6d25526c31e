// Starts the program that `scripts/web` has built: its `main` looks for the canvas.
import start from "./web.js";

// egui's shader holds a second way to filter, for pictures in tests, and dithering, each behind a uniform that is 0 here. A
// processor that draws computes them for every pixel all the same, which costs five times as much as the rest of the window.
const context = globalThis.WebGL2RenderingContext?.prototype;
const take = context?.shaderSource;
if (take) {
  context.shaderSource = function (shader, text) {
    take.call(this, shader, text.replace(/ = \w+\.(predictable_texture_filtering|dithering);/g, " = 0u;"));
  };
}

start().catch((error) => {
  document.getElementById("fault").textContent =
    `The lab cannot be started: ${error}. \`echelon lab\` opens the same window without a browser.`;
});
// An address that is edited names another scene.
addEventListener("hashchange", () => location.reload());
