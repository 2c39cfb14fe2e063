/** A program in the fragment of an address: JSON, deflated, in base64 for URLs. It never goes to a server. */

const LARGEST = 16_000, LARGEST_TEXT = 64_000;  // characters of the fragment, and of the program in it
const NAME = /^[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}\.(asl|jcm|mas2j|yaml)$/;

/** The fragment of a program; throws an Error if it is too large for a link. */
export async function packed(program) {
  const text = JSON.stringify(program);
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const coded = btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  if (coded.length > LARGEST || text.length > LARGEST_TEXT) throw new Error("The program is too large for a link.");
  return coded;
}

/** The program in a fragment, which may come from anybody; throws an Error if it is not one. */
export async function unpacked(coded) {
  try {
    if (coded.length > LARGEST) throw new Error("too large");
    const bytes = Uint8Array.from(atob(coded.replaceAll("-", "+").replaceAll("_", "/")), (each) => each.charCodeAt(0));
    return checked(JSON.parse(await inflated(bytes)));
  } catch (error) {
    throw new Error(`This link does not contain a program (${error.message}).`);
  }
}

/** Inflate, but not more than a program can have: a few bytes may stand for many. */
async function inflated(bytes) {
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")).getReader(), decoder = new TextDecoder();
  let text = "";
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return text + decoder.decode();
    text += decoder.decode(value, { stream: true });
    if (text.length > LARGEST_TEXT) throw new Error("too large");
  }
}

function checked({ files, main, world, mappings = [], title = "" }) {
  const isText = (each) => typeof each === "string" && each.length <= LARGEST_TEXT;
  if (typeof files !== "object" || files === null || Array.isArray(files)) throw new Error("no files");
  for (const [name, text] of Object.entries(files)) if (!NAME.test(name) || !isText(text)) throw new Error("a file that is not allowed");
  if (!Object.hasOwn(files, main)) throw new Error("no file to run");
  if (!(world === undefined || isText(world)) || !Array.isArray(mappings) || !mappings.every(isText) || !isText(title)) throw new Error("wrong fields");
  return { files, main, world, mappings, title: title.slice(0, 80) };
}
