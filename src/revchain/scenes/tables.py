# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of a scene file: their keys, the types, and the texts that editors show."""

from functools import cache, partial
from typing import Annotated, Any, Literal, get_args

from msgspec import UNSET, Meta, Struct, UnsetType
from msgspec.structs import fields

from ..systems.numbers import STANDARD_GRAVITY
from ..systems.units import PATTERN


def says(text: str) -> Meta:
    """Metadata of a key: the text that editors show for it."""
    return Meta(description=text)


MOST_LINKS = 10_000_000
BESIDE = ("schema_version", "title", "description", "gravity", "order", "support", "speed", "fluid", "held", "ask")
SYSTEMS = ("links", "uniform_chain", "tapered_chain", "cord", "governor")  # a scene has exactly one of these tables

WithUnit = Annotated[str, Meta(pattern=PATTERN, description='A number and its unit, such as "39.1396 inch".')]
NotNegativeNumber = Annotated[float, Meta(ge=0)]
AnySign = float | WithUnit
Positive = Annotated[float, Meta(gt=0)] | WithUnit
NotNegative = NotNegativeNumber | WithUnit
MaybeAnySign = AnySign | UnsetType
MaybePositive = Positive | UnsetType
MaybeNotNegative = NotNegative | UnsetType
Count = Annotated[int, Meta(ge=1, le=MOST_LINKS)]


fields_of = cache(fields)  # `fields` takes a millisecond in each call


class Table(Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True, repr_omit_defaults=True, kw_only=True):
    """The base of the tables of a scene: numbers in SI units or with a unit."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle only the given values: msgspec recognizes defaults, which `to_dict` leaves out, by identity."""
        given = {}
        for field in fields_of(type(self)):
            if (value := getattr(self, field.name)) is not field.default:
                given[field.name] = value
        return partial(type(self), **given), ()


class Flywheel(Table, frozen=True):
    """A wheel that spins about its link's axis. The link's data include the wheel's mass and inertia across the axis."""

    radius_of_gyration: Annotated[NotNegative, says("Radius of gyration about the axis of the wheel (m).")]
    spin: Annotated[AnySign, says("Spin (rad/s); positive in the direction of a positive whirl speed.")]
    weight: Annotated[MaybeNotNegative, says("Weight of the wheel (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Mass of the wheel (kg); or give weight.")] = UNSET
    driven: Annotated[
        bool, says("Whether a motor keeps the spin relative to the link; else the wheel runs freely.")
    ] = False


class Displaced(Table, frozen=True):
    """The fluid that a link displaces."""

    weight: Annotated[MaybeNotNegative, says("Weight of the displaced fluid (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Mass of the displaced fluid (kg); or give weight.")] = UNSET
    centroid: Annotated[
        MaybeAnySign, says("Distance of the centre of gravity of the fluid below the upper pin (m); the link's if left out.")
    ] = UNSET
    radius_of_gyration: Annotated[
        MaybeNotNegative, says("Radius of gyration of the fluid about its centre of gravity (m); the link's if left out.")
    ] = UNSET
    added_weight: Annotated[MaybeNotNegative, says("Weight of still fluid that moves with the link (N).")] = UNSET
    added_mass: Annotated[MaybeNotNegative, says("Mass of still fluid that moves with the link (kg).")] = UNSET


class Pin(Table, frozen=True):
    """The spring and the dashpot between a link and the one above, at the uppermost pin between link and vertical."""

    stiffness: Annotated[MaybeNotNegative, says("Torque over the angle (N m/rad); relaxed in the straight chain.")] = UNSET
    damping: Annotated[MaybeNotNegative, says("Torque over the rate of the angle (N m s/rad).")] = UNSET


class AirDrag(Table, frozen=True):
    """Drag of air on a link, for [ask.drag]: on a cylinder, on a body at its centre of gravity, or on both."""

    coefficient: Annotated[NotNegative, says("Drag coefficient: 1.0 to 1.2 for a cylinder, 0.5 for a sphere.")]
    diameter: Annotated[MaybeNotNegative, says("Diameter of the link as a cylinder (m).")] = UNSET
    area: Annotated[MaybeNotNegative, says("Frontal area of a body at its centre of gravity (m^2).")] = UNSET
    body_coefficient: Annotated[
        MaybeNotNegative, says("Drag coefficient of that body; coefficient if left out.")
    ] = UNSET


