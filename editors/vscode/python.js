// Find a Python that has jacaros.
const fs = require("fs");
const path = require("path");
const { execFile } = require("child_process");
const vscode = require("vscode");

/** Return the Python for a file: the setting, the `.venv` of its folder, that of the Python extension, or the system's. */
async function pythonFor(uri) {
  const folder = uri ? vscode.workspace.getWorkspaceFolder(uri) : vscode.workspace.workspaceFolders?.[0];
  const set = vscode.workspace.getConfiguration("jacaros", uri).get("python");
  if (set) return set.replace("${workspaceFolder}", folder?.uri.fsPath ?? ".");
  const inFolder = folder && path.join(folder.uri.fsPath, ".venv", process.platform === "win32" ? "Scripts/python.exe" : "bin/python");
  if (inFolder && fs.existsSync(inFolder)) return inFolder;
  return (await ofPythonExtension(uri)) ?? (process.platform === "win32" ? "python" : "python3");
}

async function ofPythonExtension(uri) {
  const extension = vscode.extensions.getExtension("ms-python.python");
  const environments = extension && (await extension.activate())?.environments;
  return environments && (await environments.resolveEnvironment(environments.getActiveEnvironmentPath(uri)))?.executable.uri?.fsPath;
}

/** Return why `python -m jacaros COMMAND` cannot run, or nothing if it can. */
function problemOf(python, command) {
  return new Promise((resolve) => {
    execFile(python, ["-m", "jacaros", command, "--help"], { timeout: 30000 }, (error, _, output) => {
      if (!error) resolve();
      else if (error.code === "ENOENT") resolve(`${python} does not exist`);
      else if (output.includes("No module named jacaros")) resolve(`${python} has no jacaros: run \`${python} -m pip install "jacaros[lsp]"\``);
      else resolve(`\`${python} -m jacaros ${command}\` failed: ${output.trim().split("\n").pop()}`);
    });
  });
}

/** Report a problem, with a button for the setting that solves it. */
async function complain(problem) {
  const button = "Choose Python";
  if ((await vscode.window.showErrorMessage(`JaCaROS: ${problem}`, button)) === button) {
    await vscode.commands.executeCommand("workbench.action.openSettings", "jacaros.python");
  }
}

module.exports = { complain, problemOf, pythonFor };
