"""``jacaros COMMAND``: finds the command, and turns the user's mistakes into messages.

Exit codes: 0 after a clean end, 1 after an error in a program or project, 2 for wrong usage, the program's
own code after ``.stopMAS``; 130 and 143 when a signal (Ctrl-C, SIGTERM) ended the run.
"""

import io
import os
import sys
import threading
import traceback
from importlib import import_module

import click

from jacaros.cli.outputs import OUTPUT_GONE
from jacaros.errors import JacarosError, UsageError
from jacaros.excerpts import help_line, printable
from jacaros.output import PLAIN

ENDED_BY_SIGNAL = (129, 130, 143, 149)
"""Exit codes of a run that SIGHUP, Ctrl-C, SIGTERM or Ctrl-Break (Windows) ended."""

COMMANDS = {
    "demo": ("jacaros.cli.demo", "Show a robot on patrol."),
    "run": ("jacaros.cli.run", "Run an agent program or a project."),
    "check": ("jacaros.cli.check", "Report problems in programs, projects and mappings."),
    "fmt": ("jacaros.cli.fmt", "Format programs in one style."),
    "compile": ("jacaros.cli.compile", "Show the Python code generated for a program."),
    "view": ("jacaros.cli.view", "Show a recorded run on a page in the browser."),
    "why": ("jacaros.cli.why", "Explain why something happened in a recorded run, or did not."),
    "replay": ("jacaros.cli.replay", "Give a recorded run to a changed program, and compare its decisions."),
    "test": ("jacaros.cli.test", "Run the tests of agent programs."),
    "sim": ("jacaros.cli.sim", "Run a robot world as a ROS node of its own."),
    "world": ("jacaros.cli.world", "Check, show, make and export world files."),
    "guard": ("jacaros.cli.guard", "Stop the robot when its agents no longer can."),
    "ros": ("jacaros.cli.ros", "Inspect a live ROS graph, and write mapping files for it."),
    "describe": ("jacaros.cli.describe", "Describe what an artifact type, a mapping or a project offers."),
    "metrics": ("jacaros.cli.metrics", "Count identifiers, lines and compressed bytes of programs."),
    "version": ("jacaros.cli.version", "Print the versions of jacaros and its dependencies."),
}
"""Module and summary of each command."""


class Commands(click.Group):
    """The commands by name; the module of one is imported when it is called, not before."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The names, in the order of importance."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of that name."""
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = import_module(COMMANDS[cmd_name][0]).command
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """A file in the place of the command is run: ``jacaros hello.asl``."""
        if args and args[0].endswith((".asl", ".py", ".mas2j", ".jcm")):
            args = ["run", *args]
        if args and not args[0].startswith("-") and args[0] not in COMMANDS:
            raise _unknown_command(args[0])
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, summary) for name, (_, summary) in COMMANDS.items()])


def _unknown_command(name: str) -> UsageError:
    import difflib  # here: only for a command that does not exist

    near = difflib.get_close_matches(name, COMMANDS, 1)
    help = f"did you mean `{near[0]}`?" if near else "`jacaros --help` lists the commands"
    return UsageError(f"error: unknown command: `{printable(name)}`\n{help_line(help)}")


def _tell_version(ctx: click.Context, _: click.Parameter, wanted: bool) -> None:
    if wanted:
        from jacaros.cli.version import version_of

        click.echo(f"jacaros {version_of('jacaros')}")
        ctx.exit()


@click.command(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_tell_version,
    help="Print the version and exit.",
)
def jacaros() -> None:
    """Program robots as rational agents: AgentSpeak minds, artifacts and ROS."""


def main(arguments: list[str] | None = None) -> None:
    """The entry point of the ``jacaros`` command; ends the process."""
    for stream in (sys.stdout, sys.stderr):
        # A console that lacks a character, as those of cp1252 lack arrows, must not end a command.
        if isinstance(stream, io.TextIOWrapper) and stream.errors in ("strict", "backslashreplace"):
            stream.reconfigure(errors=PLAIN)
    code = call(arguments)
    if code in ENDED_BY_SIGNAL and _threads_go_on():
        # Python would wait for them; Ctrl-C is not to be waited for.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    if code == OUTPUT_GONE:
        # Otherwise the interpreter complains when it flushes the output at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    sys.exit(code)


def _threads_go_on() -> bool:
    """Whether a thread of the project's own would keep the process from ending."""
    return any(
        thread is not threading.main_thread() and not thread.daemon for thread in threading.enumerate()
    )


def call(arguments: list[str] | None = None) -> int:
    """Carry a command out; the exit code."""
    try:
        arguments = _own(sys.argv[1:] if arguments is None else arguments)
        result = jacaros.main(args=arguments, prog_name="jacaros", standalone_mode=False)
    except click.exceptions.Exit as end:
        return end.exit_code
    except click.exceptions.Abort:
        return 130
    except click.ClickException as wrong:
        wrong.show()
        return 2
    except UsageError as wrong:
        return _tell(wrong, 2)
    except JacarosError as wrong:
        return _tell(wrong, 1)
    except BrokenPipeError:
        return OUTPUT_GONE
    except Exception as defect:
        traceback.print_exception(defect)
        print(f"jacaros: this is a defect of jacaros, please report it: {defect}", file=sys.stderr)
        return 1
    return result if isinstance(result, int) else 0


def _own(arguments: list[str]) -> list[str]:
    """The arguments, with options of ours in place of what ``ros2 run``, rosrun and launch files have added."""
    if not any(":=" in each or each == "--ros-args" for each in arguments):
        return arguments
    from jacaros.cli.ros_arguments import as_options, has_ros_arguments  # here: few runs need it

    if not has_ros_arguments(arguments):
        return arguments
    return as_options(arguments, lambda line: print(f"jacaros: {line}", file=sys.stderr))


def _tell(error: JacarosError, code: int) -> int:
    # Diagnostics begin with file and line, where editors look for them.
    located = hasattr(error, "diagnostics") or hasattr(error, "problems")
    prefix = "" if located or str(error).startswith("error: ") else "jacaros: "
    print(f"{prefix}{error}", file=sys.stderr)
    return code
