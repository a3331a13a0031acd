# SPDX-License-Identifier: MIT
"""The command line."""

import argparse
import collections
import contextlib
import shlex
import signal
import sys
import time
from pathlib import Path

from . import chaos, client_mode, interruption, outputs, process_group, report, server_mode, wire
from .case import Level
from .cases import SERVER_CASES
from .client_stage import Options
from .printable import printable
from .scene_robots import robots_of
from .server_scene import SCENE

_EXAMPLES = """\
examples:
  ziggurat-conformance server -- ziggurat serve '{scene}' --endpoint '{endpoint}'
      starts and restarts the server and plays all cases; the words in braces are replaced
  ziggurat-conformance server --variant 'lease=ziggurat serve {scene} --endpoint {endpoint} --lease 2' \\
                              -- ziggurat serve '{scene}' --endpoint '{endpoint}'
      also plays the cases that need a server with a lease; curve=… for one with keys, whose files are
      {curve_secret} and {curve_clients}
  ziggurat-conformance server tcp://127.0.0.1:5770
      plays what can be played against a server that runs; it must run the kit's scene (--scene prints its path)
  ziggurat-conformance client -- ./my_controller
      plays a server: ZIGGURAT_ENDPOINT and ZIGGURAT_CONTROLLER are in the controller's environment
  ziggurat-conformance client --scene arena.argos -- ./my_controller
      plays the robots of a scene, for a controller that names them; a server is asked what they have
  ziggurat-conformance server --level core -- …
      the cases of one badge: core, reconnect, hil, secure
  ziggurat-conformance server --only 'S9.*' --html report.html -- …
      some cases, and a page with the exchange of every failure

Exit code: 0 if no case failed, also if some were not run; 1 if one did, or a --badge is not reached; 2 for a mistake on this line, a
program that does not start, or reports or a stdout that can't be written; 130 after Ctrl-C, 143 after SIGTERM.
docs/conformance.md explains verdicts, levels, and how to add a case."""


