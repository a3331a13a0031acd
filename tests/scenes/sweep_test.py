# SPDX-License-Identifier: MIT
"""`ziggurat sweep`: every combination once, whatever is killed; its tables, refusals and plots."""

import csv
import io
import json
import os
import random
import re
import shlex
import shutil
import signal
import sqlite3
import time
import unittest

from harness import CONTROLLER_FAILED, FAULT, FINISHED, INTERRUPTED, LIMIT, SceneTest, main
from waiting import wait_until

KILLS = int(os.environ.get("ZIGGURAT_SWEEP_KILLS", 8))

ITERATIONS = "physics_engines/dynamics3d/@iterations"


class SweepTest(SceneTest):
    def setUp(self):
        super().setUp()
        self.change("<framework>", '<parameters gain="1" />\n  <framework>')
        self.out = self.folder / "results"
        self.grid = ["--seeds", "1..3", "--param", "gain=0.5|2", "--axis", f"{ITERATIONS}=5|10",
                     "--ticks", "3", "--jobs", "2"]

    def sweep(self, *arguments, code=FINISHED, out=None):
        outcome = self.ziggurat("sweep", *arguments, *(["--out", out or self.out] if out is not False else []))
        self.assertEqual(outcome.code, code, f"\n{outcome.out}\n{outcome.err}")
        return outcome

    def rows(self, out=None):
        """Of the table, without wall times."""
        text = ((out or self.out) / "results.csv").read_text()
        rows = list(csv.DictReader(io.StringIO(text)))
        for row in rows:
            self.assertGreater(float(row.pop("wall_s")), 0)
        return rows

    def assert_whole(self, count, out=None):
        """Each run is in the ledger once, with everything of it."""
        with sqlite3.connect((out or self.out) / "sweep.sqlite") as database:
            self.assertEqual(database.execute("PRAGMA integrity_check").fetchone(), ("ok",))
            runs = [run for run, in database.execute("SELECT run FROM runs ORDER BY run")]
            halves = database.execute(
                "SELECT count(*) FROM runs WHERE (SELECT count(*) FROM parameters"
                " WHERE parameters.run = runs.run) != 2 OR hash = ''").fetchone()
        self.assertEqual(halves, (0,))
        self.assertEqual(runs, list(range(1, count + 1)))