class Support(Table, frozen=True):
    """The support of the uppermost pin."""

    stiffness: Annotated[
        MaybeNotNegative,
        says("Sideways stiffness of the spring (N/m). Left out: firm, or with a mass a trolley that rolls freely."),
    ] = UNSET
    damping: Annotated[MaybeNotNegative, says("Damping of a dashpot to the ground (N s/m).")] = UNSET
    weight: Annotated[MaybeNotNegative, says("Weight that moves sideways with the pin (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Mass that moves sideways with the pin (kg); or give weight.")] = UNSET
    radius: Annotated[
        MaybeNotNegative, says("Radius of the circle in which the pin is carried round (m); 0 if left out.")
    ] = UNSET


class Link(Table, frozen=True):
    """One link, or several equal ones. A link of mass 0 is a massless thread.

    A link with `clamped` is part of the link above: give `standing`, `flywheel`, `displaced`,
    `pin`, `drag` and `air_drag` there.
    """

    length: Annotated[Positive, says("Distance between its pins (m).")]
    name: Annotated[str, says("Name in paths, reports and pictures.")] = ""
    weight: Annotated[MaybeNotNegative, says("Weight (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Mass (kg); or give weight.")] = UNSET
    kind: Annotated[
        Literal["plummet", "rod"] | UnsetType,
        says("plummet (default): all weight at the lower pin; rod: uniform between its pins."),
    ] = UNSET
    centroid: Annotated[
        MaybeAnySign, says("Distance of the centre of gravity below the upper pin (m); negative above it.")
    ] = UNSET
    pendulum_length: Annotated[
        MaybeAnySign, says("Length of the equivalent simple pendulum about the upper pin (m).")
    ] = UNSET
    radius_of_gyration: Annotated[
        MaybeNotNegative, says("Radius of gyration about the centre of gravity (m); or give pendulum_length.")
    ] = UNSET
    repeat: Annotated[Count, says("Number of equal links in a row.")] = 1
    standing: Annotated[bool, says("Whether it stands on its upper pin in the straight chain (inverted).")] = False
    tip_weight: Annotated[MaybeNotNegative, says("Weight of a point mass fixed to its lower pin (N).")] = UNSET
    tip_mass: Annotated[MaybeNotNegative, says("Point mass fixed to its lower pin (kg).")] = UNSET
    clamped: Annotated[bool, says("Whether it is locked in line with the link above as one rigid body.")] = False
    flywheel: Annotated[Flywheel | UnsetType, says("A wheel that spins about the axis of the link.")] = UNSET
    displaced: Annotated[Displaced | UnsetType, says("The fluid that it displaces.")] = UNSET
    pin: Annotated[Pin | UnsetType, says("Spring and dashpot at its upper pin.")] = UNSET
    drag: Annotated[
        MaybeNotNegative, says("Linear drag of the whole link in small motion, over its speed (N s/m).")
    ] = UNSET
    air_drag: Annotated[AirDrag | UnsetType, says("Quadratic drag of air, for [ask.drag].")] = UNSET


class Whole(Table, frozen=True):
    """The base of chains and cords that are given as a whole."""

    length: Annotated[Positive, says("Length of the whole (m).")]
    weight: Annotated[MaybePositive, says("Weight of the whole (N); or give mass.")] = UNSET
    mass: Annotated[MaybePositive, says("Mass of the whole (kg); or give weight.")] = UNSET
    tip_weight: Annotated[MaybeNotNegative, says("Weight of a point mass fixed to its free end (N).")] = UNSET
    tip_mass: Annotated[MaybeNotNegative, says("Point mass fixed to its free end (kg).")] = UNSET


class UniformChain(Whole, frozen=True, kw_only=True):
    """A chain of equal links."""

    air_drag: Annotated[AirDrag | UnsetType, says("Quadratic drag of air on each link, for [ask.drag].")] = UNSET

    kind: Annotated[Literal["plummets", "rods"], says("Kind of the links.")]
    count: Annotated[Count, says("Number of links.")]


