// The live page of a run, in a tab of the editor.
const net = require("net");
const crypto = require("crypto");
const vscode = require("vscode");
const { runTask } = require("./tasks");

const ATTEMPTS = 240;
const PAUSE = 250;

/** Run a program with its live page, and show the page beside the program once it is served. */
async function runWithPage(uri, options) {
  const port = await freePort();
  const token = crypto.randomBytes(24).toString("base64url");
  const args = [uri.fsPath, "--view", "--view-in-frame", "--view-port", String(port), ...options];
  const run = await runTask("run", args, uri, { JACAROS_VIEW_TOKEN: token });
  if (!(await served(port, run))) return;
  const address = vscode.Uri.parse(`http://127.0.0.1:${port}/${token}/`);
  const remote = vscode.env.remoteName && vscode.env.uiKind === vscode.UIKind.Desktop;
  show(remote ? await vscode.env.asExternalUri(address) : address, uri);
}

function freePort() {
  return new Promise((resolve, reject) => {
    const server = net.createServer().on("error", reject);
    server.listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

/** Wait until a port accepts connections; return whether it does before the run ends. */
async function served(port, run) {
  let running = true;
  const ended = vscode.tasks.onDidEndTask((event) => (running &&= event.execution !== run));
  try {
    for (let left = ATTEMPTS; running && left > 0; left--) {
      if (await accepts(port)) return true;
      await new Promise((resolve) => setTimeout(resolve, PAUSE));
    }
    return false;
  } finally {
    ended.dispose();
  }
}

function accepts(port) {
  return new Promise((resolve) => {
    const socket = net.connect(port, "127.0.0.1", () => resolve(true) || socket.destroy());
    socket.on("error", () => resolve(false));
  });
}

function show(address, uri) {
  const name = uri.path.split("/").pop();
  const options = { enableScripts: true, retainContextWhenHidden: true };
  const panel = vscode.window.createWebviewPanel("jacaros.page", `Run: ${name}`, { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true }, options);
  const source = address.toString(true);
  const origin = `${address.scheme}://${address.authority}`;
  panel.webview.html = `<!DOCTYPE html><html><head>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; frame-src ${origin}; style-src 'unsafe-inline'">
<style>html, body, iframe { margin: 0; padding: 0; border: 0; width: 100%; height: 100vh; display: block; }</style>
</head><body><iframe title="Live page of ${name.replace(/[<>&"]/g, "")}" src="${source}"></iframe></body></html>`;
}

module.exports = { runWithPage };
