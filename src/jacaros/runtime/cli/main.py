"""``jacaros COMMAND``: finds the command, and turns exceptions into error messages and exit codes.

Exit codes: 0 after a normal end, 1 for an error in a program or project, 2 for wrong usage, 130 and 143 when a signal
(Ctrl+C, SIGTERM) ended the run, and the code that the program passes to ``.stopMAS``.
"""

import io
import os
import platform
import re
import sys
import threading
import traceback
from collections.abc import Mapping
from importlib import import_module

import click
from click.shell_completion import CompletionItem

from jacaros.runtime.cli.outputs import OUTPUT_GONE
from jacaros.runtime.cli.usage import examples, in_our_form, usage_error
from jacaros.runtime.errors import JacarosError, UsageError
from jacaros.runtime.files.texts import help_line, suggestion
from jacaros.runtime.output import PLAIN, Visible
from jacaros.version import VERSION

ENDED_BY_SIGNAL = (129, 130, 143, 149)
"""Exit codes of runs ended by SIGHUP, Ctrl+C, SIGTERM or Ctrl+Break (Windows)."""

_LIBRARIES = ("click", "rich", "ruamel.yaml", "websockets", "numpy")
COMMANDS = {
    "demo": ("jacaros.runtime.cli.run:demo", "Show a robot on patrol."),
    "new": ("jacaros.runtime.cli.new", "Make a project that runs, from a template."),
    "run": ("jacaros.runtime.cli.run", "Run an agent program or a project."),
    "mcp": ("jacaros.runtime.cli.mcp", "Run an agent program, and serve it to a language model."),
    "dap": ("jacaros.runtime.cli.dap", "Debug agents from an editor (Debug Adapter Protocol)."),
    "console": ("jacaros.runtime.cli.talking:console", "Talk to the agents of a running system."),
    "achieve": ("jacaros.runtime.cli.talking:achieve", "Give a goal to an agent of a running system."),
    "ask": ("jacaros.runtime.cli.talking:ask", "Ask an agent of a running system."),
    "tell": ("jacaros.runtime.cli.talking:tell", "Tell a belief to an agent of a running system."),
    "events": ("jacaros.runtime.cli.talking:events", "Print what happens in a running system."),
    "check": (
        "jacaros.runtime.cli.programs:check",
        "Report problems in programs, projects and mapping files.",
    ),
    "port": ("jacaros.runtime.cli.port", "Port a Java artifact or environment to Python."),
    "fmt": ("jacaros.runtime.cli.programs:fmt", "Format programs in one style."),
    "view": ("jacaros.runtime.cli.recordings:view", "Show a recorded run on a page in the browser."),
    "why": (
        "jacaros.runtime.cli.recordings:why",
        "Explain why something did or did not happen in a recorded run.",
    ),
    "plot": (
        "jacaros.runtime.cli.exports:plot",
        "Draw beliefs and other numbers of a recorded run over time.",
    ),
    "export": ("jacaros.runtime.cli.exports:export", "Convert a recorded run for Foxglove (MCAP)."),
    "replay": ("jacaros.runtime.cli.recordings:replay", "Replay a recorded run against a changed program."),
    "test": ("jacaros.runtime.cli.test", "Run the tests of agent programs."),
    "sim": ("jacaros.runtime.cli.sim", "Run a robot world as a separate ROS node."),
    "world": ("jacaros.runtime.cli.world", "Show and export world files."),
    "guard": ("jacaros.runtime.cli.guard", "Stop the robot when its agents no longer can."),
    "fleet": ("jacaros.runtime.cli.fleet", "Look at a fleet of systems, and set it up."),
    "ros": ("jacaros.runtime.cli.ros", "Inspect a live ROS graph, and write mapping files for it."),
    "lsp": ("jacaros.runtime.cli.lsp", "Run the language server for editors."),
    "describe": ("jacaros.runtime.cli.describe", "Describe an artifact type, a mapping file or a project."),
    "version": ("jacaros.runtime.cli.main:version", "Print the versions of jacaros and its dependencies."),
}
"""Module and summary of each command; after a colon, its name in the module if that is not ``command``."""


class CommandGroup(click.Group):
    """The commands by name; the module of a command is imported when it is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names, most used first."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command, or None if the name is unknown."""
        if cmd_name not in COMMANDS:
            return None
        module, _, name = COMMANDS[cmd_name][0].partition(":")
        command: click.Command = getattr(import_module(module), name or "command")
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Run a file given instead of a command: ``jacaros hello.asl``."""
        if args and args[0].endswith((".asl", ".py", ".mas2j", ".jcm")):
            args = ["run", *args]
        if args and not args[0].startswith("-") and args[0] not in COMMANDS:
            help = suggestion(args[0], COMMANDS, "`jacaros --help` lists the commands")
            raise usage_error(f"unknown command: `{args[0]}`", help)
        return super().resolve_command(ctx, args)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Complete a command without importing them all, or the file that stands for ``jacaros run FILE``."""
        if incomplete.startswith("-"):
            return super().shell_complete(ctx, incomplete)
        names = (name for name in COMMANDS if name.startswith(incomplete))
        found = [CompletionItem(name, help=COMMANDS[name][1]) for name in names]
        return found or [CompletionItem(incomplete, type="file")]

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, summary) for name, (_, summary) in COMMANDS.items()])


