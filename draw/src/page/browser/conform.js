// The page is readable without this script. It copies commands, and opens the target of a link.

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
      // The browser does not allow it: select the command, so that a key copies it.
      button.textContent = "Marked";
    }
    setTimeout(() => {
      button.textContent = name;
    }, 2000);
  });
}

/** Not every browser opens the closed elements around the target of a link. */
function openNamed() {
  const named = document.getElementById(location.hash.slice(1));
  const closed = named?.closest("details:not([open])");
  if (!closed) return;
  closed.open = true;
  named.scrollIntoView({ block: "center" });
}

addEventListener("hashchange", openNamed);
openNamed();