class TaperedChain(Whole, frozen=True, kw_only=True):
    """A cord whose line density is a power of the distance from its free end, cut into straight equal lengths."""

    air_drag: Annotated[AirDrag | UnsetType, says("Quadratic drag of air on each link, for [ask.drag].")] = UNSET
    count: Annotated[Count, says("Number of links.")]
    exponent: Annotated[float, Meta(gt=-1, le=1000, description="Exponent of the power; 0 gives equal rods.")]


class PointMass(Table, frozen=True, kw_only=True):
    """A point mass on a cord, such as a clasp."""

    arc_length: Annotated[Positive, says("Its distance from the free end along the cord (m).")]
    weight: Annotated[MaybeNotNegative, says("Weight (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Mass (kg); or give weight.")] = UNSET


class Cord(Whole, frozen=True, kw_only=True):
    """A flexible cord: the limit of many short links."""

    tip_centroid: Annotated[
        MaybeNotNegative, says("Distance of the centre of gravity of a bob that turns at the end below that end (m).")
    ] = UNSET
    tip_radius_of_gyration: Annotated[
        MaybeNotNegative, says("Radius of gyration of the bob about its centre of gravity (m).")
    ] = UNSET
    masses: Annotated[
        list[PointMass] | UnsetType, says("Point masses on the cord, beside its own mass.")
    ] = UNSET

    density: Annotated[
        float,
        Meta(gt=-1, le=1000, description="Exponent of the distance from the free end in the line density; 0: uniform."),
    ] = 0.0


class End(Support, frozen=True):
    """The support of an end; with a negative radius on the other side of the axis."""

    radius: Annotated[
        MaybeAnySign, says("Signed radius of the circle in which the end is carried round (m); 0 if left out.")
    ] = UNSET


class Held(Table, frozen=True):
    """A chain or cord held at both ends, with a span or under a tension."""

    span: Annotated[MaybePositive, says("Distance between the ends along the axis (m), less than the length.")] = UNSET
    tension: Annotated[MaybePositive, says("Tension at the upper end (N), instead of span.")] = UNSET
    weightless: Annotated[bool, says("Whether gravity is left out.")] = False
    lower: Annotated[End | UnsetType, says("Support of the lower end; a firm point on the axis if left out.")] = UNSET
    upper: Annotated[End | UnsetType, says("Support of the upper end; a firm point on the axis if left out.")] = UNSET


class Governor(Table, frozen=True):
    """A governor of Watt, Porter or Hartnell: balls on a turning shaft lift a sleeve (`revchain.SleeveGovernor`)."""

    ball_mass: Annotated[Positive, says("Mass of each ball (kg).")]
    arm: Annotated[Positive, says("Distance from the pivot of an arm to its ball (m).")]
    balls: Annotated[int, Meta(ge=1, le=1000, description="Number of balls.")] = 2
    pivot_offset: Annotated[
        MaybeAnySign, says("Distance of the pivots from the axis (m); negative if the arms cross; 0 if left out.")
    ] = UNSET
    lower_arm: Annotated[MaybeNotNegative, says("Length of the links that carry the sleeve (m).")] = UNSET
    joint: Annotated[
        MaybeNotNegative, says("Distance from the pivot to the joint of the lower link (m); at the ball if left out.")
    ] = UNSET
    sleeve_offset: Annotated[MaybeAnySign, says("Distance of the lower links' pivots from the axis (m).")] = UNSET
    sleeve_arm: Annotated[
        MaybeNotNegative, says("Hartnell: sleeve arm of the levers, at right angles to the ball's (m), instead of lower_arm.")
    ] = UNSET
    sleeve_mass: Annotated[MaybeNotNegative, says("Mass of the sleeve (kg).")] = UNSET
    spring_stiffness: Annotated[
        MaybeNotNegative, says("Stiffness of a spring that presses the sleeve down (N/m).")
    ] = UNSET
    spring_force: Annotated[MaybeAnySign, says("Force of that spring at inclination 0 (N).")] = UNSET
    friction: Annotated[MaybeNotNegative, says("Force with which the sleeve resists, either way (N).")] = UNSET
    shaft_inertia: Annotated[
        MaybeNotNegative, says("Moment of inertia of a shaft that turns freely (kg m^2); if left out, its speed is held.")
    ] = UNSET
    lowest_inclination: Annotated[MaybeAnySign, says("Inclination of the arms at the lower stop (rad).")] = UNSET
    highest_inclination: Annotated[MaybeAnySign, says("Inclination of the arms at the upper stop (rad).")] = UNSET