class Tables(SweepTest):
    def test_has_every_combination_once(self):
        self.sweep(self.scene, *self.grid)
        rows = self.rows()
        self.assertEqual(len(rows), 12)
        seen = {(row["gain"], row[ITERATIONS], row["seed"]) for row in rows}
        self.assertEqual(len(seen), 12)
        for row in rows:
            self.assertEqual((row["outcome"], row["exit_code"], row["ticks"], row["robots"]),
                             ("finished", "0", "3", "3"))
            self.assertRegex(row["hash"], "^[0-9a-f]{16}$")
        self.assertEqual(list((self.out / "runs").iterdir()), [], "what finished leaves nothing")
        self.assert_whole(12)
        # A run of the table is the run that the command line makes.
        row = rows[7]
        line = self.hash_of("--seed", row["seed"], "--param", f"gain={row['gain']}", "--set",
                            f"{ITERATIONS}={row[ITERATIONS]}", "--ticks", 3)
        self.assertEqual(line.split()[-1], row["hash"])

    def test_two_sweeps_have_equal_tables(self):
        self.sweep(self.scene, *self.grid)
        self.sweep(self.scene, *self.grid, "--quiet", out=self.folder / "again")
        self.assertEqual(self.rows(), self.rows(self.folder / "again"))

    def test_an_experiment_file_is_the_same_sweep(self):
        self.write("e.toml", f'scene = "arms.argos"\nseeds = "1..3"\nticks = 3\njobs = 2\nout = "results"\n'
                             f'[parameters]\ngain = [0.5, 2]\n[axes]\n"{ITERATIONS}" = [5, 10]\n')
        self.sweep("e.toml", out=False)
        self.assert_whole(12)
        outcome = self.sweep(self.scene, *self.grid)  # the same folder, by the other way
        self.assertIn("12 of 12 runs are done already", outcome.err)
        outcome = self.sweep("e.toml", "--seeds", "1..4", out=False, code=FAULT)
        self.assert_is_sentence(outcome, "--seeds belongs into e.toml")

    def test_dry_run_lists_the_runs(self):
        outcome = self.sweep(self.scene, *self.grid, "--dry-run")
        self.assertEqual(outcome.lines[0], f"run,gain,{ITERATIONS},seed")
        self.assertEqual(outcome.lines[1], "1,0.5,5,1")
        self.assertEqual(outcome.lines[12], "12,2,10,3")
        self.assertEqual(len(outcome.lines), 13)
        self.assertFalse(self.out.exists())

    def test_results_are_means(self):
        self.sweep(self.scene, *self.grid)
        outcome = self.sweep("results", self.out, "--by", "iterations", "--metric", "ticks", "--csv", out=False)
        self.assertEqual(outcome.lines, [f"{ITERATIONS},runs,failed,ticks,+-95%", "5,6,0,3,0", "10,6,0,3,0"])
        outcome = self.sweep("results", self.out, "--runs", out=False)
        self.assertEqual(len(outcome.lines), 13)
        outcome = self.sweep("results", self.out, "--metric", "tikcs", out=False, code=FAULT)
        self.assert_is_sentence(outcome, r"no run has a metric .tikcs.; did you mean 'ticks'\?")
        with sqlite3.connect(self.out / "sweep.sqlite") as database:
            self.assertEqual(database.execute("SELECT count(*), avg(gain) FROM results").fetchone(), (12, 1.25))

    def test_results_take_several_axes_and_metrics(self):
        """Of four combinations with three runs each, 3 ticks of 0.1 s."""
        self.sweep(self.scene, *self.grid)
        for by in (["--by", "gain,iterations"], ["--by", "gain", "--by", ITERATIONS]):
            for metric in (["--metric", "ticks,simulated_s"], ["--metric", "ticks", "--metric", "simulated_s"]):
                outcome = self.sweep("results", self.out, *by, *metric, "--csv", out=False)
                self.assertEqual(outcome.lines, [f"gain,{ITERATIONS},runs,failed,ticks,+-95%,simulated_s,+-95%",
                                                 "0.5,5,3,0,3,0,0.3,0", "0.5,10,3,0,3,0,0.3,0",
                                                 "2,5,3,0,3,0,0.3,0", "2,10,3,0,3,0,0.3,0"])
        outcome = self.sweep("results", self.out, "--by", "gain,iteratoins", out=False, code=FAULT)
        self.assert_is_sentence(outcome, "iteratoins")
        outcome = self.sweep("results", self.out, "--metric", "ticks,tikcs", out=False, code=FAULT)
        self.assert_is_sentence(outcome, r"no run has a metric .tikcs.; did you mean 'ticks'\?")

    def test_means_of_too_few_runs_have_their_number(self):
        """Only robots with a gain of 2 have the metric, and each combination has one run."""
        self.change('speed="2"', 'speed="${gain}"')
        self.write("swing.lua", "function init() end function step() if robot.params.speed == '2' then metric('high', 7) end end")
        self.sweep(self.scene, "--seeds", "1", "--param", "gain=0.5|2", "--ticks", "3")
        outcome = self.sweep("results", self.out, "--metric", "r0/high,ticks", "--csv", out=False)
        self.assertEqual(outcome.lines, ["gain,runs,failed,r0/high,+-95%,ticks,+-95%", "0.5,1,0,n=0,n=0,3,n=1", "2,1,0,7,n=1,3,n=1"])

    def test_plots_with_error_bars(self):
        self.sweep(self.scene, *self.grid)
        for _ in range(2):  # the picture before it is replaced
            self.sweep("plot", self.out, "--y", "wall_s", "--x", "gain", "--by", "iterations", out=False)
        svg = (self.out / "wall_s.svg").read_text()
        for text in (f">{ITERATIONS} = 10<", ">gain<", ">wall_s (mean, 95 % confidence)<", "<circle"):
            self.assertIn(text, svg)
        outcome = self.sweep("plot", self.out, "--y", "ticks", "--file", self.out / "results.csv", out=False, code=FAULT)
        self.assert_is_sentence(outcome, "results.csv")


