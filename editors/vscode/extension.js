// JaCaROS in VS Code: starts the language server, the debugger, and runs.
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");
const { adapter, configurationFor, configurations } = require("./debugging");
const { runWithPage } = require("./page");
const { complain, problemOf, pythonFor } = require("./python");
const { provider, runTask } = require("./tasks");

const LANGUAGES = ["agentspeak", "mas2j", "jcm", "yaml"];

let client;
let answers;

async function start() {
  const uri = vscode.window.activeTextEditor?.document.uri;
  const command = await pythonFor(uri);
  const problem = await problemOf(command, "lsp");
  if (problem) return complain(problem);
  client = new LanguageClient("jacaros", "JaCaROS", { command, args: ["-m", "jacaros", "lsp"] }, {
    documentSelector: LANGUAGES.map((language) => ({ scheme: "file", language })),
    synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher("**/*.{asl,mas2j,jcm,yaml,py}") },
  });
  await client.start();
}

async function stop() {
  const old = client;
  client = undefined;
  await old?.stop().catch(() => {});
}

/** Return the file that a command is about: its argument (code lenses pass a string), or the one in the editor. */
function fileOf(argument) {
  if (typeof argument === "string") return vscode.Uri.parse(argument);
  if (argument instanceof vscode.Uri) return argument;
  const document = vscode.window.activeTextEditor?.document;
  if (document && /\.(asl|mas2j|jcm)$/.test(document.fileName)) return document.uri;
  vscode.window.showErrorMessage("JaCaROS: open an .asl, .mas2j or .jcm file first");
}

const optionsFor = (uri) => vscode.workspace.getConfiguration("jacaros", uri).get("runOptions");

/** Show why the plan at a line did or did not run in the last recording, as the language server finds it. */
async function why(uri, line = vscode.window.activeTextEditor.selection.active.line + 1) {
  if (!client?.isRunning()) return complain("the language server is not running");
  answers ??= vscode.window.createOutputChannel("JaCaROS: Why");
  answers.appendLine(await vscode.commands.executeCommand("jacaros.explain", uri.toString(), line));
  answers.show(true);
}

const COMMANDS = {
  run: (uri) => runTask("run", [uri.fsPath, ...optionsFor(uri)], uri),
  view: (uri) => runWithPage(uri, optionsFor(uri)),
  debug: (uri) => vscode.debug.startDebugging(vscode.workspace.getWorkspaceFolder(uri), configurationFor(uri)),
  test: (uri, name) => runTask("test", typeof name === "string" ? [uri.fsPath, "-k", `*::${name}`] : [uri.fsPath], uri),
  check: (uri) => runTask("check", [uri.fsPath], uri),
  why,
};

async function activate(context) {
  const own = Object.entries(COMMANDS).map(([name, action]) =>
    vscode.commands.registerCommand(`jacaros.${name}`, async (argument, ...more) => {
      const uri = fileOf(argument);
      if (uri) await action(uri, ...more);
    }),
  );
  context.subscriptions.push(
    ...own,
    vscode.commands.registerCommand("jacaros.restart", () => stop().then(start)),
    vscode.workspace.onDidChangeConfiguration((event) => event.affectsConfiguration("jacaros.python") && stop().then(start)),
    vscode.tasks.registerTaskProvider("jacaros", provider),
    vscode.debug.registerDebugConfigurationProvider("jacaros", configurations),
    vscode.debug.registerDebugAdapterDescriptorFactory("jacaros", adapter),
  );
  await start();
}

module.exports = { activate, deactivate: stop };
