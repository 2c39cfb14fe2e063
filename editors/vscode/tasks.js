// Tasks that run, check and test programs in a terminal.
const vscode = require("vscode");
const { pythonFor } = require("./python");

/** Return a task for `jacaros COMMAND ARGS`. */
async function taskFor(definition, scope, uri, env) {
  const python = await pythonFor(uri);
  const args = ["-m", "jacaros", definition.command, ...(definition.args ?? [])];
  const folder = scope?.uri?.fsPath;
  const execution = new vscode.ProcessExecution(python, args, { env, cwd: folder });
  const name = [definition.command, ...(definition.args ?? [])].join(" ");
  const task = new vscode.Task(definition, scope ?? vscode.TaskScope.Workspace, name, "jacaros", execution, "$jacaros");
  task.presentationOptions = { clear: true, showReuseMessage: false };
  if (definition.command === "test") task.group = vscode.TaskGroup.Test;
  return task;
}

/** Run a task for a file, once the file is saved. */
async function runTask(command, args, uri, env) {
  await vscode.workspace.saveAll(false);
  const scope = vscode.workspace.getWorkspaceFolder(uri);
  return vscode.tasks.executeTask(await taskFor({ type: "jacaros", command, args }, scope, uri, env));
}

/** Offer to check and to test each folder. */
const provider = {
  provideTasks: () =>
    Promise.all(
      (vscode.workspace.workspaceFolders ?? []).flatMap((folder) =>
        ["check", "test"].map((command) => taskFor({ type: "jacaros", command, args: ["."] }, folder, folder.uri)),
      ),
    ),
  resolveTask: (task) => {
    const folder = typeof task.scope === "object" ? task.scope : vscode.workspace.workspaceFolders?.[0];
    return taskFor(task.definition, folder, folder?.uri);
  },
};

module.exports = { provider, runTask };
