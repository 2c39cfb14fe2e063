// The full page: a program chosen by the fragment, #NAME, or one from a link, #program=….
const list = document.getElementById("programs"), root = document.querySelector("[data-jacaros-live]");
const known = await fetch(new URL("programs.json", import.meta.url)).then((each) => each.json());
for (const [name, { title }] of Object.entries(known)) {
  const link = document.createElement("a");
  Object.assign(link, { href: `#${name}`, textContent: title });
  list.append(link);
}
const name = decodeURIComponent(location.hash.slice(1));
if (Object.hasOwn(known, name)) root.dataset.jacarosLive = name;
addEventListener("hashchange", () => location.reload());
await import("./live.js");
