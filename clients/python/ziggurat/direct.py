# SPDX-License-Identifier: MIT
"""Directors: programs with a rule for the whole world, in lock-step with it. See docs/python-client.md.

    with ziggurat.direct("judge") as world:
        for tick in world:
            if world.entities["b1"].position[2] > 0.3:
                world.finish("it stands")
"""

from __future__ import annotations

import os
from typing import Any, Dict, Iterable, List, NamedTuple, Optional, Sequence, Tuple, Union, cast

from . import protocol_pb2 as v1
from .curve import Curve
from .devices import Color, Quaternion, Vector
from .devices.device import quaternion, vector
from .devices.led import color_of
from .errors import ProtocolError
from .joining import Deadline, take_token
from .metrics import Metrics
from .session import Session
from .supervisor import place_request
from .ticks import Tick

_GROUPS = {name.lower(): number for name, number in v1.Subscription.Group.items() if number}
_FLOOR = -1


class LinkMotion(NamedTuple):
    """Of a link's frame in the world: its origin is the centre of the link's bottom."""

    position: Vector  # [m]
    orientation: Quaternion  # w, x, y, z
    velocity: Vector  # [m/s]
    angular_velocity: Vector  # [rad/s]


class JointMotion(NamedTuple):
    position: float  # [m] or [rad]
    velocity: float  # [m/s] or [rad/s]


class Contact(NamedTuple):
    """In the last substep of a tick. A link is the id of its entity and its own; None is the floor, and ("", "")
    one that this director is not told of."""

    link: Tuple[str, str]
    other: Optional[Tuple[str, str]]
    point: Vector  # [m]
    normal: Vector  # unit, from the other one to `link`
    force: Vector  # on `link` [N]


class ReceivedMessage(NamedTuple):
    receiver: Tuple[str, str]  # ids of the entity and of its radio
    sender: Tuple[str, str]
    payload: bytes