SYSTEM_TABLES = (Link, UniformChain, TaperedChain, Cord, Held, Governor, Support)
DEFAULT_MODES = 10

Pair = tuple[NotNegative, NotNegative]


class Spread(Table, frozen=True, rename={"first": "from", "last": "to"}):
    """Numbers from a first to a last one, both included; with one step only the first."""

    last: Annotated[AnySign, says("Last number.")]
    first: Annotated[AnySign, says("First number.")] = 0.0
    steps: Annotated[Count, says("Number of values.")] = 200
    log: Annotated[bool, says("Whether the numbers have equal ratios instead of equal differences.")] = False


Listed = list[AnySign]
# Its text has no pattern: msgspec 0.22 crashes for text with a pattern beside a list.
OneOrMore = float | str | Listed | Spread


class AskModes(Table, frozen=True):
    """The modes: whirl speeds, shapes, nodes (`revchain.modes`). Give `count` and `first`, or one window."""

    count: Annotated[
        Count | Literal["all"] | UnsetType,
        says('Number of modes, slowest first, or "all"; 10 if left out.'),
    ] = UNSET
    first: Annotated[Count | UnsetType, says("Number of the first mode; the slowest mode is 1.")] = UNSET
    angular_speed: Annotated[Pair | UnsetType, says("Window [low, high]: low <= whirl speed < high (rad/s).")] = UNSET
    conical_height: Annotated[Pair | UnsetType, says("Window [low, high]: low < conical height <= high (m).")] = UNSET
    rtol: Annotated[MaybeNotNegative, says('Relative tolerance of the heights, such as "1 %".')] = UNSET
    certify: Annotated[bool, says("Whether to prove each height with an interval and its counts.")] = False
    precision: Annotated[
        Literal["double", "extended", "double-double"], says("Arithmetic of the results.")
    ] = "double"
    method: Annotated[str | UnsetType, says("Method, one of those that explain lists; the cheapest if left out.")] = UNSET


class AskShapes(Table, frozen=True):
    """Steady shapes (relative equilibria) at one speed, at any inclination (`revchain.steady_shapes`)."""

    angular_speed: Annotated[MaybePositive, says("Speed (rad/s); or give conical_height.")] = UNSET
    conical_height: Annotated[MaybePositive, says("Conical height g / n^2 (m); or give angular_speed.")] = UNSET
    hanging_only: Annotated[
        bool, says("Leave out shapes with links above their pins (of a rig: inverted otherwise than in the scene).")
    ] = True
    direction: Annotated[Literal[1, -1], says("Direction of rotation; only flywheels depend on it.")] = 1
    max_half_waves: Annotated[
        Count | UnsetType, says("Largest number of half waves between two held ends; 1 if left out.")
    ] = UNSET


class AskResponse(Table, frozen=True):
    """Small forced motion of a chain whose support moves in a circle or to and fro (`revchain.response`)."""

    angular_speed: Annotated[
        OneOrMore | UnsetType,
        says("A speed (rad/s), a list of speeds, or {from, to, steps, log}; negative only with flywheels."),
    ] = UNSET
    conical_height: Annotated[
        OneOrMore | UnsetType, says("Conical heights g / n^2 (m), instead of angular_speed.")
    ] = UNSET
    support_radius: Annotated[
        MaybePositive, says("Radius of the circle (m); if left out that of [support], or 1 if it has none.")
    ] = UNSET
    acceleration: Annotated[MaybePositive, says("Amplitude of the support's acceleration (m/s^2), instead of a radius.")] = UNSET
    force: Annotated[MaybePositive, says("Amplitude of a force on a support that yields (N), instead of a radius.")] = UNSET


