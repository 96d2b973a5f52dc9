# SPDX-License-Identifier: GPL-3.0-or-later
"""Words of the documentation: the field's standard terms are there, names of earlier versions are not."""

import re

import pytest

TERMS = [
    "natural frequenc(y|ies)", "critical speed", "relative equilibri(um|a)", "double pendulum", "point mass",
    "base excitation", "inverted", "conical height", "half wave", "error bound",
]  # fmt: skip
GONE = (
    r"rc\.solve|held_shapes|held_cord_shapes|taut_modes|small_oscillation|SmallOscillation|continuous_shapes"
    r"|continuous_critical_heights|TautModes|HeldShapes|ContinuousShapes|ModelEstimate|momentum_for_speed|free_flywheel"
    r"|driven_flywheel|with_weight|rig_sensitivity|most_half_waves|most_points|most_shapes|longest_step"
    r"|up_to=|down_to=|carriage_weight=|displaced_weight=|standing=|any_posture|revolutions_per_minute"
)


def pages(repository):
    return [repository / "README.md", *sorted((repository / "docs").glob("*.md")), *sorted((repository / "docs").glob("[!r]*/*.md"))]


@pytest.mark.parametrize("term", TERMS)
def test_standard_terms(repository, term):
    texts = [re.sub(r"\s+", " ", path.read_text(encoding="utf-8")) for path in pages(repository)]
    systems = (repository / "docs/systems.md").read_text(encoding="utf-8")  # README leads to its table
    assert re.search(term, texts[0] + systems, re.IGNORECASE)
    assert any(re.search(term, text, re.IGNORECASE) for text in texts[1:])


def test_names_of_earlier_versions_are_gone(repository):
    """C++ (`::`), the compiled module (`_core.`) and data files have some of these names."""
    old = re.compile(rf"(?<![\w/.])(rc\.|revchain\.)?({GONE})(?!\w|\.csv)")
    folders = {"examples": ("py", "toml"), "src/revchain": ("py", "toml", "json"), "bench": ("py",)}
    paths = pages(repository)
    paths += [p for folder, ends in folders.items() for end in ends for p in sorted((repository / folder).rglob(f"*.{end}"))]
    assert len(paths) > 100
    found = []
    for path in paths:
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            if match := old.search(re.sub(r"(::|_core\.)\w+", "", line)):
                found.append(f"{path.relative_to(repository)}:{number}: {match[0]}")
    assert not found, "\n".join(found)
