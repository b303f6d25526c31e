// Under every lesson a button opens its lab. One lab runs at a time: each takes a processor for itself.
let open = null;

for (const section of document.querySelectorAll("section[data-scene]")) {
  const address = `index.html#${section.dataset.scene}`;
  const place = document.createElement("div");
  const button = document.createElement("button");
  button.textContent = "Open the lab here";
  const alone = document.createElement("a");
  alone.href = address;
  alone.textContent = "or in the whole window";
  place.append(button, " ", alone);
  section.append(place);
  button.addEventListener("click", () => {
    open?.();
    const frame = document.createElement("iframe");
    frame.src = address;
    frame.title = `The lab with the scene ${section.dataset.scene}`;
    place.className = "lab";
    place.replaceChildren(frame);
    open = () => {
      place.className = "";
      place.replaceChildren(button, " ", alone);
    };
  });
}
