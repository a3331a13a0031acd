# SPDX-License-Identifier: MIT
"""One session as both of its ends see it: every message of either direction is judged and remembered."""

import collections
import enum
from typing import Iterator, Optional, Union

from ..wire import protocol
from .command import PER_ROBOT, command_faults, leave_faults, metric_faults
from .directing import direction_faults, last_words_faults, world_state_faults
from .error import error_faults
from .fault import Fault, musts
from .hello import hello_faults
from .observation import commanded_faults, observation_faults, welcome_faults
from .requests import Requests
from .versions import version_faults

STRANGERS_LIMIT = 64 << 10  # [bytes] of a message without a session
_MOST_METRICS = 100  # of a robot
_Error = protocol.Error
_PASSING = {_Error.ROBOT_TAKEN, _Error.TOO_MANY}  # reasons of a Refusal that may pass with time
_THAT_WAIT = (protocol.DeadlinePolicy.ACTION_UNSPECIFIED, protocol.DeadlinePolicy.WAIT)


class State(enum.Enum):
    NEW = "NEW"
    HELLO = "HELLO"
    READY = "READY"
    STEPPING = "STEPPING"
    PAUSED = "PAUSED"
    DRAINING = "DRAINING"
    CLOSED = "CLOSED"


_ANY_STATE = {"error", "heartbeat", "response"}
_DIRECTED = {"world_layout", "world_state"}
_RUNNING = {*_DIRECTED, "observation", "paused", "reset", "restored", "end", "displaced", "robot_spawned"}
# Section 4: what a client may receive. What is on its way in DRAINING and CLOSED is not judged.
_RECEIVED = {
    State.NEW: {"refusal"},
    State.HELLO: {"loading", "welcome", "refusal"},
    State.READY: {*_DIRECTED, "observation", "end", "displaced", "robot_spawned"},
    State.STEPPING: _RUNNING,
    State.PAUSED: _RUNNING,
}


