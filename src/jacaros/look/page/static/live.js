import { Connection } from "./connection.js";

/** A link to the server of the page: a WebSocket. */
function open({ opened, received, closed }) {
  const address = new URL("live", location.href);
  address.protocol = address.protocol.replace("http", "ws");
  address.hash = "";
  const socket = new WebSocket(address);
  socket.addEventListener("open", () => opened(socket));
  socket.addEventListener("message", ({ data }) => received(data));
  socket.addEventListener("close", closed);
}

new Connection(open);
