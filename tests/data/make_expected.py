# SPDX-License-Identifier: GPL-3.0-or-later
"""Expected values of the example scenes, in many digits and by another road than the program's.

    python tests/data/make_expected.py [SCENE.toml ...]      # all scenes: about two minutes with gmpy2

Needs mpmath alone; nothing of revchain is imported. A scene's decimals are read as they are written,
not rounded to double. Chains of up to 200 links: the dense inertia matrix in the ANGLES of the links
(not the offsets of the pins, which the program uses), reduced by its diagonal stiffness, all its
eigenvalues by mpmath.eigsy with 80 digits. Longer chains: counting negative pivots of the assembled
tridiagonal pencil with 60 digits, and bisection. Scenes with supports, standing links, flywheels, fluids,
clamped links or weights at pins: expected_rigs.py; let go, or held at both ends: expected_motions.py;
cords: expected_cords.py; Campbell diagrams and governors: expected_campbell.py;
drag: expected_drag.py. Cross-checks: Laguerre zeros for equal plummets,
the closed quadratic for two plummets, the count of the assembled pencil on both sides of each height.
"""

from __future__ import annotations

import json
import sys
import tomllib
from pathlib import Path

import mpmath as mp
import expected_cords
from expected_campbell import crossings, governor
from expected_drag import ball
from expected_motions import held, let_go
from expected_rigs import expected_of, number
from mpmath import mpf

SCENES = Path(__file__).resolve().parents[2] / "examples" / "scenes"
DENSE_LIMIT = 200
DEFAULT_MODES = 10


def links_of(scene):
    """(W, a, h, rho^2) of each link, lowest first; weights as masses, whose ratios are the same."""
    if "uniform_chain" in scene:
        chain = scene["uniform_chain"]
        count = chain["count"]
        length = number(chain["length"]) / count
        weight = number(chain.get("mass", chain.get("weight"))) / count
        return [body({"kind": chain["kind"].removesuffix("s")}, weight, length)] * count
    links = []
    for link in scene["links"]:
        links += [body(link, number(link["mass"]), number(link["length"]))] * link.get("repeat", 1)
    return links


def body(link, weight, length):
    if "centroid" in link:
        h = mpf(link["centroid"])
        if "radius_of_gyration" in link:
            return weight, length, h, mpf(link["radius_of_gyration"]) ** 2
        return weight, length, h, h * (mpf(link["pendulum_length"]) - h)
    if link.get("kind") == "rod":
        return weight, length, length / 2, length**2 / 12
    return weight, length, length, mpf(0)


def heights_by_angles(links):
    """All conical heights: J d = height * kappa d, d the angles of the links with the vertical.

    With J[m][m] = W h l + a^2 S and J[m][n] = a_n (W_m h_m + a_m S_m) for n above m, S the weight
    below: the work of the centrifugal force in the angles.
    """
    below = [mpf(0)]
    for link in links[:-1]:
        below.append(below[-1] + link[0])
    kappa = [w * h + a * s for (w, a, h, _), s in zip(links, below)]
    n = len(links)
    inertia = mp.matrix(n)
    for m, (w, a, h, rho2) in enumerate(links):
        inertia[m, m] = (w * (h**2 + rho2) + a**2 * below[m]) / kappa[m]
        for j in range(m + 1, n):
            inertia[m, j] = inertia[j, m] = links[j][1] * kappa[m] / mp.sqrt(kappa[m] * kappa[j])
    return sorted(mp.eigsy(inertia, eigvals_only=True), reverse=True)


def assembled(links):
    """Diagonals and off-diagonals of K and M over the pins, free end first, support left out."""
    n = len(links)
    k_diagonal, k_beside, m_diagonal, m_beside = ([mpf(0)] * (n + 1) for _ in range(4))
    below = mpf(0)
    for m, (w, a, h, rho2) in enumerate(links):
        stiffness = (w * h + a * below) / a**2
        p, q = h / a, (h**2 + rho2) / a**2
        k_diagonal[m] += stiffness
        k_diagonal[m + 1] += stiffness
        k_beside[m] = -stiffness
        m_diagonal[m] += w * q
        m_diagonal[m + 1] += w * (1 - 2 * p + q)
        m_beside[m] = w * (p - q)
        below += w
    return k_diagonal[:n], k_beside[: n - 1], m_diagonal[:n], m_beside[: n - 1]


def count_above(pencil, height):
    """How many conical heights exceed `height`: negative pivots of K - M / height."""
    mu = 1 / height
    k, kb, m, mb = pencil
    pivot = k[0] - mu * m[0]
    count = int(pivot < 0)
    for i in range(1, len(k)):
        beside = kb[i - 1] - mu * mb[i - 1]
        pivot = k[i] - mu * m[i] - beside * beside / pivot
        count += pivot < 0
    return count


def heights_by_counting(links, count, digits):
    """The `count` greatest conical heights by bisection between neighbours of the heavy chain's."""
    pencil = assembled(links)
    length = sum(link[1] for link in links)
    heights = []
    for k in range(1, count + 1):
        guess = 4 * length / mp.besseljzero(0, k) ** 2
        low, high = guess * mpf("0.99"), guess * mpf("1.01")
        assert count_above(pencil, low) == k and count_above(pencil, high) == k - 1
        while high - low > low * mpf(10) ** -digits:
            middle = (low + high) / 2
            if count_above(pencil, middle) >= k:
                low = middle
            else:
                high = middle
        heights.append((low + high) / 2)
    return heights


