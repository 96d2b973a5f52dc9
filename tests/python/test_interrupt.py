# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C is heard soon, in every call that can take long."""

import signal
import subprocess
import sys
import time

import psutil
import pytest

CALLS = {
    "shapes of a held cord": "rc.steady_shapes(rope, angular_speed=0.693, max_half_waves=1000)",
    "shapes of a held chain": "rc.steady_shapes(rc.Held(rods, span=2.0), conical_height=0.1, max_half_waves=1000)",
    "taut modes": "rc.modes(rc.Held(rods, tension=1e3), 1999)",
    "BufferImpact.state": "impact.state(many)",
    "steady_shapes": "rc.steady_shapes(rc.Chain.uniform_plummets(12), conical_height=1e-3, hanging_only=False)",
    "stability": "shape.stability()",
    "stability of a held shape": "held.stability()",
    "stability of a cord": "wavy.stability()",
    "stability of a held cord": "held_wavy.stability()",
    "stability_windows": "branch.stability_windows()",
    "branch": "rc.branch(rods, 1, min_conical_height=1e-9, max_step=1e-3, max_points=1_000_000)",
    "branches": "rc.branches(rc.Chain.uniform_plummets(8), min_conical_height=0.01)",
    "shapes of a cord": "rc.steady_shapes(rc.Cord(1.0), conical_height=1e-6)",
    "modes of a cord": "rc.modes(rc.Cord(1.0, density=lambda s: 1 + s), 100_000)",
    "modes of a cord with a tip": "rc.modes(rc.Cord(1.0, tip_mass=0.1), 30_000_000)",
    "modes of a cord that tapers": "rc.modes(rc.Cord(1.0, density=0.7), 30_000_000)",
    "shapes of modes of a cord": "rc.modes(rc.Cord(1.0), 5).along(many / 50)",
    "slopes of modes of a cord": "rc.modes(rc.Cord(1.0, tip_mass=0.1), 5).slope(many / 50)",
    "nodes of a cord": "rc.modes(rc.Cord(1.0), 30_000).nodes",
    "vertical points of a cord": "rc.modes(rc.Cord(1.0, tip_mass=0.1), 30_000).vertical_points",
    "modes": "rc.modes(rc.Chain.uniform_rods(20_000), 'all')",
    "modes in threads": "rc.modes(rc.Chain.uniform_rods(20_000), 'all', threads=2)",
    "dense": "rc.modes(large, method='dense')",
    "modes with dashpots": "rc.modes(rc.Rig(rc.Chain.uniform_rods(1000), pins=rc.Pin(damping=1e-4)), 3)",
    "swing with dashpots": "rc.swing(rc.Rig(rc.Chain.uniform_rods(1000), pins=rc.Pin(damping=1e-4)), [1.0], offset=np.ones(1000))",
    "recurrence": "rc.modes(rc.Chain.uniform_rods(60_000), 29_999)",
    "conical_heights": "rc.conical_heights(weight=weights, length=1.0)",
    "conical_heights in threads": "rc.conical_heights(weight=weights, length=1.0, threads=2)",
    "count_modes": "rc.count_modes(rods, conical_height=np.linspace(0.01, 1, 10_000_000))",
    "response": "rc.response(rods, conical_height=np.linspace(0.01, 1, 1_000_000), pins=[0])",
    "response in threads": "rc.response(rods, conical_height=np.linspace(0.01, 1, 1_000_000), pins=[0], threads=2)",
    "shape": "rc.modes(large, 'all').shape",
    "sensitivity": "rc.modes(large, 'all').sensitivity",
    "tune": "rc.tune(rc.Chain.uniform_rods(2_000_000), vary='links[1999998].weight', conical_height=0.2)",
    "Chain": "rc.Chain(weight=1.0, length=np.ones(30_000_000), centroid=0.5, radius_of_gyration=0.3)",
    "tapered": "rc.Chain.tapered(5_000_000, length=1.0, exponent=1.5)",
    "GovernorMotion": "rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5).state(many)",
    "elliptic.jacobi": "rc.elliptic.jacobi(many, modulus=0.5)",
}
SCRIPT = """
import threading
import numpy as np
import psutil
import revchain as rc
main = threading.get_native_id()
weights = np.ones((400_000, 60))
rods, large, many = rc.Chain.uniform_rods(2000, length=3.0), rc.Chain.uniform_rods(3000), np.linspace(0.01, 50, 20_000_000)
loop = rc.Chain.uniform_rods(300, length=1.0)
shape = rc.steady_shapes(loop, conical_height=0.5)[0]
held = rc.steady_shapes(rc.Held(loop, span=0.5), conical_height=0.1, prove=False)[0]
wavy = rc.steady_shape(rc.Cord(1.0), mode=12, conical_height=1e-3)
held_wavy = rc.steady_shapes(rc.Held(rc.Cord(1.0), span=0.5), conical_height=1e-3, max_half_waves=12)[-1]
rope = rc.Held(rc.Cord(0.678, weight=1.0), tension=0.861)
impact = rc.BufferImpact(front_mass=1, rear_mass=50, buffer_stiffness=1, coupling_stiffness=2, speed=1)
branch = rc.branch(rc.Chain.uniform_rods(60, length=1.0), 1, min_conical_height=0.2)
for call in {calls!r}:
    print("call", *(thread.id for thread in psutil.Process().threads() if thread.id != main), flush=True)
    try:
        while True:  # what ends soon is called again: the signal comes while it runs
            eval(call)
    except Exception as error:
        print(repr(error), flush=True)
    except KeyboardInterrupt:
        print("interrupted", flush=True)
print(rc.modes(rc.Chain.uniform_rods(1)).conical_height.size)
"""


def seconds_of(process):
    """Processor time, which does not count how busy the machine is: of the process and of each of its threads."""
    times = process.cpu_times()
    return times.user + times.system, {each.id: each.user_time + each.system_time for each in process.threads()}


@pytest.mark.slow
def test_ctrl_c_is_heard_in_every_long_call(start):
    script = start(sys.executable, "-c", SCRIPT.format(calls=list(CALLS.values())), stdout=subprocess.PIPE)
    process, heard, late = psutil.Process(script.pid), {}, {}
    for name in CALLS:
        word, *earlier = script.stdout.readline().split()
        assert word == "call", name
        time.sleep(0.3)
        sent, sent_by = seconds_of(process)
        script.send_signal(signal.SIGINT)
        heard[name] = script.stdout.readline().strip()
        end, end_by = seconds_of(process)
        # Threads that earlier calls abandoned go on beside this one: their time is not its own.
        others = sum(end_by[each] - sent_by[each] for each in map(int, earlier) if each in end_by)
        late[name] = end - sent - others
    assert {name: answer for name, answer in heard.items() if answer != "interrupted"} == {}
    assert {name: seconds for name, seconds in late.items() if seconds > 1} == {}
    assert script.stdout.read() == "1\n"