class Failures(SweepTest):
    def setUp(self):
        super().setUp()
        script = self.folder / "swing.lua"
        script.write_text(script.read_text().replace(
            "steps = steps + 1", "steps = steps + 1\n   if robot.params.gain == '2' and fails() then error('gain') end")
            + "\nfunction fails() return io.open(robot.params.flag or 'flag') ~= nil end\n")

    def test_are_kept_and_retried(self):
        flag = self.write("flag", "")
        grid = [*self.grid, "--", "--trust-scripts"]
        outcome = self.sweep("--out", self.out, self.scene, *grid, out=False, code=CONTROLLER_FAILED)
        self.assertIn("12 runs: 6 finished, 6 failed", outcome.err)
        failed = [row for row in self.rows() if row["outcome"] == "failed"]
        self.assertEqual({(row["gain"], row["exit_code"], row["failures"]) for row in failed}, {("2", "3", "3")})
        log = self.out / "runs" / f"{int(failed[0]['run']):06}" / "log.txt"
        self.assertIn("gain", log.read_text())
        outcome = self.sweep("status", self.out, out=False)
        self.assertIn("12 of 12 runs are done, 6 of them failed", outcome.out)
        self.assertIn(str(log), outcome.out)
        flag.unlink()
        self.sweep("resume", self.out, out=False, code=CONTROLLER_FAILED)  # they are results, too
        self.sweep("resume", self.out, "--retry-failed", out=False)
        self.assertEqual({row["outcome"] for row in self.rows()}, {"finished"})
        self.assert_whole(12)
        self.assertEqual(list((self.out / "runs").iterdir()), [])

    def test_recordings_of_failed_runs_only(self):
        self.write("flag", "")
        outcome = self.sweep("--out", self.out, self.scene, *self.grid, "--record", "failed", "--",
                             "--trust-scripts", out=False, code=CONTROLLER_FAILED)
        kept = sorted(path.parent.name for path in self.out.glob("runs/*/run.mcap"))
        self.assertEqual(kept, [f"{run:06}" for run in range(7, 13)], outcome.err)

    def test_resume_keeps_recordings(self):
        """Of runs that are done, whatever the second command says of recordings."""
        self.write("flag", "")
        self.sweep("--out", self.out, self.scene, *self.grid, "--record", "all", "--", "--trust-scripts", out=False,
                   code=CONTROLLER_FAILED)
        self.assertEqual(len(list(self.out.glob("runs/*/run.mcap"))), 12)
        notes = self.out / "runs/000001/notes"
        notes.write_text("mine")
        self.sweep("resume", self.out, out=False, code=CONTROLLER_FAILED)
        (self.folder / "flag").unlink()
        self.sweep("resume", self.out, "--retry-failed", out=False)
        kept = sorted(path.parent.name for path in self.out.glob("runs/*/run.mcap"))
        self.assertEqual(kept, [f"{run:06}" for run in range(1, 7)], "the runs that were repeated record nothing")
        self.assertEqual(notes.read_text(), "mine")
        self.assertEqual(sorted(path.name for path in (self.out / "runs").iterdir()), kept)

    def test_a_run_that_takes_too_long_is_ended(self):
        outcome = self.sweep(self.scene, "--seeds", "1..2", "--duration", "100000000", "--timeout", "0.5",
                             code=CONTROLLER_FAILED)
        self.assertIn("took longer than 0.5 s", outcome.err)
        self.assertEqual([row["outcome"] for row in self.rows()], ["timed_out"] * 2)


