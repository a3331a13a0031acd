# SPDX-License-Identifier: MIT
"""Hardware in the loop: injected delays and losses of messages, and the report cards."""

import csv
import json
import re

from harness import FAULT, SceneTest, main

EACH_ALONE = ("--lua-processes", 0)  # one session per robot, so that controllers do not share one


class Injected(SceneTest):
    def setUp(self):
        super().setUp()
        controller = re.search(r"<lua_controller id=\"swing\">.*?</lua_controller>", self.text, re.S)
        self.change("</controllers>",
                    controller[0].replace('"swing"', '"other"') + "</controllers>")
        self.change('<controller config="swing">', '<controller config="other">')  # of r2

    def cards(self, *arguments):
        """The run's outcome and the report card of each controller."""
        outcome = self.run_scene("--report-card", "card.json", *EACH_ALONE, *arguments)
        card = json.loads((self.folder / "card.json").read_text())
        return outcome, {each["controller"]: each for each in card["controllers"]}

    def test_latency_is_in_the_report_card(self):
        outcome, cards = self.cards("--hil", "--real-time", 2, "--ticks", 30, "--inject",
                                    "swing=latency=5ms", "--deadline", "hold:5000")
        self.assertGreaterEqual(cards["swing"]["wall_latency_s"]["p50"], 0.010)
        worst = [each["wall_s"] for each in cards["swing"]["worst"]]
        self.assertGreaterEqual(min(worst), 0.010)
        self.assertEqual(cards["swing"]["injected"]["commands"],
                         {"latency_s": 0.005, "jitter_s": 0.0, "loss": 0.0, "lost": 0})
        self.assertEqual(cards["other"]["injected"]["commands"]["latency_s"], 0)
        self.assertIn("injected: each way 5 ms; 0 observations and 0 commands", outcome.err)

    def test_only_a_session_without_commands_misses_every_tick(self):
        _, cards = self.cards("--hil", "--real-time", 2, "--ticks", 5, "--inject",
                              "swing=commands:loss=100%", "--deadline", "swing=hold:500",
                              "--deadline", "other=hold:20000")
        self.assertEqual(cards["swing"]["misses"], 6)  # of the ticks 0 to 5
        self.assertEqual(cards["swing"]["answers"], 0)
        self.assertEqual(cards["swing"]["unanswered"], 12, "two sessions")
        self.assertEqual(cards["swing"]["longest_run_of_misses"], 6)
        self.assertGreaterEqual(cards["swing"]["wall_latency_s"]["p50"], 0.5, "the deadline at least")
        # Two sessions, each with 0.5 s for a command. The last command of each may arrive after the run;
        # then it does not count as lost.
        self.assertIn(cards["swing"]["injected"]["commands"]["lost"], range(10, 13))
        self.assertEqual((cards["other"]["misses"], cards["other"]["answers"]), (0, 6))

    def test_late_commands_count_for_the_gate(self):
        # Commands arrive 60 ms after observations, 30 ms after the deadline.
        arguments = ("--hil", "--real-time", 2, "--ticks", 20, "--inject", "swing=commands:latency=60ms",
                     "--deadline", "swing=hold:30", "--gate", "p99<45ms")
        outcome = self.run_scene("--report-card", "card.csv", "--warm-up", 5, *EACH_ALONE, *arguments, code=4)
        self.assertRegex(outcome.err, r"MISSED  p99<45ms: \d")
        self.assertRegex(outcome.err, r"seed \d+, 20\d\d-\d\d-\d\dT")
        self.assertLessEqual(outcome.err.count("missed its deadline of 30 ms"), 4, "summarised")
        with open(self.folder / "card.csv") as table:
            lines = list(csv.DictReader(table))
        self.assertEqual({line["tick"] for line in lines}, {str(tick) for tick in range(21)})
        self.assertEqual({line["warm_up"] for line in lines if int(line["tick"]) < 5}, {"1"})
        self.assertEqual({line["warm_up"] for line in lines if int(line["tick"]) >= 5}, {"0"})
        self.assertEqual({line["robot"] for line in lines if line["controller"] == "swing"}, {"r0", "r1"})
        late = [line for line in lines if line["controller"] == "swing" and line["outcome"] == "late"]
        self.assertGreater(len(late), 30, "all but the last few")
        self.assertGreaterEqual(min(float(line["wall_latency_s"]) for line in late), 0.060)

    def test_the_picture_has_the_deadline_and_the_verdict(self):
        self.run_scene("--hil", "--real-time", 5, "--ticks", 10, "--deadline", "hold:5000", "--gate", "p50<4s",
                       "--report-card", "card.svg")
        picture = (self.folder / "card.svg").read_text()
        for part in ("deadline hold:5000", "gate met", "period 20 ms", "seed "):
            self.assertIn(part, picture)

    def test_a_seed_loses_the_same_messages_again(self):
        def lines(seed):
            # A deadline that no controller misses whose observation arrives, on a busy machine, too.
            outcome, cards = self.cards("--ticks", 20, "--seed", seed, "--hash", "--deadline",
                                        "hold:4000", "--inject", "swing=observations:loss=10%")
            self.assertLess(cards["swing"]["misses"], 21)
            # init() and step(); destroy() is always called
            steps = re.findall(r"^\[(\d+ r[01])\] [is]", outcome.out, re.M)
            self.assertEqual(42 - len(steps), cards["swing"]["injected"]["observations"]["lost"])
            self.assertEqual(len(re.findall(r"^\[\d+ r2\] [is]", outcome.out, re.M)), 21)
            return steps, outcome.lines[-1]

        first = lines(3)
        self.assertLess(len(first[0]), 42)
        self.assertEqual(lines(3), first)
        self.assertNotEqual(lines(4)[0], first[0])

    def test_delays_alone_change_no_result(self):
        expected = self.hash_of("--ticks", 10)
        self.assertEqual(self.hash_of("--ticks", 10, "--inject", "latency=3ms,jitter=3ms"), expected)

    def test_losses_that_would_make_the_world_wait_forever_are_refused(self):
        outcome = self.run_scene("--inject", "loss=1%", code=FAULT)
        self.assert_is_sentence(outcome, "controller 'swing', for which the world would wait forever.*--hil")
        outcome = self.run_scene("--inject", "swong=latency=1ms", code=FAULT)
        self.assert_is_sentence(outcome, "no controller or director 'swong'; did you mean 'swing'")


if __name__ == "__main__":
    main()
