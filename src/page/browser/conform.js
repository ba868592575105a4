// All can be read without this: it copies commands, and opens what an address within the page names.

for (const button of document.querySelectorAll(".copy")) {
  const command = button.parentElement.querySelector("code");
  const name = button.textContent;
  button.hidden = false;
  button.addEventListener("click", async () => {
    getSelection().selectAllChildren(command);
    try {
      await navigator.clipboard.writeText(command.textContent);
      button.textContent = "Copied";
    } catch {
      // The browser does not let us: the command is marked, so that a key copies it.
      button.textContent = "Marked";
    }
    setTimeout(() => {
      button.textContent = name;
    }, 2000);
  });
}

/** Not every browser opens what is closed around the element that an address names. */
function openNamed() {
  const named = document.getElementById(location.hash.slice(1));
  const closed = named?.closest("details:not([open])");
  if (!closed) return;
  closed.open = true;
  named.scrollIntoView({ block: "center" });
}

addEventListener("hashchange", openNamed);
openNamed();