class Refusals(SweepTest):
    def test_tell_what_to_write(self):
        good = ("--seeds", "1..2", "--ticks", "2")
        for arguments, pattern in (
                (("--axis", "physics_engines/dynamics3d/@iterashuns=1", *good), "iterashuns"),
                (("--axis", "physics_engine/@x=1", *good), "--axis 'physics_engine/@x=1': the path matches nothing"),
                (("--axis", f"{ITERATIONS}=5|no", *good), "iterations.*no"),
                (("--param", "gian=1", *good), "gian"),
                (("--param", "gain", *good), "write NAME=VALUE"),
                (("--seeds", "0..3"), "a seed is 0"),
                (("--seeds", "3..1"), "write 1..3"),
                (("--seeds", "1-10"), "--seeds is '1-10'; write 1..10"),
                ((*good, "--jobs", "0"), "--jobs is 0"),
                ((*good, "--timeout", "0"), "--timeout is 0"),
                ((*good, "--record", "some"), "write failed or all"),
                ((*good, "--", "--seed", "3"), "--seed is set by the sweep"),
                ((*good, "--", "--trace", "a.csv"), r"write \{run\} in it"),
                ((*good, "--", "--sumary", "a"), "unknown option '--sumary'"),
                (("--seeds", "1", "--ticks", "many"), "--ticks is 'many'"),
                ((*good, "--", "--deadline", "soon"), "soon"),
                ((*good, "--", "--record-every", "2"), "--record-every has no effect without --record"),
                (("--seeds", "1", "--duration", "0"), "has no length, so that a run may never end"),
                ((*good, "--param", "gain=1|nan"), ".gain. has the value .nan., which is no finite number")):
            outcome = self.ziggurat("sweep", "--out", self.out, self.scene, *arguments)
            self.assertEqual(outcome.code, FAULT, arguments)
            self.assert_is_sentence(outcome, pattern)
            self.assertFalse(self.out.exists(), arguments)

    def test_a_list_in_another_notation_is_doubted(self):
        for text, meant in (("1,2,3", "1|2|3"), ("1..3", "1|2|3"), ("4; 5", "4|5")):
            outcome = self.ziggurat("sweep", self.scene, "--dry-run", "--ticks", "2", "--param", f"gain={text}")
            self.assertEqual(outcome.code, FINISHED)
            self.assertRegex(outcome.err, r"warning: .*--param gain=.* is one value, .* --param 'gain=" + re.escape(meant))
        outcome = self.ziggurat("sweep", self.scene, "--dry-run", "--ticks", "2", "--param", "gain=fast|1.5")
        self.assertEqual(outcome.err, "")

    def test_a_folder_with_other_files_stays_as_it_is(self):
        self.out.mkdir()
        (self.out / "mine").write_text("")
        outcome = self.sweep(self.scene, "--seeds", "1", "--ticks", "2", code=FAULT)
        self.assert_is_sentence(outcome, "has files that are no sweep's")
        self.assertEqual([path.name for path in self.out.iterdir()], ["mine"])

    def test_a_folder_that_is_moved_away_is_named(self):
        process = self.start("sweep", self.scene, "--seeds", "1..500", "--ticks", "50", "--out", self.out)
        wait_until(lambda: (self.out / "runs").exists() or process.poll() is not None, "the first run")
        self.out.rename(self.folder / "elsewhere")
        _, err = process.communicate(timeout=LIMIT)
        self.assertEqual(process.returncode, FAULT, err)
        self.assertRegex(err, f"'{self.out}' was removed, moved or replaced while the sweep wrote to it.*sweep resume")
        self.assertFalse(self.out.exists(), "is made anew")

    def test_a_resumed_sweep_must_end_too(self):
        self.sweep(self.scene, "--seeds", "1", "--duration", "0", "--timeout", "0.5", code=CONTROLLER_FAILED)
        outcome = self.sweep("resume", self.out, "--retry-failed", out=False, code=FAULT)
        self.assert_is_sentence(outcome, "may never end; write --duration S or --timeout S")

    def test_nothing_runs_beside_tasks_that_are_queued(self):
        self.sweep(self.scene, "--seeds", "1..2", "--ticks", "2")
        (self.out / "cluster").mkdir()
        (self.out / "cluster/slurm_job").write_text("17\n")
        squeue = self.write("squeue", "#!/bin/sh\necho PENDING\necho RUNNING\n")
        squeue.chmod(0o755)
        self.environment["PATH"] = f"{self.folder}:{self.environment['PATH']}"
        for arguments in (("resume", self.out), (self.scene, "--seeds", "1..2", "--ticks", "2", "--out", self.out)):
            outcome = self.sweep(*arguments, out=False, code=FAULT)
            self.assert_is_sentence(outcome, r"still queued \(Slurm job 17: 1 PENDING, 1 RUNNING\)")
        self.assertEqual([path.name for path in (self.out / "cluster").iterdir()], ["slurm_job"])
        squeue.write_text("#!/bin/sh\n")
        self.sweep("resume", self.out, out=False)

    def test_tasks_repeat_no_run_of_this_machine(self):
        self.sweep(self.scene, *self.grid)
        (self.out / "cluster").mkdir()
        (self.out / "tasks").mkdir()
        (self.out / "cluster/chunk").write_text("5\n")
        outcome = self.sweep("task", self.out, "--task", "1", out=False)
        self.assertIn("task 1: 0 runs finished", outcome.err)

    def test_folders_of_others(self):
        self.sweep(self.scene, "--seeds", "1..2", "--ticks", "2")
        outcome = self.sweep(self.scene, "--seeds", "1..3", "--ticks", "2", code=FAULT)
        self.assert_is_sentence(outcome, "results of another sweep: it has 2 seeds from 1 to 2")
        script = self.folder / "swing.lua"
        script.write_text(script.read_text() + "\n")
        outcome = self.sweep("resume", self.out, out=False, code=FAULT)
        self.assert_is_sentence(outcome, "swing.lua has changed since the sweep")
        outcome = self.sweep(self.scene, "--seeds", "1", out=self.folder, code=FAULT)
        self.assert_is_sentence(outcome, "has files that are no sweep's")
        outcome = self.sweep("status", self.folder, out=False, code=FAULT)
        self.assert_is_sentence(outcome, "is no folder of a sweep")