class AskSwing(Table, frozen=True):
    """Small oscillations of a chain or rig after release, or while its support is moved (`revchain.swing`)."""

    offset: Annotated[
        Listed | UnsetType,
        says("Offset of each pin at the start (m), in the order of the links, without the support unless it yields."),
    ] = UNSET
    velocity: Annotated[
        Listed | UnsetType, says("Velocity of each pin at the start (m/s), in the same order; at rest if left out.")
    ] = UNSET
    time: Annotated[OneOrMore, says("A time (s), a list of times, or {from, to, steps}.")] = Spread(
        last=10.0, steps=201
    )
    count: Annotated[Count | UnsetType, says("Number of modes used, slowest first; all if left out.")] = UNSET
    support_time: Annotated[
        Listed | UnsetType, says("Times (s) at which the support has the next velocities, accelerations, offsets or forces.")
    ] = UNSET
    support_velocity: Annotated[Listed | UnsetType, says("Its velocities then (m/s), joined by straight lines.")] = UNSET
    support_acceleration: Annotated[
        Listed | UnsetType, says("Its accelerations then (m/s^2), joined by straight lines.")
    ] = UNSET
    support_offset: Annotated[Listed | UnsetType, says("Its offsets then (m), joined by a spline.")] = UNSET
    support_force: Annotated[Listed | UnsetType, says("Forces on it then (N), joined by straight lines.")] = UNSET


class AskBranches(Table, frozen=True):
    """The bifurcation diagram: the branches of steady shapes up to a speed (`revchain.branches`)."""

    max_angular_speed: Annotated[MaybePositive, says("Largest speed (rad/s); or give min_conical_height.")] = UNSET
    min_conical_height: Annotated[
        MaybePositive, says("Smallest conical height (m); or give max_angular_speed.")
    ] = UNSET
    direction: Annotated[Literal[1, -1], says("Direction of rotation; only flywheels depend on it.")] = 1
    hanging_only: Annotated[
        bool, says("Leave out branches with links above their pins (of a rig: inverted otherwise than in the scene).")
    ] = True
    stability: Annotated[
        bool, says("Whether to list the windows of stability, and write the verdict at each point to JSON and CSV."),
    ] = False


class AskCampbell(Table, frozen=True):
    """Frequencies of small motion about a steady shape against the speed (`revchain.campbell`)."""

    angular_speed: Annotated[
        OneOrMore | UnsetType, says("Ascending speeds (rad/s): {from, to, steps, log}, or a list of speeds.")
    ] = UNSET
    orders: Annotated[
        list[Annotated[int, Meta(ge=1)]] | UnsetType,
        says("Multiples of the speed whose crossings are listed; 1 and 2 if left out."),
    ] = UNSET
    half_waves: Annotated[Count, says("Number of half waves of the shape.")] = 1
    frame: Annotated[
        Literal["free", "driven"], says("free: in and out of the plane, with ball joints; driven: in a plane that turns.")
    ] = "free"


class AskDrag(Table, frozen=True):
    """The steady shape of a chain that is carried round through still air (`revchain.drag_shape`)."""

    angular_speed: Annotated[AnySign | UnsetType, says("Turning speed (rad/s).")] = UNSET
    half_waves: Annotated[
        Count | UnsetType, says("Half waves of the shape without drag to start from; left out: from rest.")
    ] = UNSET
    air_density: Annotated[MaybePositive, says("Density of the air (kg/m^3); 1.225 if left out.")] = UNSET


class AskEquilibria(Table, frozen=True):
    """Equilibria of a governor: at one speed, or those between its stops (`revchain.SleeveGovernor.equilibria`)."""

    angular_speed: Annotated[
        MaybeNotNegative, says("Speed of the shaft (rad/s); if left out, the speed at each inclination between the stops.")
    ] = UNSET


class AskExplain(Table, frozen=True):
    """The method that finds the modes for a tolerance, and the cost of the others (`revchain.explain`)."""

    count: Annotated[Count | Literal["all"] | UnsetType, says("Number of modes, slowest first.")] = UNSET
    first: Annotated[Count | UnsetType, says("Number of the first mode; the slowest mode is 1.")] = UNSET
    rtol: Annotated[MaybeNotNegative, says('Relative tolerance of the heights, such as "1 %".')] = UNSET


class Ask(Table, frozen=True):
    """Questions to answer; if there are none the modes, of a governor the equilibria."""

    modes: Annotated[AskModes | UnsetType, says("Whirl speeds and mode shapes.")] = UNSET
    shapes: Annotated[AskShapes | UnsetType, says("Steady shapes at any inclination.")] = UNSET
    response: Annotated[AskResponse | UnsetType, says("Forced motion by a moving support.")] = UNSET
    swing: Annotated[AskSwing | UnsetType, says("Motion after release, or under a moving support.")] = UNSET
    branches: Annotated[AskBranches | UnsetType, says("Branches of steady shapes.")] = UNSET
    campbell: Annotated[AskCampbell | UnsetType, says("Frequencies of small motion against the speed.")] = UNSET
    drag: Annotated[AskDrag | UnsetType, says("The steady shape of a carried chain in air.")] = UNSET
    equilibria: Annotated[AskEquilibria | UnsetType, says("Equilibria of a governor.")] = UNSET


