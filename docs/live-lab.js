// Where the book names a command such as `echelon lab '#peaking'`, a button opens that lab beside the text, if the book was
// built with the lab in it. One lab runs at a time: each takes a processor for itself.
"use strict";
{
  let close = () => {};
  for (const command of document.querySelectorAll("main code")) {
    const link = command.textContent.match(/^echelon lab '(#.*)'$/)?.[1];
    if (!link) continue;
    const address = `lab/index.html${link}`;
    const button = document.createElement("button");
    button.className = "live-lab";
    button.textContent = "▶ open";
    button.title = "Opens this lab here";
    command.after(" ", button);
    button.addEventListener("click", async () => {
      close();
      const place = document.createElement("div");
      place.className = "live-lab";
      command.closest("p, ul, ol").after(place);
      close = () => place.remove();
      const found = await fetch("lab/index.html", { method: "HEAD" }).then((answer) => answer.ok, () => false);
      if (!found) {
        place.textContent = "This book was built without the lab: scripts/book builds it with the lab, and a server of files has to serve it.";
        return;
      }
      const frame = document.createElement("iframe");
      frame.src = address;
      frame.title = `The lab with ${link}`;
      const alone = document.createElement("a");
      alone.href = address;
      alone.target = "_blank";
      alone.textContent = "in a window of its own";
      const shut = document.createElement("button");
      shut.textContent = "close";
      shut.addEventListener("click", () => {
        close();
        command.scrollIntoView({ block: "nearest" });
      });
      place.append(frame, alone, " ", shut);
      place.scrollIntoView({ block: "nearest" });
    });
  }
}
