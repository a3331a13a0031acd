# SPDX-License-Identifier: MIT
"""What came out: on the terminal, as JUnit XML, as JSON, as a page."""

import collections
import html
import json
import sys
from xml.etree import ElementTree

from .case import Level, Outcome, Verdict

_COLORS = {
    Verdict.PASS: "32",
    Verdict.FAIL: "31",
    Verdict.NON_STRICT: "33",
    Verdict.UNIMPLEMENTED: "36",
    Verdict.KNOWN_FAILING: "33",
    Verdict.NOT_RUN: "90",
}


def judge_known(outcomes: list, known: set) -> None:
    """Cases that are listed as failing must fail; one that passes is a failure of the list. An id
    without form means the case in every form."""
    for outcome in outcomes:
        if outcome.id not in known and outcome.id.removesuffix("/json") not in known:
            continue
        if outcome.verdict in (Verdict.FAIL, Verdict.NON_STRICT):
            outcome.verdict = Verdict.KNOWN_FAILING
        elif outcome.verdict is Verdict.PASS:
            outcome.verdict = Verdict.FAIL
            outcome.reason = "it is listed as known to fail, and passes: take it off the list"


def good(outcomes: list) -> bool:
    return not any(outcome.verdict is Verdict.FAIL for outcome in outcomes)


def badges(outcomes: list, left_out: collections.Counter) -> dict:
    """Level → whether all of its cases passed; None if none failed and some were not played. Of Core it
    takes the MUSTs, of the other levels the SHOULDs too.
    left_out: how many cases of each level were not chosen."""
    result = {}
    for level in Level:
        counts = _counts(outcomes, level)
        if counts.total() + left_out[level] == 0:
            continue  # there is no case of it
        passed = counts[Verdict.PASS] + (counts[Verdict.NON_STRICT] if level is Level.CORE else 0)
        is_good = passed + counts[Verdict.NOT_RUN] == counts.total()
        is_whole = passed == counts.total() and not left_out[level]
        result[level] = is_whole or (None if is_good else False)
    return result


def missing_badges(outcomes: list, left_out: collections.Counter, wanted: list) -> list:
    """Names of those levels that were not reached."""
    reached = badges(outcomes, left_out)
    return [level.value for level in Level if level.value.lower() in wanted and not reached.get(level)]


def _counts(outcomes: list, level: Level) -> collections.Counter:
    return collections.Counter(outcome.verdict for outcome in outcomes if outcome.level is level)


def _badge_text(outcomes: list, level: Level, reached, left_out: collections.Counter) -> str:
    """"reached", or why not."""
    if reached:
        return "reached"
    counts = _counts(outcomes, level)
    reasons = [f"{counts[verdict]} {verdict.value}" for verdict in Verdict
               if counts[verdict] and verdict is not Verdict.PASS
               and (verdict is not Verdict.NON_STRICT or level is not Level.CORE)]
    if left_out[level]:
        reasons.append(f"{left_out[level]} not chosen")
    return f"{'open' if reached is None else 'not reached'}: {', '.join(reasons)}"


_LINES, _COLUMNS = 30, 200  # of an exchange on the terminal; the page has all


def _cut(line: str) -> str:
    return line if len(line) <= _COLUMNS else line[:_COLUMNS - 1] + "…"


class Terminal:
    """Lines as cases end: failures at once and in full; unless asked for, a dot for what passes and a
    dash for what is not run."""

    def __init__(self, verbose: bool):
        self._verbose = verbose
        self._colored = sys.stdout.isatty()
        self._column = 0

    def outcome(self, outcome: Outcome) -> None:
        if outcome.verdict in (Verdict.PASS, Verdict.NOT_RUN) and not self._verbose:
            self._column += 1
            print("." if outcome.verdict is Verdict.PASS else "-", end="" if self._column % 80 else "\n", flush=True)
            return
        if self._column % 80:
            print()
        self._column = 0
        word = outcome.verdict.value
        if self._colored:
            word = f"\033[{_COLORS[outcome.verdict]}m{word}\033[0m"
        print(f"{word:<14} {outcome.id}: {outcome.title}")
        if outcome.reason and outcome.verdict is not Verdict.PASS:
            print(f"               {outcome.reason}")
        if outcome.transcript:
            print("\n".join("               " + _cut(line)
                            for line in outcome.transcript.splitlines()[-_LINES:]))

    def end(self, outcomes: list, left_out: collections.Counter, seconds: float) -> None:
        if self._column % 80:
            print()
        counts = collections.Counter(outcome.verdict for outcome in outcomes)
        parts = [f"{counts[verdict]} {verdict.value}" for verdict in Verdict if counts[verdict]]
        print(f"{len(outcomes)} cases in {seconds:.1f} s: {', '.join(parts)}")
        reasons = collections.Counter(o.reason for o in outcomes if o.verdict is Verdict.NOT_RUN)
        for reason, count in reasons.items():
            print(f"  {count} not run: {reason}")
        for level, reached in badges(outcomes, left_out).items():
            print(f"  {level.value:<10} {_badge_text(outcomes, level, reached, left_out)}")


