# SPDX-License-Identifier: MIT
"""The kit catches what is broken: each mutant breaks one rule, and fails the case that the table names,
which the right program passes. Mutants are programs of their own on sockets of their own."""

import concurrent.futures
import multiprocessing
import shlex
import sys
import unittest
from pathlib import Path

from ziggurat_conformance import client_mode, server_mode
from ziggurat_conformance.case import Level, Verdict
from ziggurat_conformance.cases import SERVER_CASES
from ziggurat_conformance.client_stage import Options

import client_mutants
import server_mutants

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))

from waiting import HANG  # noqa: E402

SILENCE = 10.0  # [s] that mutants are heard which say nothing
START_PATIENCE = 120.0  # [s]
SIDE_BY_SIDE = 6  # mutants; most of the time they wait


def _client(mutant) -> list:
    """Outcomes of the mutant's case."""
    command = [sys.executable, "-B", str(HERE / "tiny_client.py"), mutant.bug, mutant.form]
    cases = [case for case in client_mode.CASES if case.id == mutant.case]
    patience = SILENCE if mutant.bug in client_mutants.SILENT else HANG
    return client_mode.play(cases, command, Options(patience, START_PATIENCE, mutant.form), lambda outcome: None)


def _right_client(form: str, cases: list, kind: str = "") -> list:
    command = [sys.executable, "-B", str(HERE / "tiny_client.py"), kind, form]
    return client_mode.play(cases, command, Options(HANG, START_PATIENCE, form), lambda outcome: None)


def _server(mutant) -> list:
    cases = list(server_mode.chosen(SERVER_CASES, [mutant.case], mutant.form))
    return _play_server(cases, mutant.bug, SILENCE if mutant.bug in server_mutants.SILENT else HANG)


def _right_server(form: str, ids: list) -> list:
    cases = list(server_mode.chosen(SERVER_CASES, ids, form))
    return _play_server(cases, "", HANG)


def _play_server(cases: list, bug: str, patience: float) -> list:
    command = shlex.join([sys.executable, "-B", str(HERE / "bent_server.py"), "{endpoint}", "{scene}", bug])
    variants = {"curve": f"{command} --curve-secret {{curve_secret}} --curve-clients {{curve_clients}}", "lease": f"{command} --lease 2",
                "director": f"{command} --allow-director"}
    return server_mode.play(cases, server_mode.Servers(command, variants, START_PATIENCE), patience,
                            lambda outcome: None)


def _side_by_side(function, *arguments) -> list:
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(SIDE_BY_SIDE, context) as pool:
        return list(pool.map(function, *arguments))


def _parts(things: list, count: int) -> list:
    return [part for i in range(count) if (part := things[i::count])]


class Mutants(unittest.TestCase):
    def assert_caught(self, mutant, outcomes: list):
        self.assertEqual(1, len(outcomes), f"{mutant.case}: there is no such case in this form")
        [outcome] = outcomes
        expected = (Verdict.FAIL,) if mutant.is_must else (Verdict.NON_STRICT, Verdict.UNIMPLEMENTED)
        self.assertIn(outcome.verdict, expected, f"{mutant.bug}: {outcome.id}: {outcome.reason}")
        self.assertTrue(mutant.case.startswith(f"{mutant.rule}.") or mutant.rule in outcome.reason,
                        f"{mutant.bug} breaks {mutant.rule}, which {outcome.id} does not name: "
                        f"{outcome.reason}")

    def assert_passes(self, outcomes: list):
        for outcome in outcomes:
            self.assertEqual(Verdict.PASS, outcome.verdict, f"{outcome.id}: {outcome.reason}")


class Clients(Mutants):
    def test_each_is_caught(self):
        mutants = client_mutants.MUTANTS
        for mutant, outcomes in zip(mutants, _side_by_side(_client, mutants)):
            with self.subTest(mutant.bug):
                self.assert_caught(mutant, outcomes)

    def test_the_right_one_passes_all_cases(self):
        timed = [case for case in client_mode.CASES if case.level is Level.HIL]  # alone: they have deadlines
        parts = _parts([case for case in client_mode.CASES if case not in timed], 8)
        forms = ["binary"] * len(parts)
        json = [case for case in client_mode.CASES
                if case.id in {mutant.case for mutant in client_mutants.MUTANTS if mutant.form == "json"}]
        for outcomes in _side_by_side(_right_client, [*forms, "json"], [*parts, json]):
            self.assert_passes(outcomes)
        self.assert_passes(_right_client("binary", timed))

    def test_one_that_notices_losses_by_silence_reconnects(self):
        parts = _parts([case for case in client_mode.CASES if case.level is Level.RECONNECT or case.id.startswith("L12.")], 8)
        for outcomes in _side_by_side(_right_client, ["binary"] * len(parts), parts, ["without-monitor"] * len(parts)):
            self.assert_passes(outcomes)

    def test_there_are_enough(self):
        self.assertGreaterEqual(sum(mutant.is_must for mutant in client_mutants.MUTANTS), 60)
        bugs = {mutant.bug for mutant in client_mutants.MUTANTS}
        self.assertEqual(len(client_mutants.MUTANTS), len(bugs))
        self.assertLess(client_mutants.SILENT, bugs)


class Servers(Mutants):
    def test_each_is_caught(self):
        mutants = server_mutants.MUTANTS
        for mutant, outcomes in zip(mutants, _side_by_side(_server, mutants)):
            with self.subTest(mutant.bug):
                self.assert_caught(mutant, outcomes)

    def test_the_right_one_passes_these_cases(self):
        parts = [(form, part) for form in ("binary", "json") for part in
                 _parts(sorted({mutant.case for mutant in server_mutants.MUTANTS if mutant.form == form}), 4)]
        for outcomes in _side_by_side(_right_server, *zip(*parts)):
            self.assert_passes(outcomes)

    def test_there_are_enough(self):
        self.assertGreaterEqual(len(server_mutants.MUTANTS), 60)
        bugs = {mutant.bug for mutant in server_mutants.MUTANTS}
        self.assertEqual(len(server_mutants.MUTANTS), len(bugs))
        self.assertLess(server_mutants.SILENT, bugs)


if __name__ == "__main__":
    unittest.main()