QUESTIONS: dict[str, type[Table]] = {
    "modes": AskModes,
    "shapes": AskShapes,
    "response": AskResponse,
    "swing": AskSwing,
    "branches": AskBranches,
    "campbell": AskCampbell,
    "drag": AskDrag,
    "equilibria": AskEquilibria,
}
TABLES: dict[str, type[Table]] = {**QUESTIONS, "explain": AskExplain}


_SIGNS: dict[Any, str] = {AnySign: "any", Listed: "any", OneOrMore: "any", Positive: "positive"}
_SIGNS |= {NotNegative: "not negative", Pair: "not negative"}
_SIGNS |= {kind | UnsetType: sign for kind, sign in _SIGNS.items()} | {OneOrMore | UnsetType: "positive"}  # of a speed


@cache
def number_fields(kind: type[Struct]) -> list[tuple[str, str, bool]]:
    """Name of each key whose number or numbers may have a unit; the sign; and whether the key is required."""
    types = [(field, get_args(field.type)[0]) for field in fields_of(kind)]
    return [(field.name, _SIGNS[of], field.required) for field, of in types if of in _SIGNS]


Links = list[tuple[int, Link]]  # lowest first, each with its number in the file


class Tables(Table, frozen=True):
    """The keys of a scene file."""

    schema_version: Annotated[Literal[2], says("Version of this format.")] = 2
    title: Annotated[str, says("Title in one line.")] = ""
    description: Annotated[str, says("Description of any length.")] = ""
    gravity: Annotated[Positive, says("Acceleration of gravity (m/s^2).")] = STANDARD_GRAVITY
    order: Annotated[
        Literal["free end first", "support first"],
        says("Order of the links, and of the indices and lists of the scene."),
    ] = "free end first"
    links: Annotated[list[Link] | UnsetType, says("The links, in the given order.")] = UNSET
    uniform_chain: Annotated[UniformChain | UnsetType, says("Equal links, instead of links.")] = UNSET
    tapered_chain: Annotated[
        TaperedChain | UnsetType, says("Links cut from a tapering cord, instead of links.")
    ] = UNSET
    cord: Annotated[Cord | UnsetType, says("A flexible cord, instead of links.")] = UNSET
    governor: Annotated[Governor | UnsetType, says("A centrifugal governor, instead of links.")] = UNSET
    support: Annotated[Support | UnsetType, says("Support of the chain; a firm point on the axis if left out.")] = UNSET
    speed: Annotated[
        Literal["rad/s", "rpm", "Hz", "s"] | UnsetType,
        says('Unit of speeds in printed tables and pictures ("s": periods); that of the question if left out.'),
    ] = UNSET
    fluid: Annotated[Literal["still", "turning"], says("Motion of the fluid: at rest, or turning with the chain.")] = "still"
    held: Annotated[Held | UnsetType, says("Span or tension of a chain or cord held at both ends.")] = UNSET
    ask: Annotated[Ask, says("Questions to answer.")] = Ask()

    def _links(self) -> Links:
        """The tables of the links, lowest first, with their numbers in the file."""
        links = [] if isinstance(self.links, UnsetType) else list(enumerate(self.links))
        return links[::-1] if self.order == "support first" else links

    def _bodies(self) -> Links:
        """The tables that are links of the system; a clamped one is part of the link above."""
        return [(index, link) for index, link in self._links() if not link.clamped]

    @property
    def is_rigged(self) -> bool:
        """Whether the scene has more than a chain that hangs from a firm point on the axis."""
        links = [] if isinstance(self.links, UnsetType) else self.links
        fitted = any(part is not UNSET for link in links for part in (link.flywheel, link.displaced, link.pin, link.drag))
        return self.support is not UNSET or fitted or any(link.standing for link in links)

    @property
    def is_held(self) -> bool:
        """Whether the lower end is also held."""
        return self.held is not UNSET