class Session:
    """`said` and `told` return the Faults of a message of the client or the server."""

    def __init__(self) -> None:
        self.state = State.NEW
        self.hello: Optional[protocol.Hello] = None  # the last
        self.welcome: Optional[protocol.Welcome] = None
        self.tick: Optional[int] = None  # of the last Observation
        self.epoch: Optional[int] = None  # the same; None: a session of an earlier version
        self.owes = False
        self.missed: set[int] = set()  # ticks that went on without a Command, which may still come
        self.left: set[int] = set()  # positions
        self.is_displaced = False
        self.is_lost = False  # by a FATAL error: a Leave is no fault
        self.is_refused = False  # and no retry is promised to help
        self.is_certain = True  # False: bytes were sent that may have changed its state
        self._is_new_world = True  # the next Observation may have another tick than a later one
        self._due_tick: Optional[int] = None  # of that Observation; None: any
        self._due_epoch: Optional[int] = None
        self._world: Optional[list] = None  # what a director was told of; None: nothing yet
        self._used: set = set()  # (field, position) that were commanded since the start or a reset
        self._metrics: set = set()  # (position, name) of this world
        self._must_repeat = False  # W6: the next Command should have them all
        self._heartbeats: list[int] = []  # sequences that the server sent
        self._requests = Requests()

    # ---- the client --------------------------------------------------------------------------------

    def said(self, message: protocol.ClientMessage, size: int) -> list:
        """Faults of a client's message of so many bytes; if there is a MUST, it had no effect."""
        kind = message.WhichOneof("message")
        if kind is None:
            return [Fault("T2", "a message holds nothing that protocol 1.0 knows", "MALFORMED")]
        faults = [*self._size_faults(kind, size), *_said[kind](self, getattr(message, kind))]
        if kind == "request":
            self._requests.said(message.request)
        is_greeting = kind == "hello" and self.state in (State.NEW, State.CLOSED)  # Loading may answer it
        if is_greeting or not musts(faults):
            _after_said.get(kind, lambda *_: None)(self, getattr(message, kind))
        return faults

    def _size_faults(self, kind: str, size: int) -> Iterator[Fault]:
        limit = STRANGERS_LIMIT
        if self.welcome is not None and self.state not in (State.NEW, State.HELLO, State.CLOSED):
            limit = self.welcome.max_message_bytes
        if size > limit:
            yield Fault("T4", f"a message of {size} bytes; at most {limit} are allowed", "TOO_LARGE")

    def _judge_hello(self, hello: protocol.Hello) -> Iterator[Fault]:
        if self.is_displaced:
            yield Fault("L10", "a Hello after Displaced: it takes its robots back unasked")
        if self.state is State.HELLO:
            yield Fault("H1", "a second Hello before the answer to the first", "OUT_OF_STATE")
        elif self.state not in (State.NEW, State.CLOSED):
            yield Fault("M0", f"a Hello in {self.state.value}", "OUT_OF_STATE")
        if self.is_refused:
            yield Fault("H10", "a Hello after a Refusal that is not retryable", should=True)
        yield from hello_faults(hello)

    def _judge_command(self, command: protocol.Command) -> Iterator[Fault]:
        if self.state in (State.NEW, State.HELLO, State.READY, State.CLOSED):
            rule = "H1" if self.state is State.NEW else "M0"
            yield Fault(rule, f"a Command in {self.state.value}", "OUT_OF_STATE")
            return
        if self.welcome.role == protocol.ROLE_DIRECTOR:
            yield Fault("R2", "a Command of a director", "OUT_OF_STATE")
            return
        if self.state is State.DRAINING and command.tick in self.missed:
            return  # it was on its way (M1)
        if self.state is State.DRAINING:
            yield Fault("L5", f"a Command for tick {command.tick} after the End")
        else:
            yield from self._tick_faults(command, "Command", "Observation", "S9")
        if self.epoch is not None and not command.HasField("epoch"):
            yield Fault("S13", "a Command without epoch, though its Observation has one", should=True)
        yield from command_faults(self.welcome.robots, self.left, command)
        yield from self._metric_faults(command.metrics)
        if self._must_repeat and self.owes and command.tick == self.tick:
            lost = {field for field, _ in self._used - self._commanded(command)}
            if lost:
                yield Fault("W6", f"after a missed deadline the next Command has no {', '.join(sorted(lost))}, "
                            "which were commanded before", should=True)

    def _judge_direction(self, direction: protocol.Direction) -> Iterator[Fault]:
        if self.state in (State.NEW, State.HELLO, State.READY, State.CLOSED):
            yield Fault("M0", f"a Direction in {self.state.value}", "OUT_OF_STATE")
            return
        if self.welcome.role != protocol.ROLE_DIRECTOR:
            yield Fault("R2", "a Direction of a session that is no director", "OUT_OF_STATE")
            return
        if self.state is State.DRAINING:
            return
        yield from self._tick_faults(direction, "Direction", "WorldState", "R2")
        yield from direction_faults(direction)

    def _tick_faults(self, answer, name: str, told: str, rule: str) -> Iterator[Fault]:
        """What is wrong with the epoch and the tick of an answer to what was told."""
        if answer.HasField("epoch") and self.epoch is not None and answer.epoch != self.epoch:
            yield Fault("S13", f"a {name} of epoch {answer.epoch}; the last {told} is of {self.epoch}",
                        "FUTURE_TICK" if answer.epoch > self.epoch else "STALE_TICK", "epoch")
        elif answer.tick > self.tick:
            yield Fault(rule, f"a {name} for tick {answer.tick}; the last {told} is of {self.tick}",
                        "FUTURE_TICK", "tick")
        elif answer.tick < self.tick and answer.tick not in self.missed:
            yield Fault(rule, f"a {name} for tick {answer.tick}; the last {told} is of {self.tick}",
                        "STALE_TICK", "tick")
        elif answer.tick == self.tick and not self.owes and answer.tick not in self.missed:
            yield Fault(rule, f"a second {name} for tick {answer.tick}", "DUPLICATE_TICK", "tick")

    def _judge_leave(self, leave: protocol.Leave) -> Iterator[Fault]:
        if self.state in (State.NEW, State.CLOSED) and not self.is_lost:
            yield Fault("M0", f"a Leave in {self.state.value}", "OUT_OF_STATE")
        elif self.state in (State.NEW, State.HELLO, State.CLOSED):
            return
        if self.welcome and self.welcome.role == protocol.ROLE_DIRECTOR:
            yield from last_words_faults(leave)
            return
        yield from leave_faults(len(self.welcome.robots) if self.welcome else 0, self.left, leave)
        if self.welcome:
            yield from self._metric_faults(leave.metrics)

    def _metric_faults(self, metrics) -> Iterator[Fault]:
        if self.welcome.version.minor < 3:
            return
        yield from metric_faults(len(self.welcome.robots), metrics)
        names = self._metrics | {(metric.robot, metric.name) for metric in metrics}
        for position, count in collections.Counter(position for position, _ in names).items():
            if count > _MOST_METRICS:
                yield Fault("S14", f"robot {position} has {count} metrics; {_MOST_METRICS} are allowed in a run",
                            "TOO_MANY", "metrics")

    def _judge_heartbeat(self, heartbeat: protocol.Heartbeat) -> Iterator[Fault]:
        if self.state in (State.NEW, State.CLOSED):
            yield Fault("M0", f"a Heartbeat in {self.state.value}", "OUT_OF_STATE")
        if heartbeat.sequence in self._heartbeats:
            yield Fault("M5", f"the server's heartbeat {heartbeat.sequence} is answered")

    def _judge_request(self, request: protocol.Request) -> Iterator[Fault]:
        if self.state in (State.NEW, State.HELLO, State.CLOSED):
            yield Fault("M0", f"a Request in {self.state.value}", "OUT_OF_STATE")
        elif self.welcome.role in (protocol.ROLE_CONTROLLER, protocol.ROLE_DIRECTOR):
            yield Fault("M8", "a Request of a controller or director", "FORBIDDEN")

    def _commanded(self, command: protocol.Command) -> set:
        positions = list(command.robots) or range(len(self.welcome.robots))
        return {(field, position) for field, count_of in PER_ROBOT.items() if getattr(command, field)
                for position in positions if count_of(self.welcome.robots[position])}

    def _greeted(self, hello: protocol.Hello) -> None:
        self.hello, self.state = hello, State.HELLO

    def _answered(self, command: protocol.Command) -> None:
        self._metrics |= {(metric.robot, metric.name) for metric in command.metrics}
        if command.tick != self.tick:
            self.missed.discard(command.tick)
            self._used |= self._commanded(command)  # lost (W6)
            return
        if not self.owes:  # late: the tick had been missed
            self.missed.discard(command.tick)
            self._used |= self._commanded(command)
            return
        self.owes = False
        self._used |= self._commanded(command)
        self._must_repeat = False

    def _directed(self, direction: protocol.Direction) -> None:
        self.missed.discard(direction.tick)
        if direction.tick == self.tick:
            self.owes = False

    def _left(self, leave: protocol.Leave) -> None:
        if self.state is State.HELLO or not leave.robots:
            self.state = State.CLOSED
        else:
            self.left |= set(leave.robots)

    # ---- the server --------------------------------------------------------------------------------

    def is_waited_for(self) -> bool:
        """No deadline holds, so that only a Command that is taken releases it from its tick."""
        policies = [robot.deadline_policy for robot in self.welcome.robots]
        return all(policy.action in _THAT_WAIT for policy in [self.welcome.deadline_policy, *policies])

    def told(self, message: protocol.ServerMessage) -> list:
        """Faults of a message of the server."""
        kind = message.WhichOneof("message")
        if kind is None:
            return []  # of a later version
        faults = []
        if self.is_certain and self.state in _RECEIVED and kind not in _RECEIVED[self.state] | _ANY_STATE:
            faults.append(Fault("M0", f"{kind} in {self.state.value}"))
        welcome = message.welcome if kind == "welcome" else self.welcome
        faults += version_faults(message, welcome)
        faults += _told.get(kind, lambda *_: ())(self, getattr(message, kind)) or ()
        return faults

    def _take_welcome(self, welcome: protocol.Welcome) -> list:
        faults = list(welcome_faults(self.hello, welcome)) if self.hello is not None else []
        self.welcome, self.state = welcome, State.READY
        self.tick, self.owes, self._is_new_world = None, False, True
        self.left, self.missed, self._used = set(welcome.resumed.gone_robots), set(), set()
        self._must_repeat = False
        self._world = self._due_tick = self._due_epoch = None
        return faults

    def _take_refusal(self, refusal: protocol.Refusal) -> list:
        self.state = State.NEW
        self.is_refused = not refusal.error.retryable
        faults = list(error_faults(refusal.error))
        if refusal.error.retryable != (refusal.error.code in _PASSING) and refusal.error.code != _Error.TOO_MANY:
            faults.append(Fault("H10", f"retryable is {refusal.error.retryable} (section 6)"))
        if refusal.error.severity != _Error.FATAL:
            faults.append(Fault("M0", "the severity of a Refusal is not FATAL (section 6)"))
        return faults

    def _take_loading(self, loading: protocol.Loading) -> Iterator[Fault]:
        if not 0 <= loading.progress <= 1:
            yield Fault("H12", f"the progress is {loading.progress}; 0 to 1 is expected")

    def _take_observation(self, told: protocol.Observation) -> list:
        faults = list(observation_faults(self.welcome, told)) if self.welcome is not None else []
        return [*faults, *self._begin_tick("S1", told)]

    def _take_world_layout(self, layout: protocol.WorldLayout) -> Iterator[Fault]:
        if layout.first == 0 or self._world is None:
            self._world = []
        if layout.first != len(self._world):
            yield Fault("R4", f"a WorldLayout begins at {layout.first}; {len(self._world)} entities were told before")
        if any(place >= len(self._world) for place in layout.removed):
            yield Fault("R4", f"the places {list(layout.removed)} are removed; {len(self._world)} are known")
        self._world.extend(layout.entities)

    def _take_world_state(self, told: protocol.WorldState) -> list:
        faults = []
        if self._world is None:
            faults.append(Fault("R4", "a WorldState without a WorldLayout before it"))
        elif self.hello is not None:
            groups = set(self.hello.subscription.groups)
            faults += world_state_faults(self._world, groups if self.hello.HasField("subscription") else None, told)
        return [*faults, *self._begin_tick("R5", told)]

    def _begin_tick(self, rule: str, told: Union[protocol.Observation, protocol.WorldState]) -> list:
        """Of an Observation or a WorldState; the rule says which tick may follow."""
        faults = []
        kind = told.DESCRIPTOR.name
        epoch = told.epoch if told.HasField("epoch") else None
        if not self._is_new_world and self.tick is not None and told.tick <= self.tick:
            faults.append(Fault(rule, f"{kind} {told.tick} follows {kind} {self.tick}"))
        if self._due_tick not in (None, told.tick) and self.is_waited_for():
            faults.append(Fault("L6", f"{kind} {told.tick} follows a Reset or Restored to tick {self._due_tick}"))
        if self._due_epoch not in (None, epoch):
            faults.append(Fault("S13", f"{kind} has the epoch {epoch}; {self._due_epoch} has begun"))
        if self.owes and self.tick is not None:
            self.missed.add(self.tick)
        self.tick, self.owes, self._is_new_world = told.tick, True, False
        self.epoch = self._due_epoch = epoch
        self._due_tick = None
        if self.state is not State.DRAINING:
            self.state = State.STEPPING
        return faults

    def _take_error(self, error: protocol.Error) -> list:
        faults = list(error_faults(error))
        if self.owes and self.is_certain and error.severity == _Error.DISCARD and error.tick != self.tick:
            faults.append(Fault("M0", f"an Error has tick {error.tick}; the world is at {self.tick} (section 6)"))
        if error.retryable:
            faults.append(Fault("M0", "an Error outside of a Refusal is retryable (section 6)"))
        if error.code == _Error.ROBOTS_DROPPED:
            faults += self._take_dropped(error)
        if error.code == _Error.NOT_YOURS and self.state is State.READY:  # not gone, but taken over (L4, H13)
            self.left -= {i for i, robot in enumerate(self.welcome.robots) if robot.id == error.robot}
        if self.state in (State.NEW, State.HELLO) and error.severity != _Error.FATAL:
            faults.append(Fault("M0", "an Error without a session is not FATAL (section 6)"))
        if error.code == _Error.DEADLINE_MISSED:
            self._must_repeat = True
            if error.severity != _Error.WARNING:
                faults.append(Fault("W5", "DEADLINE_MISSED is not a WARNING"))
            if self.owes and error.tick == self.tick:
                self.missed.add(error.tick)
                self.owes = False
        if error.severity == _Error.FATAL:
            self.state, self.is_lost = State.NEW, True
        return faults

    def _take_dropped(self, error: protocol.Error) -> Iterator[Fault]:
        positions = list(error.dropped.robots)
        count = len(self.welcome.robots) if self.welcome is not None else 0
        if error.severity != _Error.WARNING:
            yield Fault("W10", "ROBOTS_DROPPED is not a WARNING")
        if not positions or positions != sorted(set(positions)) or positions[-1] >= count:
            yield Fault("W10", f"the positions {positions} of {count} robots are dropped; ascending ones, each "
                        "once, are expected")
        if self.left & set(positions):
            yield Fault("W10", f"the positions {sorted(self.left & set(positions))} have left already")
        self.left |= set(positions)

    def _take_heartbeat(self, heartbeat: protocol.Heartbeat) -> None:
        self._heartbeats = [*self._heartbeats[-100:], heartbeat.sequence]

    def _take_response(self, response: protocol.Response) -> Iterator[Fault]:
        return self._requests.told(response)

    def _take_reset(self, reset: Union[protocol.Reset, protocol.Restored]) -> None:
        self._world = None
        self.owes, self._is_new_world = False, True
        self._due_tick = reset.tick if isinstance(reset, protocol.Restored) else 0
        self._due_epoch = reset.epoch if reset.HasField("epoch") else None
        self.missed.clear()
        self._used.clear()
        self._metrics.clear()

    def _take_restored(self, restored: protocol.Restored) -> Iterator[Fault]:
        self._take_reset(restored)
        if self.welcome is not None:
            yield from commanded_faults("L6", list(self.welcome.robots), restored.commanded)

    def _take_paused(self, paused: protocol.Paused) -> Iterator[Fault]:
        if paused.tick != self.tick:
            yield Fault("P1", f"Paused has tick {paused.tick}; the last Observation is of {self.tick}")
        self.state = State.PAUSED

    def _take_end(self, end: protocol.End) -> Iterator[Fault]:
        if end.reason not in (protocol.End.FINISHED, protocol.End.INTERRUPTED, protocol.End.FAILED):
            yield Fault("L5", f"the End has the reason {end.reason}")
        if self.owes:
            self.missed.add(self.tick)
        self.state = State.DRAINING

    def _take_displaced(self, _: protocol.Displaced) -> None:
        self.state, self.is_displaced = State.CLOSED, True


_said = {
    "hello": Session._judge_hello, "command": Session._judge_command, "leave": Session._judge_leave,
    "heartbeat": Session._judge_heartbeat, "request": Session._judge_request,
    "direction": Session._judge_direction,
}
_after_said = {"hello": Session._greeted, "command": Session._answered, "leave": Session._left,
               "direction": Session._directed}
_told = {
    "welcome": Session._take_welcome, "refusal": Session._take_refusal, "loading": Session._take_loading,
    "observation": Session._take_observation, "error": Session._take_error,
    "heartbeat": Session._take_heartbeat, "response": Session._take_response, "reset": Session._take_reset,
    "restored": Session._take_restored, "paused": Session._take_paused, "end": Session._take_end,
    "displaced": Session._take_displaced, "world_layout": Session._take_world_layout,
    "world_state": Session._take_world_state,
}