class Entity:
    """An entity at the present tick. Values of groups that were not asked for raise ValueError."""

    def __init__(self, world: "World", given: v1.EntityDescription, counts: Dict[str, int]):
        self._world = world
        self._given = given
        self._begin = dict(counts)
        self.id: str = given.id
        self.kind: str = given.kind  # the name of its element: box, prototype, foot-bot, …
        self.controller: str = given.controller  # id in the scene; "" if it is no robot
        counts["entities"] += 1
        for kind in ("links", "joints", "leds", "directional_leds", "tags", "magnets", "radios"):
            counts[kind] += len(getattr(given, kind))

    def _values(self, group: str, field: str, kind: str, count: int, width: int = 1) -> Sequence[Any]:
        self._world._check_group(group)
        if self._world.entities.get(self.id) is not self:
            raise ValueError(f"entity {self.id!r} is not in the world any more; look it up again")
        begin = self._begin[kind] * width
        return cast(Sequence[Any], getattr(self._world.state, field)[begin:begin + count * width])

    @property
    def position(self) -> Vector:
        """Of its origin in the world [m]."""
        return vector(self._values("poses", "poses", "entities", 1, 7)[:3])

    @property
    def orientation(self) -> Quaternion:
        return quaternion(self._values("poses", "poses", "entities", 1, 7)[3:])

    @property
    def links(self) -> Dict[str, LinkMotion]:
        """By id; a single body has one, ""."""
        ids = self._given.links
        v = self._values("links", "links", "links", len(ids), 13)
        return {link: LinkMotion(vector(v[i:i + 3]), quaternion(v[i + 3:i + 7]), vector(v[i + 7:i + 10]),
                                 vector(v[i + 10:i + 13]))
                for i, link in zip(range(0, len(v), 13), ids)}

    @property
    def joints(self) -> Dict[str, JointMotion]:
        """Prismatic and revolute ones, by id."""
        ids = self._given.joints
        v = self._values("joints", "joints", "joints", len(ids), 2)
        return {joint: JointMotion(v[2 * i], v[2 * i + 1]) for i, joint in enumerate(ids)}

    @property
    def led_colors(self) -> Tuple[Color, ...]:
        return tuple(map(color_of, self._values("leds", "led_colors", "leds", len(self._given.leds))))

    @property
    def directional_led_colors(self) -> Tuple[Color, ...]:
        return tuple(map(color_of, self._values("leds", "directional_led_colors", "directional_leds",
                                                len(self._given.directional_leds))))

    @property
    def tag_payloads(self) -> Tuple[bytes, ...]:
        return tuple(self._values("tags", "tag_payloads", "tags", len(self._given.tags)))

    @property
    def magnets(self) -> Dict[str, Vector]:
        """Fields in the frames of their anchors, in the scene's unit, by id."""
        ids = [each.id for each in self._given.magnets]
        v = self._values("magnets", "magnets", "magnets", len(ids), 3)
        return {magnet: vector(v[3 * i:3 * i + 3]) for i, magnet in enumerate(ids)}

    # What is asked for is done before the next tick, in the order of asking.

    def move(self, position: Sequence[float], orientation: Sequence[float] = (), *,
             may_overlap: bool = False) -> None:
        """It is at rest there [m], joints as assembled. orientation w, x, y, z; none: as it is. Where others are then it
        is left out (`left_out`), unless it may overlap them: they are pushed apart."""
        self._world.move(self.id, position, orientation, may_overlap=may_overlap)

    def set_joint(self, joint: str, position: float, velocity: float = 0.0) -> None:
        """A revolute or prismatic joint is put to a position [m, rad] from the assembled pose, within its limits, and a
        velocity [m/s, rad/s]. What hangs on it follows; other joints and the root stay."""
        self._world.set_joint(self.id, joint, position, velocity)

    def is_free(self, position: Sequence[float], orientation: Sequence[float] = ()) -> bool:
        """Whether it would overlap nothing there."""
        return self._world.is_free(self.id, position, orientation)

    def remove(self) -> None:
        self._world.remove(self.id)

    def push(self, force: Sequence[float] = (), torque: Sequence[float] = (), link: str = "") -> None:
        """During the next tick: a force at the link's centre of mass [N], a torque [N m], in the world's axes.
        link  its id; none: the entity's first one"""
        self._world._act(push=v1.Push(entity=self.id, link=link, force=force, torque=torque))

    def show(self, *, led_colors: Iterable[Any] = (), directional_led_colors: Iterable[Any] = (),
             tag_payloads: Iterable[bytes] = ()) -> None:
        """Each list is empty or has a value for each device. Colours are 0xRRGGBB, or red, green and blue. The
        server refuses devices that a controller sets."""
        self._world._act(show=v1.Show(
            entity=self.id, led_colors=map(_packed, led_colors),
            directional_led_colors=map(_packed, directional_led_colors), tag_payloads=tag_payloads))


def _packed(color: Any) -> int:
    if isinstance(color, int):
        return color
    red, green, blue = map(int, color)
    return red << 16 | green << 8 | blue


class Entities(Dict[str, Entity]):
    """Those that are in the world, by id."""

    def __missing__(self, id: str) -> Entity:
        raise KeyError(f"this director is told of no entity {id!r} that is in the world")


def direct(director: str = "", endpoint: str = "", *, entities: Union[str, Sequence[str]] = (),
           tell: Union[str, Sequence[str]] = ("poses",), name: str = "", version: str = "",
           deadline: Optional[Deadline] = None, takeover: bool = False, can_restore: bool = False,
           curve: Optional[Curve] = None, connect_timeout: float = 10.0,
           wait_timeout: Optional[float] = None, resume_timeout: Optional[float] = None) -> "World":
    """Directs the world as this <director> of the scene, or, if the server allows it, as one from outside.
    Without id it is that in ZIGGURAT_DIRECTOR, where `ziggurat run` writes it.

    entities  that it is told of: ids, or globs with * ? [a-z]; none: all
    tell      of each of them: "poses", "links", "joints", "leds", "tags", "magnets", "radio_messages", "contacts"

    The other options are those of connect().
    """
    groups = [tell] if isinstance(tell, str) else list(tell)
    for group in groups:
        if group not in _GROUPS:
            raise ValueError(f"tell={group!r}: write some of {', '.join(_GROUPS)}")
    curve = curve or Curve.from_environment()
    token = take_token(endpoint)
    id = director or os.environ.get("ZIGGURAT_DIRECTOR", "")
    wanted = [entities] if isinstance(entities, str) else list(entities)
    hello = v1.Hello(role=v1.ROLE_DIRECTOR, director=id, client_name=name or id or "python",
                     client_version=version, takeover=takeover, session_token=token,
                     can_restore=can_restore,
                     subscription=v1.Subscription(entities=wanted,
                                                  groups=[_GROUPS[group] for group in groups]))
    if deadline is not None:
        hello.deadline_policy.CopyFrom(deadline._message())
    return World(endpoint, hello, curve, connect_timeout, wait_timeout, resume_timeout)