@click.command(
    cls=CommandGroup,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=examples(
        "jacaros hello.asl                           run a program",
        "jacaros run robot.asl --world house --view  watch a robot in the browser",
        "jacaros check .                             find mistakes before the run",
        "jacaros run --help                          list the options of a command",
    ),
)
@click.version_option(VERSION, message="jacaros %(version)s", help="Print the version and exit.")
def jacaros() -> None:
    """Program robots as rational agents: AgentSpeak minds, artifacts and ROS."""


@click.command("version")
def version() -> None:
    """Print the versions of jacaros and its dependencies."""
    from importlib import metadata  # here: it imports much

    click.echo(f"jacaros {VERSION}")
    click.echo(f"Python {platform.python_version()} on {platform.platform()}")
    for library in _LIBRARIES:
        try:
            found = metadata.version(library)
        except metadata.PackageNotFoundError:
            found = "is not installed"
        click.echo(f"{library} {found}")


def main(arguments: list[str] | None = None) -> None:
    """Run the ``jacaros`` command and exit the process."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        # A console that lacks a character, as those of cp1252 lack arrows, must not end a command.
        if isinstance(stream, io.TextIOWrapper) and stream.errors in ("strict", "backslashreplace"):
            stream.reconfigure(errors=PLAIN)
        # Completion is for the shell, and click writes it as bytes.
        if stream is not None and "_JACAROS_COMPLETE" not in os.environ:
            setattr(sys, name, Visible(stream))
    code = call(arguments)
    if code in ENDED_BY_SIGNAL and _threads_are_left():
        # Python would wait for these threads; after Ctrl+C the process must end immediately.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    if code == OUTPUT_GONE:
        # Otherwise the interpreter prints an error when it flushes the output at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    sys.exit(code)


def _threads_are_left() -> bool:
    """Return whether a thread started by the project would keep the process alive."""
    return any(
        thread is not threading.main_thread() and not thread.daemon for thread in threading.enumerate()
    )


def call(arguments: list[str] | None = None) -> int:
    """Run a command; return its exit code."""
    by_variable: dict[str, str] = {}
    try:
        arguments = _own(sys.argv[1:] if arguments is None else arguments)
        result = jacaros.main(args=arguments, prog_name="jacaros", standalone_mode=False, obj=by_variable)
    except click.exceptions.Exit as end:
        return end.exit_code
    except click.exceptions.Abort:
        return 130
    except click.ClickException as wrong:
        if type(wrong).__name__ == "NoArgsIsHelpError":  # a command alone, such as `jacaros`
            click.echo(wrong.format_message())
            return 0
        return _report(in_our_form(wrong), 2, by_variable)
    except JacarosError as wrong:
        return _report(wrong, 2 if isinstance(wrong, UsageError) else 1, by_variable)
    except BrokenPipeError:
        return OUTPUT_GONE
    except Exception as defect:
        traceback.print_exception(defect)
        command = " ".join(["jacaros", *(sys.argv[1:] if arguments is None else arguments)])
        print(f"internal error: {defect}; please file an issue", file=sys.stderr)
        print(help_line(f"add the traceback above and this command: {command}"), file=sys.stderr)
        return 1
    return result if isinstance(result, int) else 0


def _own(arguments: list[str]) -> list[str]:
    """Replace the arguments added by ``ros2 run``, rosrun and launch files by our own options."""
    if any(":=" in each or each == "--ros-args" for each in arguments):
        from jacaros.runtime.cli.ros_arguments import as_options, has_ros_arguments  # here: few runs need it

        if has_ros_arguments(arguments):
            return as_options(arguments, lambda line: print(f"warning: {line}", file=sys.stderr))
    return arguments


def _report(error: JacarosError, code: int, by_variable: Mapping[str, str]) -> int:
    # Diagnostics begin with the file and line, where editors look for them.
    located = hasattr(error, "diagnostics") or hasattr(error, "problems")
    prefix = "" if located or str(error).startswith("error: ") else "error: "
    print(f"{prefix}{error}", file=sys.stderr)
    for option, variable in by_variable.items():
        words = option[2:].replace("-", "[- ]")
        about = re.search(rf"\b{words}\b", str(error)) or os.environ[variable] in str(error)
        if about or (code == 1 and not located):
            set_by = f"{option} was set by the environment variable {variable}"
            print(f"note: {set_by}; to ignore it, unset {variable}", file=sys.stderr)
    return code
