"""The kit catches what is broken: each of these bugs fails a case that the right program passes."""

import shlex
import sys
import unittest
from pathlib import Path

from ziggurat_conformance import client_mode, server_mode
from ziggurat_conformance.case import Verdict
from ziggurat_conformance.cases import SERVER_CASES
from ziggurat_conformance.client_stage import Options

HERE = Path(__file__).resolve().parent
PATIENCE = 10.0  # [s] for the right programs: a busy machine may take long
SHORT = 1.0  # for broken ones, which may never answer: to be late is as wrong

# bug → the case that must catch it
SERVER_BUGS = {
    "any-version": "H2.major-above",
    "any-token": "L4.unknown-token",
    "token-waits": "L8.token-alone",
    "asked-order": "H4.some",
    "shares-robots": "H6.taken-twice",
    "late-waits": "H11.late",
    "silent-on-garbage": "T2.garbage-text",
    "stale-counts": "S9.stale",
    "future-counts": "S9.future",
    "duplicate-silent": "S9.duplicate",
    "tells-twice": "S3.waits",
    "heartbeat-releases": "S3.heartbeat-does-not",
    "skips-ticks": "S1.consecutive",
    "time-drifts": "S1.time",
    "short-readings": "S2.joint-readings",
    "two-steps": "S4.applied-next",
    "any-length": "S6.long-joint-targets",
    "nan-counts": "S8.nan-joint",
    "half-a-command": "S10.no-effect",
    "radio-reversed": "D3.order",
    "plain-text": "K1.plain",
    "any-key": "K2.unlisted",
    "any-role": "K3.controller-as-supervisor",
}

CLIENT_BUGS = {
    "version-zero": "H2.version",
    "asks-for-nothing": "H4.asks-for-robots",
    "command-first": "H1.hello-first",
    "impatient": "H1.waits-for-the-answer",
    "tick-ahead": "S3.answers-each",
    "skips-zero": "S1.first-tick",
    "short-targets": "S3.answers-each",
    "nan-targets": "S3.answers-each",
    "answers-twice": "S3.answers-once",
    "answers-heartbeats": "M5.heartbeats-unanswered",
    "answers-paused": "L6.paused",
    "answers-reset": "L6.reset",
    "answers-end": "L5.no-command-after-end",
    "comes-back": "L6.displaced",
    "storm": "H10.no-storm",
    "refusal-is-fine": "H10.refused",
    "fatal-is-fine": "M3.fatal",
    "ignores-end": "L11.end",
    "dies-of-news": "T5.unknown-kind",
}


def _server_verdicts(bug: str, ids: set) -> dict:
    patience = SHORT if bug else PATIENCE
    command = shlex.join([sys.executable, str(HERE / "tiny_server.py"), "{endpoint}", bug])
    curve = f"{command} {{curve_secret}} {{curve_clients}}"
    cases = [case for case in server_mode.chosen(SERVER_CASES, list(ids), "binary")]
    outcomes = server_mode.play(cases, server_mode.Servers(command, {"curve": curve}, patience), patience,
                                lambda outcome: None)
    return {outcome.id: outcome for outcome in outcomes}


def _client_verdicts(bug: str, ids: set) -> dict:
    command = [sys.executable, str(HERE / "tiny_client.py"), bug]
    cases = [case for case in client_mode.CASES if case.id in ids]
    patience = SHORT if bug else PATIENCE
    outcomes = client_mode.play(cases, command, Options(patience), lambda outcome: None)
    return {outcome.id: outcome for outcome in outcomes}


class Servers(unittest.TestCase):
    def test_the_right_one_passes(self):
        for outcome in _server_verdicts("", set(SERVER_BUGS.values())).values():
            self.assertEqual(Verdict.PASS, outcome.verdict, f"{outcome.id}: {outcome.reason}")

    def test_each_bug_is_caught(self):
        for bug, case in SERVER_BUGS.items():
            with self.subTest(bug):
                self.assertEqual(Verdict.FAIL, _server_verdicts(bug, {case})[case].verdict)


class Clients(unittest.TestCase):
    def test_the_right_one_passes(self):
        for outcome in _client_verdicts("", set(CLIENT_BUGS.values())).values():
            self.assertEqual(Verdict.PASS, outcome.verdict, f"{outcome.id}: {outcome.reason}")

    def test_each_bug_is_caught(self):
        for bug, case in CLIENT_BUGS.items():
            with self.subTest(bug):
                caught = (Verdict.FAIL, Verdict.NON_STRICT)
                self.assertIn(_client_verdicts(bug, {case})[case].verdict, caught)


if __name__ == "__main__":
    unittest.main()
