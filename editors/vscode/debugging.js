// The debugger: `jacaros dap` on the standard input and output.
const vscode = require("vscode");
const { pythonFor } = require("./python");

const adapter = {
  async createDebugAdapterDescriptor(session) {
    const uri = session.workspaceFolder?.uri ?? vscode.Uri.file(session.configuration.program ?? ".");
    const cwd = session.workspaceFolder?.uri.fsPath;
    return new vscode.DebugAdapterExecutable(await pythonFor(uri), ["-m", "jacaros", "dap"], { cwd });
  },
};

/** Debug the file in the editor if there is no launch.json. */
const configurations = {
  resolveDebugConfiguration(_, configuration) {
    const file = vscode.window.activeTextEditor?.document;
    if (configuration.type || !/\.(asl|mas2j|jcm)$/.test(file?.fileName ?? "")) return configuration;
    return configurationFor(file.uri);
  },
};

function configurationFor(uri) {
  const args = vscode.workspace.getConfiguration("jacaros", uri).get("runOptions");
  return { type: "jacaros", request: "launch", name: vscode.workspace.asRelativePath(uri), program: uri.fsPath, args };
}

module.exports = { adapter, configurationFor, configurations };