class Kills(SweepTest):
    def setUp(self):
        super().setUp()
        self.arguments = (self.scene, "--seeds", f"1..{max(3, KILLS // 2)}", "--param", "gain=1|2", "--axis",
                          f"{ITERATIONS}=5|10", "--ticks", "20", "--jobs", "2")
        self.count = 4 * max(3, KILLS // 2)

    def children(self, pid):
        return [int(entry) for entry in
                self.read_or_none(f"/proc/{pid}/task/{pid}/children").split()]

    @staticmethod
    def read_or_none(path):
        try:
            with open(path) as file:
                return file.read()
        except OSError:
            return ""

    def runs_of(self, sweep):
        """Runs that the sweep started; its guardian is no run."""
        return [pid for pid in self.children(sweep.pid)
                if "\0run\0" in self.read_or_none(f"/proc/{pid}/cmdline")]

    def test_nothing_is_lost_double_or_half(self):
        """Kills the sweep, or one of its runs, at random moments; the same command goes on each time."""
        chance = random.Random(11)
        killed = {"sweep": 0, "run": 0}
        while sum(killed.values()) < KILLS:
            sweep = self.start("sweep", *self.arguments, "--out", self.out, "--quiet")
            time.sleep(chance.uniform(0.05, 0.5))  # the moment is random
            runs = self.runs_of(sweep)
            whom = chance.choice(("sweep", "run"))
            if whom == "run" and runs:
                os.kill(chance.choice(runs), signal.SIGKILL)
                killed["run"] += 1
                time.sleep(chance.uniform(0, 0.2))  # so is this
            if sweep.poll() is not None:
                self.assertEqual(sweep.returncode, FINISHED, self.logs())
                shutil.rmtree(self.out)  # all done: once more
                continue
            sweep.kill()
            sweep.communicate()
            killed["sweep"] += 1
        self.sweep(*self.arguments)
        self.assert_whole(self.count)
        self.sweep(*self.arguments, out=self.folder / "calm")
        self.assertEqual(self.rows(), self.rows(self.folder / "calm"))
        print(f"killed: {killed}; {self.count} runs, each once")
        # A run that is killed when it has just made its folder leaves it empty; the next run removes it
        # (private_folder.cpp). One with anything in it is a fault.
        self.wait_for(self.left_in_runtime, lambda left: not left, "end of the guardians")
        for left in self.runtime.iterdir():
            left.rmdir()

    def left_in_runtime(self):
        """Files in its folders."""
        return list(self.runtime.glob("*/*"))

    def logs(self):
        """Of the runs that failed."""
        return "\n".join(f"--- {log}\n{log.read_text()}" for log in self.out.glob("runs/*/log.txt"))

    def test_ctrl_c_says_how_to_go_on(self):
        self.out = self.folder / "my results"
        sweep = self.start("sweep", *self.arguments, "--out", self.out, "--timeout", "50", "--retry-failed")
        self.wait_for(lambda: self.runs_of(sweep), lambda runs: runs, "runs")
        start = time.monotonic()
        self.interrupt(sweep)
        outcome = self.finish(sweep)
        self.assertFalse(self.is_late(start, 2))
        self.assertEqual(outcome.code, INTERRUPTED)
        command = re.search(r"to go on: ziggurat (sweep resume .*)", outcome.err)[1]
        command = shlex.split(command)
        self.assertEqual(command[2], str(self.out))
        self.assertEqual(command[-3:], ["--timeout", "50", "--retry-failed"])
        self.assertIn("to go on", self.sweep("status", self.out, out=False).out)
        self.assertEqual(self.ziggurat(*command).code, FINISHED)
        self.assert_whole(self.count)

    def test_two_at_a_time_are_refused(self):
        sweep = self.start("sweep", *self.arguments, "--out", self.out, "--quiet")
        self.wait_for(lambda: self.runs_of(sweep), lambda runs: runs, "runs")
        sweep.send_signal(signal.SIGSTOP)
        outcome = self.sweep(*self.arguments, code=FAULT)
        self.assert_is_sentence(outcome, "another program works on this sweep now")
        self.assertIn("a sweep works on the others", self.sweep("status", self.out, out=False).out)
        sweep.send_signal(signal.SIGCONT)
        self.assertEqual(self.finish(sweep).code, FINISHED)


if __name__ == "__main__":
    main()
