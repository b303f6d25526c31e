// Starts the program that `scripts/web` has built: its `main` looks for the canvas.
import start from "./web.js";

start().catch((error) => {
  document.getElementById("fault").textContent = `The lab cannot be started: ${error}`;
});