def _parser(version: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="ziggurat-conformance", epilog=_EXAMPLES,
        description="Proves a server or a client of the Ziggurat controller protocol right.",
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--version", action="version", version=f"%(prog)s {version}")
    parser.add_argument("--scene", action="store_true", help="print the path of the kit's scene, and stop")
    modes = parser.add_subparsers(dest="mode", metavar="server|client")
    server = modes.add_parser("server", help="play controllers against a server",
                              epilog=_EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter)
    server.add_argument("target", nargs="*", metavar="URL | -- COMMAND",
                        help="where a server listens, or how to start one")
    server.add_argument("--variant", action="append", default=[], metavar="NAME=COMMAND",
                        help="how to start a server for the cases of this variant: lease, curve, director")
    client = modes.add_parser("client", help="play a server against a controller program",
                              epilog=_EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter)
    client.add_argument("target", nargs="*", metavar="-- COMMAND")
    client.add_argument("--scene", dest="played", type=Path, metavar="SCENE",
                        help="play the robots of this scene; without it, the kit's arms, whatever is asked for")
    client.add_argument("--server", default=_SERVER, metavar="COMMAND",
                        help="how to start the server that describes them (default: %(default)s)")
    client.add_argument("--controller", default="", metavar="ID",
                        help="whose robots the program is to drive: its ZIGGURAT_CONTROLLER (default: the "
                             "scene's first that is no script)")
    for mode in (server, client):
        mode.add_argument("--only", action="append", default=[], metavar="GLOB",
                          help="only cases whose id matches; may be repeated")
        mode.add_argument("--level", choices=[level.value.lower() for level in Level],
                          help="only cases of this level")
        mode.add_argument("--badge", action="append", default=[],
                          choices=[level.value.lower() for level in Level],
                          help="exit with 1 unless this badge is reached, too; may be repeated")
        mode.add_argument("--form", choices=("binary", "json"), help="only cases in this form; "
                          "a client must use it")
        mode.add_argument("--list", action="store_true", help="list the cases, and stop")
        mode.add_argument("--known-failing", type=Path, metavar="FILE",
                          help="ids of cases that must fail, one per line; # begins a comment")
        mode.add_argument("--patience", type=float, default=3.0, metavar="SECONDS",
                          help="how long to wait for an expected message (default: 3)")
        mode.add_argument("--start-patience", type=float, default=60.0, metavar="SECONDS",
                          help="how long a program may take until it connects, or listens; --patience counts from then "
                               "(default: 60)")
        mode.add_argument("--chaos", type=int, metavar="SEED",
                          help="legal but unpleasant behaviour instead of cases, drawn from this seed")
        mode.add_argument("--ticks", type=int, default=500, help="length of chaos (default: 500)")
        mode.add_argument("--verbose", "-v", action="store_true", help="a line for every case")
        mode.add_argument("--junit", type=Path, metavar="F.xml")
        mode.add_argument("--json", type=Path, metavar="F.json")
        mode.add_argument("--html", type=Path, metavar="F.html")
    return parser


_SIGNAL_BEFORE = 128  # its number: as shells tell of a program that a signal ends
_LONGEST_LIST = 1_000_000  # [bytes] of --known-failing
_SERVER = "ziggurat serve {scene} --endpoint {endpoint}"


class _Mistake(Exception):
    """On the command line."""


def _variants(texts: list) -> dict:
    known = sorted({case.variant for case in SERVER_CASES} - {""})
    variants = {}
    for text in texts:
        name, separator, command = text.partition("=")
        if not separator:
            raise _Mistake(f"--variant {text!r}: write NAME=COMMAND")
        if name not in known:
            raise _Mistake(f"--variant {text!r}: no case asks for {name!r}; the variants are {', '.join(known)}")
        variants[name] = command
    return variants


def _known(path) -> set:
    if path is None:
        return set()
    try:
        if path.exists() and not path.is_file():
            raise _Mistake(f"--known-failing {path} is not a regular file")
        with path.open("rb") as file:
            data = file.read(_LONGEST_LIST + 1)
        text = data.decode()
    except OSError as error:
        raise _Mistake(f"--known-failing {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise _Mistake(f"--known-failing {path} is not text in UTF-8") from None
    if len(data) > _LONGEST_LIST:
        raise _Mistake(f"--known-failing {path} has more than {_LONGEST_LIST} bytes; a list of cases has less")
    lines = (line.split("#")[0].strip() for line in text.splitlines())
    return {line for line in lines if line}


def _chosen(cases: list, options) -> list:
    form = options.form if options.mode == "server" else None  # a client chooses its form
    chosen = list(server_mode.chosen(cases, options.only, form, options.level))
    if not chosen:
        raise _Mistake("no case is chosen; --list lists them all" if not options.only else
                       f"no case matches --only {' '.join(options.only)}; --list lists them all")
    return chosen


def _left_out(options, outcomes: list) -> collections.Counter:
    """How many cases of each level were not chosen."""
    there = collections.Counter()
    if options.mode == "server":
        for case in SERVER_CASES:
            there[case.level] += len(case.forms)
    else:  # the controller chooses the form
        there.update(case.level for case in client_mode.CASES)
    there.subtract(outcome.level for outcome in outcomes)
    return there


def _server(options, terminal):
    if len(options.target) == 1 and "://" in options.target[0]:
        servers = server_mode.RunningServer(options.target[0])
    else:
        servers = server_mode.Servers(shlex.join(options.target), _variants(options.variant),
                                      options.start_patience)
    if options.chaos is not None:
        forms = (options.form,) if options.form else wire.FORMS
        return chaos.play_server(servers, options.chaos, options.ticks, options.patience, forms,
                                 terminal.outcome)
    cases = _chosen(SERVER_CASES, options)
    return server_mode.play(cases, servers, options.patience, terminal.outcome)


def _client(options, terminal):
    played = _client_options(options)
    if options.chaos is not None:
        return chaos.play_client(options.target, options.chaos, options.ticks, played, terminal.outcome)
    return client_mode.play(_chosen(client_mode.CASES, options), options.target, played, terminal.outcome)


def _client_options(options) -> Options:
    if options.played is None:
        if options.controller:
            raise _Mistake("--controller names one of a scene: give --scene too")
        return Options(options.patience, options.start_patience, options.form)
    command = options.server
    beside = Path(sys.argv[0]).resolve().parent / "ziggurat"
    if command == _SERVER and beside.is_file():
        command = shlex.quote(str(beside)) + command.removeprefix("ziggurat")
    scene = robots_of(options.played, command, options.start_patience)
    return Options(options.patience, options.start_patience, options.form, scene, scene.controller(options.controller))


def _print_list(options) -> None:
    cases = SERVER_CASES if options.mode == "server" else client_mode.CASES
    chosen = list(server_mode.chosen(cases, options.only, options.form, options.level))
    for case in chosen:
        print(f"{case.id:<36} {case.level.value:<10} {case.title}")
    print(f"{len(chosen)} cases, {sum(len(case.forms) for case in chosen)} with their forms")


def _reports(options) -> outputs.Reports:
    named = [("--junit", options.junit, ".xml"), ("--json", options.json, ".json"), ("--html", options.html, ".html")]
    return outputs.Reports([report for report in named if report[1]])


def _contents(options, outcomes: list, left_out: collections.Counter) -> dict:
    """Of the reports."""
    title = f"Conformance of a {options.mode}: {shlex.join(options.target)}"
    return {
        "--junit": lambda: report.junit(outcomes, f"conformance.{options.mode}"),
        "--json": lambda: report.json_of(outcomes, left_out),
        "--html": lambda: report.page(outcomes, left_out, title),
    }


def _play(options) -> int:
    terminal = report.Terminal(options.verbose)
    start = time.monotonic()
    try:
        known = _known(options.known_failing)
        reports = _reports(options)
        outcomes = (_server if options.mode == "server" else _client)(options, terminal)
        report.judge_known(outcomes, known)
        left_out = _left_out(options, outcomes)
        terminal.end(outcomes, left_out, time.monotonic() - start)
        reports.write(_contents(options, outcomes, left_out))
    except (RuntimeError, _Mistake, outputs.WrongOutput) as error:
        interruption.repeat()
        print(printable(f"ziggurat-conformance: {error}"), file=sys.stderr)
        return 2
    missing = report.missing_badges(outcomes, left_out, options.badge)
    if missing:
        print(f"ziggurat-conformance: not reached: {', '.join(missing)}", file=sys.stderr)
    return 0 if report.good(outcomes) and not missing else 1


def _main(words: list, version: str) -> int:
    parser = _parser(version)
    if words[:1] == ["help"]:
        words = words[1:2] + ["--help"]
    options = parser.parse_args(words)
    if options.scene:
        print(SCENE)
    elif options.mode is None:
        parser.print_help()
        return 2
    elif options.list:
        _print_list(options)
    elif not options.target:
        parser.error(f"{options.mode}: nothing to test; give a URL or -- COMMAND (see --help)")
    else:
        return _play(options)
    return 0


def _guarded(words: list, version: str) -> int:
    """Nothing that was started is left behind, however it ends."""
    try:
        return _main(words, version)
    except SystemExit as end:  # after --help, or a mistake
        return end.code
    finally:
        with interruption.postponed():
            process_group.end_all()


def main(arguments=None, version="of a source tree") -> int:
    outputs.keep_descriptors()
    stdout, stderr = outputs.Output("stdout", sys.stdout), outputs.Output("stderr", sys.stderr)
    with contextlib.redirect_stdout(stdout), contextlib.redirect_stderr(stderr), interruption.handled():
        try:
            code = _guarded(sys.argv[1:] if arguments is None else list(arguments), version)
            stdout.flush()
            if stdout.fault:
                print(f"ziggurat-conformance: {stdout.fault}", file=stderr)
                code = 2
        except interruption.Interrupted as end:
            interruption.ignore()  # the end takes a moment only
            stdout.end()
            how = "interrupted" if end.number == signal.SIGINT else f"ended by {signal.Signals(end.number).name}"
            stderr.end(f"ziggurat-conformance: {how}; no report was written\n")
            code = _SIGNAL_BEFORE + end.number
    return code
