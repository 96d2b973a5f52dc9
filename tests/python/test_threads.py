# SPDX-License-Identifier: GPL-3.0-or-later
"""`threads`: the same bits whatever their number, and wrong numbers refused."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import revchain as rc

GENERATOR = np.random.default_rng(5)
UNLIKE = rc.Chain(weight=GENERATOR.uniform(0.5, 2, 500), length=GENERATOR.uniform(0.5, 2, 500))
PLUMMETS = rc.Chain.uniform_plummets(8, length=8.0)
CAROUSEL = rc.Rig(PLUMMETS, support=rc.Support(radius=0.1))
SPEEDS = np.linspace(0.1, 20, 400)
WEIGHTS = GENERATOR.uniform(0.5, 2, (1000, 5))

QUESTIONS = {
    "modes": (rc.modes, {"system": UNLIKE, "count": "all"}),
    "modes to the last digit of double-double": (rc.modes, {"system": PLUMMETS, "precision": "double-double"}),
    "modes of a rig": (rc.modes, {"system": rc.Rig(UNLIKE, support=rc.Support(stiffness=3.0)), "count": 200}),
    "modes of a rig with wheels": (rc.modes, {"system": rc.Rig(UNLIKE, flywheels=rc.Flywheel(momentum=0.1)), "count": 200}),
    "modes with a certificate": (rc.modes, {"system": UNLIKE, "count": 11, "method": "bisection", "certify": True}),
    "conical_heights": (rc.conical_heights, {"weight": WEIGHTS, "length": 1.0}),
    "response": (rc.response, {"system": UNLIKE, "angular_speed": SPEEDS, "pins": [0, 7]}),
    "response of a rig": (rc.response, {"system": CAROUSEL, "angular_speed": SPEEDS}),
    "steady_shapes": (rc.steady_shapes, {"system": PLUMMETS, "conical_height": 0.05}),
    "steady_shapes at a speed": (rc.steady_shapes, {"system": PLUMMETS, "angular_speed": 12.0}),
    "steady_shapes of a rig": (rc.steady_shapes, {"system": CAROUSEL, "conical_height": 0.2}),
    "steady_shapes of a rig at a speed": (rc.steady_shapes, {"system": CAROUSEL, "angular_speed": 7.0}),
}


def is_same(one, other):
    if isinstance(one, np.ndarray):
        return np.array_equal(one, other)
    lazy = ("shape", "residual") if isinstance(one, rc.Modes) else ()
    return one == other and all(np.array_equal(getattr(one, name), getattr(other, name)) for name in lazy)


@pytest.mark.parametrize("question", QUESTIONS)
def test_the_same_bits_whatever_the_number_of_threads(question):
    """Also of Python's threads, which share the system."""
    function, given = QUESTIONS[question]
    one = function(**given)
    assert all(is_same(one, function(**given, threads=threads)) for threads in (2, 3, 0))

    def ask(_):
        found = function(**given)
        if isinstance(found, rc.SteadyShapes):
            found[-1].stability()
        return found

    with ThreadPoolExecutor(6) as pool:
        assert all(is_same(one, found) for found in pool.map(ask, range(6)))


@pytest.mark.parametrize("question", QUESTIONS)
def test_numbers_of_threads_that_are_none(question):
    function, given = QUESTIONS[question]
    name = question.split()[0]
    with pytest.raises(ValueError, match=f"^revchain.{name}: threads must not be negative, got -1$"):
        function(**given, threads=-1)
    for wrong in (1.5, True, "2", None):
        with pytest.raises(ValueError, match=f"^revchain.{name}: threads must be a whole number, got "):
            function(**given, threads=wrong)
