import { Connection } from "./connection.js";

// The page in a frame of another page, which passes it a port to the worker that has the run.

function linked(port) {
  return ({ opened, received, closed }) => {
    port.onmessage = ({ data }) => (data === null ? closed() : received(data));
    opened({ send: (text) => port.postMessage(text) });
  };
}

addEventListener("message", ({ source, ports }) => {
  if (source === parent && ports.length === 1) new Connection(linked(ports[0]));
}, { once: true });
parent.postMessage("ready", location.origin);