def nodes_of(links, height):
    """Distances from the free end where the mode crosses the axis: rows of (K - M / height) y = 0."""
    k, kb, m, mb = assembled(links)
    mu = 1 / height
    y = [mpf(1)]
    for i in range(len(links) - 1):
        left = (k[i] - mu * m[i]) * y[i]
        if i:
            left += (kb[i - 1] - mu * mb[i - 1]) * y[i - 1]
        y.append(-left / (kb[i] - mu * mb[i]))
    nodes, at = [], mpf(0)
    for i, (_, length, _, _) in enumerate(links[:-1]):
        if y[i] * y[i + 1] < 0:
            nodes.append(at + length * y[i] / (y[i] - y[i + 1]))
        at += length
    return nodes


def check(links, heights, name):
    pencil = assembled(links)
    step = mpf(10) ** -25
    for k, height in enumerate(heights, 1):
        assert count_above(pencil, height * (1 + step)) == k - 1, (name, k)
        assert count_above(pencil, height * (1 - step)) == k, (name, k)
    plummets = all(h == a and rho2 == 0 for _, a, h, rho2 in links)
    if plummets and len(set(links)) == 1 and len(heights) == len(links):
        for height in heights:
            assert abs(mp.laguerre(len(links), 0, links[0][1] / height)) < mpf(10) ** -40, name
    if plummets and len(links) == 2:  # Greenhill (1908) section 2 (5)
        (w2, a2, _, _), (w1, a1, _, _) = links
        for height in heights:
            assert abs((height - a1) * (height - a2) - w2 * a1 * a2 / (w1 + w2)) < mpf(10) ** -60, name


def is_rigged(scene):
    """Whether anything in it is beyond a plain chain."""
    beyond = {"standing", "flywheel", "displaced", "clamped", "tip_mass", "pin"}
    return "support" in scene or any(beyond & set(t) for t in [scene.get("uniform_chain", {}), *scene.get("links", [])])


def of_cord(scene, digits, count):
    """Heights, speeds and nodes of a scene with a uniform cord."""
    cord, gravity = scene["cord"], mp.mpf(scene.get("gravity", mp.mpf("9.80665")))
    assert not cord.get("density")
    masses = [(number(each["arc_length"]), number(each["mass"])) for each in cord.get("masses", ())]
    bob = [number(cord.get(name, 0)) for name in ("tip_mass", "tip_centroid", "tip_radius_of_gyration")]
    pieces = expected_cords.Pieces(number(cord["length"]), number(cord["mass"]), masses, *bob)
    return {
        "size": 0,
        "modes": [
            {
                "conical_height": mp.nstr(height, digits),
                "angular_speed": mp.nstr(mp.sqrt(gravity / height), digits),
                "nodes": [mp.nstr(node, 20) for node in pieces.nodes(height)],
            }
            for height in pieces.heights(count)
        ],
    }


def write(path, expected):
    target = path.with_name(f"{path.stem}.expected.json")
    target.write_text(json.dumps(expected, indent=1) + "\n", encoding="utf-8")
    print(target.name, *(mode["conical_height"][:20] for mode in expected["modes"][:1]))


def make(path):
    mp.mp.dps = 80
    scene = tomllib.loads(path.read_text(encoding="utf-8"), parse_float=mpf)
    head = {"scene": path.name, "made_by": "tests/data/make_expected.py"}
    if "held" in scene:
        by = "the potential made stationary in the angles, Newton's method, 80 digits"
        return write(path, {**head, "by": by, "digits": 30, "modes": [], "shapes": held(scene)})
    if "governor" in scene:
        by = "the energies of the linkage, differentiated numerically, 80 digits"
        return write(path, {**head, "by": by, "digits": 40, "modes": [], **governor(scene)})
    if "drag" in scene.get("ask", {}):
        by = "the balance of forces on the ball, 80 digits"
        return write(path, {**head, "by": by, "digits": 40, "modes": [], "drag": ball(scene, 40)})
    if is_rigged(scene):
        asked = scene.get("ask", {}).get("modes", {}).get("count", DEFAULT_MODES)
        by = "Lagrange's equations in the angles, dense companion matrix, 80 digits"
        found = expected_of(scene, 40, 10**9 if asked == "all" else asked)
        if "campbell" in scene.get("ask", {}):
            found["crossings"] = crossings(scene)
        return write(path, {**head, "by": by, "digits": 40, **found})
    if "cord" in scene:
        asked = scene.get("ask", {}).get("modes", {}).get("count", DEFAULT_MODES)
        by = "Bessel functions between the masses, 80 digits"
        return write(path, {**head, "by": by, "digits": 40, **of_cord(scene, 40, asked)})
    links = links_of(scene)
    n = len(links)
    asked = scene.get("ask", {}).get("modes", {}).get("count", min(DEFAULT_MODES, n))
    asked = n if asked == "all" else asked
    dense = n <= DENSE_LIMIT
    mp.mp.dps = 80 if dense else 60  # the counting is checked below to 25 digits on both sides
    heights = heights_by_angles(links)[:asked] if dense else heights_by_counting(links, asked, 30)
    check(links, heights, path.name)
    gravity = mpf(scene.get("gravity", mpf("9.80665")))
    digits = 40 if dense else 28
    expected = {
        **head,
        "by": "dense inertia matrix in the angles, 80 digits" if dense else "counting pivots, 60 digits, bisection",
        "digits": digits,
        "size": n,
        "modes": [
            {
                "conical_height": mp.nstr(height, digits),
                "angular_speed": mp.nstr(mp.sqrt(gravity / height), digits),
                "nodes": [mp.nstr(node, 20) for node in nodes_of(links, height)],
            }
            for height in heights
        ],
    }
    if "swing" in scene.get("ask", {}):
        expected["swing"] = let_go(scene)
    write(path, expected)


if __name__ == "__main__":
    for scene_path in map(Path, sys.argv[1:]) if sys.argv[1:] else sorted(SCENES.glob("*.toml")):
        make(scene_path.resolve())