def junit(outcomes: list, suite: str) -> bytes:
    root = ElementTree.Element("testsuite", name=suite, tests=str(len(outcomes)))
    for outcome in outcomes:
        case = ElementTree.SubElement(
            root, "testcase", classname=f"{suite}.{outcome.level.value}", name=outcome.id,
            time=f"{outcome.seconds:.3f}")
        if outcome.verdict is Verdict.FAIL:
            failure = ElementTree.SubElement(case, "failure", message=_plain(outcome.reason))
            failure.text = _plain(outcome.transcript)
        elif outcome.verdict is not Verdict.PASS:
            ElementTree.SubElement(
                case, "skipped", message=_plain(f"{outcome.verdict.value}: {outcome.reason}"))
    root.set("failures", str(sum(o.verdict is Verdict.FAIL for o in outcomes)))
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)


def _plain(text: str) -> str:
    """Text that XML can hold."""
    return "".join(c if c >= " " or c in "\n\t" else "?" for c in _bytes(text).decode())


def _bytes(text: str) -> bytes:
    """Half pairs of surrogates stand for bytes of the command line that are no text."""
    return text.encode(errors="replace")


def json_of(outcomes: list, left_out: collections.Counter) -> bytes:
    document = {
        "badges": {level.value: reached for level, reached in badges(outcomes, left_out).items()},
        "cases": [
            {"id": o.id, "title": o.title, "level": o.level.value, "verdict": o.verdict.value,
             "seconds": round(o.seconds, 3), "reason": o.reason, "transcript": o.transcript}
            for o in outcomes
        ],
    }
    return _bytes(json.dumps(document, indent=1, ensure_ascii=False) + "\n")


_PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>{title}</title>
<style>
body {{ font: 15px/1.5 sans-serif; margin: 2em auto; max-width: 70em; padding: 0 1em; }}
table {{ border-collapse: collapse; width: 100%; }}
td, th {{ text-align: left; padding: .2em .6em; border-bottom: 1px solid #ddd; vertical-align: top; }}
pre {{ background: #f4f4f4; padding: .8em; overflow-x: auto; font-size: 12px; }}
.pass {{ color: #187a2f; }} .fail {{ color: #b3161b; font-weight: bold; }}
.non-strict, .known-failing {{ color: #96690c; }} .unimplemented, .not {{ color: #666; }}
.badge {{ display: inline-block; padding: .2em .8em; border-radius: 1em; margin-right: .5em;
         border: 1px solid; }}
</style>
<h1>{title}</h1>
<p>{badges}</p>
<p>{counts}</p>
{failures}
<h2>All cases</h2>
<table><tr><th>case<th>what<th>level<th>verdict</tr>
{rows}
</table></html>
"""


def _why(outcome: Outcome) -> str:
    """What stands behind a verdict in the table; failures have a chapter of their own."""
    if outcome.verdict in (Verdict.PASS, Verdict.FAIL) or not outcome.reason:
        return ""
    return f"<br><small>{html.escape(outcome.reason)}</small>"


def page(outcomes: list, left_out: collections.Counter, title: str) -> bytes:
    """One page that needs nothing else: every verdict, and the exchange of every failure."""
    escape = html.escape
    rows = "\n".join(
        f"<tr><td>{escape(o.id)}<td>{escape(o.title)}<td>{o.level.value}"
        f'<td class="{o.verdict.value}">{o.verdict.value}{_why(o)}</tr>' for o in outcomes)
    failures = "\n".join(
        f"<h2>{escape(o.id)}: {escape(o.title)}</h2><p>{escape(o.reason)}</p>"
        f"<pre>{escape(o.transcript)}</pre>" for o in outcomes if o.verdict is Verdict.FAIL)
    words = {True: "pass", False: "fail", None: "not"}
    shown = "".join(
        f'<span class="badge {words[reached]}">{level.value}: '
        f"{escape(_badge_text(outcomes, level, reached, left_out))}</span>"
        for level, reached in badges(outcomes, left_out).items())
    counts = collections.Counter(o.verdict.value for o in outcomes)
    return _bytes(_PAGE.format(
        title=escape(title), badges=shown, rows=rows, failures=failures,
        counts=", ".join(f"{count} {verdict}" for verdict, count in counts.items())))