class World(Session):
    """An iterator over ticks, as Session. What is asked for in one is done before the next."""

    def __init__(self, endpoint: str, hello: v1.Hello, *options: Any):
        self.state = v1.WorldState()  # of the present tick: packed arrays in the order of `order`
        self.order: List[Entity] = []  # all that were told of, also those that are gone
        self.entities: Entities = Entities()
        self.left_out: List[ProtocolError] = []  # acts of the last tick that could not be done any more
        self._counts: Dict[str, int] = {}
        self._groups = set(hello.subscription.groups)
        self._direction = v1.Direction()
        self._figures = Metrics()
        super().__init__(endpoint, hello, *options)

    @property
    def id(self) -> str:
        return str(self.welcome.director.id)

    @property
    def params(self) -> Dict[str, str]:
        """The attributes of <params> in the scene."""
        return {each.name: each.value for each in self.welcome.director.params}

    @property
    def contacts(self) -> List[Contact]:
        self._check_group("contacts")
        names = [(entity.id, link) for entity in self.order for link in entity._given.links]
        links, v = self.state.contact_links, self.state.contacts

        def name_of(place: int) -> Optional[Tuple[str, str]]:
            return names[place] if place >= 0 else None if place == _FLOOR else ("", "")
        return [Contact(names[links[2 * i]], name_of(links[2 * i + 1]), vector(v[9 * i:9 * i + 3]),
                        vector(v[9 * i + 3:9 * i + 6]), vector(v[9 * i + 6:9 * i + 9]))
                for i in range(len(links) // 2)]

    @property
    def radio_messages(self) -> List[ReceivedMessage]:
        """Received at this tick."""
        self._check_group("radio_messages")
        names = [(entity.id, radio.id) for entity in self.order for radio in entity._given.radios]
        return [ReceivedMessage(names[each.radio], names[each.sender] if each.sender >= 0 else ("", ""),
                                each.payload) for each in self.state.radio_messages]

    def spawn(self, xml: str) -> None:
        """Adds an element, written as in <arena>: it is in `entities` at the next tick."""
        self._act(spawn=v1.SpawnRequest(xml=xml))

    def move(self, entity: str, position: Sequence[float], orientation: Sequence[float] = (), *,
             may_overlap: bool = False) -> None:
        self._act(move=v1.MoveRequest(entity=entity, position=position, orientation=orientation,
                                      may_overlap=may_overlap))

    def set_joint(self, entity: str, joint: str, position: float, velocity: float = 0.0) -> None:
        self._act(set_joint=v1.SetJointRequest(entity=entity, joint=joint, position=position, velocity=velocity))

    def overlapped(self, what: str, position: Sequence[float],
                   orientation: Sequence[float] = ()) -> Optional[str]:
        """What an entity, or an element as in <arena>, would overlap there now: the first entity's id; None: the place
        is free. Asks the server and waits for its answer; what was asked for in this tick is not done yet. The floor
        does not count, nor does the entity itself.
        what  an id, or an element: of a single body its extents are enough, as in <box size="1,1,1"/>"""
        return self._ask(is_free=place_request(what, position, orientation)).place.overlapped or None

    def is_free(self, what: str, position: Sequence[float], orientation: Sequence[float] = ()) -> bool:
        """Whether that is nothing."""
        return self.overlapped(what, position, orientation) is None

    def remove(self, entity: str) -> None:
        self._act(remove=v1.RemoveRequest(entity=entity))

    def paint_floor(self, center: Sequence[float], size: Union[float, Sequence[float]], color: Any) -> None:
        """A region of the floor gets a colour (0xRRGGBB, or red, green and blue), which stays; ground sensors read it
        from the next tick on.
        center  x, y [m]
        size    along x and y [m]: a rectangle; one number: the radius of a disc [m]"""
        sides = [size] if isinstance(size, (int, float)) else size
        self._act(paint_floor=v1.PaintFloor(center=center, size=sides, color=_packed(color)))

    def lay_floor_image(self, file: Union[str, "os.PathLike[str]"]) -> None:
        """An image covers the floor of the arena, in place of the scene's image and of what was painted: its right is +x,
        its top +y.
        file  a PNG file, or a PPM or PGM file of bytes, with at most 2 MiB"""
        with open(file, "rb") as opened:
            self._act(paint_floor=v1.PaintFloor(image=opened.read()))

    def metric(self, name: str, value: float) -> None:
        """A figure of the run: `ID/name` in its summary, ID being this director's."""
        self._figures.set(0, name, value)

    def log(self, text: str, error: bool = False) -> None:
        for line in str(text).splitlines():
            self._direction.log.add(text=line, error=error)

    def finish(self, result: str = "") -> None:
        """The run ends with this tick, as planned; what else was asked for in it is not done."""
        self._direction.finish.result = str(result)
        self._direction.finish.SetInParent()

    def _act(self, **act: Any) -> None:
        self._direction.acts.add(**act)

    def _check_group(self, group: str) -> None:
        if _GROUPS[group] not in self._groups:
            raise ValueError(f"this director did not ask for {group!r}; add it to tell=… of direct()")

    def _lay_out(self, layout: v1.WorldLayout) -> None:
        if layout.first == 0:
            self.order, self.entities = [], Entities()
            self._counts = dict.fromkeys(("entities", "links", "joints", "leds", "directional_leds", "tags",
                                          "magnets", "radios"), 0)
        for place in layout.removed:
            self.entities.pop(self.order[place].id, None)
        for given in layout.entities:
            self.order.append(Entity(self, given, self._counts))
            self.entities[given.id] = self.order[-1]

    def _take(self, kind: Optional[str], message: v1.ServerMessage) -> None:
        if kind == "world_layout":
            self._lay_out(message.world_layout)
        else:
            super()._take(kind, message)

    def _fault(self, error: v1.Error) -> None:
        if error.severity == v1.Error.WARNING and error.field.startswith("acts["):
            self.left_out.append(ProtocolError(error))
        else:
            super()._fault(error)

    def _begin_anew(self) -> None:
        super()._begin_anew()
        self._direction.Clear()

    def _observe(self, state: v1.WorldState) -> Tick:
        self.state = state
        return super()._observe(state)

    def __next__(self) -> Tick:
        self.left_out = []
        return super().__next__()

    def _answer(self) -> None:
        direction = self._direction
        assert self._owes is not None  # __next__() asks
        direction.tick = self._owes
        if self._epoch is not None:
            direction.epoch = self._epoch
        direction.metrics.extend(self._figures.take())
        message = v1.ClientMessage(direction=direction).SerializeToString()
        if 0 < self.welcome.max_message_bytes < len(message):
            raise ValueError(f"what was asked for has {len(message)} bytes; the server accepts at most "
                             f"{self.welcome.max_message_bytes}")
        self._connection.send_bytes(message)
        self._answered = message
        self._direction = v1.Direction()
        self._owes = None

    def close(self, failure: str = "") -> None:
        """Leaves the run, as failed if there is a message: it goes on without this director."""
        if self._connection.closed:
            return
        if self._direction.HasField("finish") and self._owes is not None and not failure:
            self._answer()
        reason = v1.Leave.FAILED if failure else v1.Leave.DONE
        self._connection.send(v1.ClientMessage(leave=v1.Leave(
            reason=reason, message=failure, log=self._direction.log, metrics=self._figures.take())),
            is_last=True)
        self._end()
