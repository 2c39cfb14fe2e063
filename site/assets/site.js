// What the theme leaves to do for readers who use a keyboard or a screen reader.

document.addEventListener("DOMContentLoaded", () => {
  // A block of code or a table that is wider than the page scrolls, by the keyboard, too.
  for (const wide of document.querySelectorAll("pre > code, .md-typeset__scrollwrap")) {
    wide.tabIndex = 0;
  }
  for (const [number, menu] of document.querySelectorAll(".md-code__nav").entries()) {
    menu.setAttribute("aria-label", `Code ${number + 1}`);
  }
});

// The menu of versions comes later; its button is named by what it shows.
new MutationObserver((_, observer) => {
  const button = document.querySelector(".md-version__current");
  if (button) {
    button.removeAttribute("aria-label");
    observer.disconnect();
  }
}).observe(document.documentElement, { childList: true, subtree: true });
