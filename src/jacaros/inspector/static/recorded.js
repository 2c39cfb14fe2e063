import { NO_COMMANDS, fragment, startPage } from "./main.js";

/** The records inside the page: lines of JSON, gzipped, in base64. */
async function records() {
  const text = document.getElementById("recording").textContent.trim();
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const lines = (await new Response(stream).text()).split("\n");
  return lines.filter(Boolean).map((line) => JSON.parse(line));
}

const page = startPage({ live: false, commands: NO_COMMANDS });
page.setTitle(document.title);
try {
  page.run.addAll(await records());
  page.time.go(Number(fragment().get("t")) || 0);
  page.show();
} catch (error) {
  const old = typeof DecompressionStream === "undefined";
  page.notice(old ? "This browser is too old for this page: it lacks DecompressionStream."
    : `The recording cannot be read: ${error.message}`);
}
