# SPDX-License-Identifier: MIT
"""`ziggurat sweep --slurm` on a real Slurm that this test starts: tasks are killed on the way, and its table is
that of a sweep on this machine. And a world whose controllers are on another node."""

import math
import os
import re
import signal
import sqlite3
import subprocess
import time
import unittest

import slurm_cluster
from harness import BIN, FAULT, HERE, main
from sweep_test import ITERATIONS, SweepTest

REASON = slurm_cluster.why_not()


@unittest.skipIf(REASON, REASON)
class SlurmTest(SweepTest):
    def setUp(self):
        super().setUp()
        self.cluster = slurm_cluster.Cluster()
        self.addCleanup(self.cluster.stop)
        self.environment.update(self.cluster.environment, XDG_RUNTIME_DIR=str(self.runtime))
        self.grid = ["--seeds", "1..4", "--param", "gain=1|2", "--axis", f"{ITERATIONS}=5|10", "--ticks", "20"]

    def wait_until_over(self):
        self.wait_for(lambda: self.cluster.ask("squeue", "--noheader", "--format=%i"), lambda text: not text.strip(),
                      f"end of the job:\n{self.cluster.ask('scontrol', 'show', 'job')}\n{self.cluster.logs()}")

    def requeue(self, task):
        """Slurm lets a requeued task wait for two minutes; here three seconds. A node refuses it within the second
        in which it ended the former one: "job credential revoked"; and Slurm refuses to change the time of a task
        that is still ending, so it is asked again."""
        self.cluster.ask("scontrol", "requeue", task)

        def show():
            return self.cluster.ask("scontrol", "show", "job", task)

        self.wait_for(show, lambda text: re.search("JobState=(PENDING|COMPLETED)|Restarts=[1-9]", text), "end of the former task")
        asked = -math.inf

        def runs(text):
            nonlocal asked
            if "JobState=PENDING" in text and time.monotonic() > asked + 10:
                asked = time.monotonic()
                self.cluster.ask("scontrol", "update", f"JobId={task}", "StartTime=now+3")
            return re.search(r"JobState=(RUNNING|COMPLETED|FAILED)", text)

        self.wait_for(show, runs, "requeued task")

    def tasks(self):
        """Ids of the processes `ziggurat sweep task` of this test."""
        return [pid for pid, _ in self.processes("sweep task", str(self.out))]

    def test_killed_tasks_go_on_and_the_table_is_that_of_one_machine(self):
        outcome = self.sweep(self.scene, *self.grid, "--slurm", "--chunk", "4", "--partition", "test")
        job = re.search(r"submitted job (\d+) with 4 tasks of at most 4 runs", outcome.err)[1]
        self.wait_for(lambda: list(self.out.glob("tasks/*.sqlite")), lambda found: found, "tasks")
        status = self.sweep("status", self.out, out=False).out
        self.assertRegex(status, rf"of 16 runs are done|Slurm job {job}")
        refused = self.sweep(self.scene, *self.grid, "--slurm", code=FAULT)
        self.assert_is_sentence(refused, f"still queued .Slurm job {job}")
        # One task is killed, with kill -9; another is requeued, as when its node is taken away.
        victims = self.wait_for(self.tasks, lambda found: found, "task")
        os.kill(victims[0], signal.SIGKILL)
        self.requeue(f"{job}_1")
        self.wait_until_over()
        # The tasks that died with runs to do are submitted again, the others not.
        outcome = self.sweep(self.scene, *self.grid, "--slurm")
        if "submitted" in outcome.err:
            self.assertNotIn("with 4 tasks", outcome.err)
            self.wait_until_over()
        self.assertIn("16 of 16 runs are done, 0 of them failed", self.sweep("status", self.out, out=False).out)
        self.sweep("results", self.out, out=False)
        self.assert_whole(16)
        self.sweep(self.scene, *self.grid, out=self.folder / "here")
        self.assertEqual(self.rows(), self.rows(self.folder / "here"))

    def test_a_requeued_task_repeats_nothing(self):
        self.sweep(self.scene, *self.grid, "--slurm", "--chunk", "16")
        ledger = self.out / "tasks/0000.sqlite"

        def walls():
            if not ledger.exists():
                return {}
            with sqlite3.connect(ledger) as database:
                try:
                    return dict(database.execute("SELECT run, wall_s FROM runs").fetchall())
                except sqlite3.OperationalError:  # the task has just made the file
                    return {}

        before = self.wait_for(walls, lambda found: len(found) >= 2, "rows")
        task = self.cluster.ask("squeue", "--noheader", "--array", "--format=%i").split()[0]
        self.requeue(task)
        state = self.wait_for(lambda: self.cluster.ask("scontrol", "show", "job", task),
                              lambda text: re.search(r"JobState=(COMPLETED|FAILED)", text), "end of the task")
        self.assertIn("JobState=COMPLETED", state, self.logs())
        after = walls()
        self.assertEqual(len(after), 16, self.logs())
        self.assertEqual({run: after[run] for run in before}, before, "rows from before are left alone")

    def test_a_world_whose_controllers_are_on_another_node(self):
        """Its director is started beside the server, as `ziggurat run` starts it."""
        self.write("judge.lua", "function post_step(k) if k == 12 then world.finish('enough') end end")
        self.change("</framework>", '</framework><director id="judge" script="judge.lua" />')
        hashes, log = self.folder / "hashes", self.folder / "world.log"
        script = HERE.parents[1] / "scenes/cluster/world.sh"
        self.environment["PATH"] = f"{BIN}:{self.environment['PATH']}"
        job = self.start_job("--nodes=2", "--ntasks-per-node=1", f"--output={log}", f"--chdir={self.folder}", script,
                             self.scene, "--hash-file", hashes, "--ticks", "20")
        self.wait_until_over()
        self.assertIn("ExitCode=0:0", self.cluster.ask("scontrol", "show", "job", job), log.read_text())
        self.assertIn("NumNodes=2", self.cluster.ask("scontrol", "show", "job", job))
        self.assertEqual(hashes.read_text().splitlines()[-1], self.hash_of("--ticks", 20), log.read_text())
        self.assertIn("director 'judge' ended the run: enough", log.read_text())

    def start_job(self, *arguments):
        done = subprocess.run(["sbatch", "--parsable", *map(str, arguments)], env=self.environment, text=True,
                              cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        self.assertEqual(done.returncode, 0, done.stdout)
        return done.stdout.split(";")[0].strip()

    def logs(self):
        return "\n".join(path.read_text() for path in self.out.glob("cluster/*.log"))


if __name__ == "__main__":
    main()
