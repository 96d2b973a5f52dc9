#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random changes of scene, study and result files: each is read, or refused with one error that names the file.

files.py SECONDS [FIRST_SEED [COUNT]]: one file for each seed; a failure tells the seed, which repeats it with COUNT 1.
"""

import contextlib
import json
import random
import re
import resource
import signal
import sys
import tempfile
import time
import tomllib
import warnings
from pathlib import Path

import numpy as np

import revchain as rc
from revchain.results import storage
from revchain.scenes.error import SceneError

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
LONGEST, MOST_MEMORY = 30, 8 * 2**30  # seconds of a call, bytes of the process
MOST_LINKS = 100_000  # of a system that is made; larger scenes are only read
WILD = (0, -1, 1, 2**63, 10**400, -0.0, 1e308, 5e-324, float("nan"), float("inf"), True, None, "", "1 m")
WILD += ("nan kg", "\0", "1e999 m", "(((", "9**9**9", "__import__", "links[0]", "\ud800", [], {})
WILD += ([[]], [{}], {"": {}}, [1.0] * 50)
MARKS = (b"[", b"]", b"[[", b"{", b"}", b'"', b"'", b"=", b".", b",", b"\n", b"#", b"\0", b"\xff")
MARKS += (b"1e999", b"[[links]]\n")


def changed_text(data: bytes, draw: random.Random) -> bytes:
    for _ in range(draw.randint(1, 6)):
        at, stop = sorted(draw.randrange(len(data) + 1) for _ in range(2))
        stop = min(stop, at + 40)
        part = draw.choice((b"", draw.choice(MARKS), data[at:stop] * draw.choice((2, 30)), draw.choice(MARKS) * 3000))
        data = data[:at] + part + data[draw.choice((at, at, stop)) :]
    return data


def changed_data(data, draw: random.Random):
    """A copy of the data in which one value, at any depth, is another."""
    inside = isinstance(data, dict | list) and data and draw.random() < 0.9
    if not inside:
        return draw.choice((*WILD, [data] * draw.choice((1, 3)), {"links": data}))
    keys = list(data) if isinstance(data, dict) else list(range(len(data)))
    key, copy = draw.choice(keys), data.copy()
    kind = draw.random()
    if kind < 0.1:
        del copy[key]
    elif kind < 0.2 and isinstance(data, dict):
        copy[draw.choice(("", "links", "repeat", "state", "array", "same", str(key)[:-1]))] = data[key]
    else:
        copy[key] = changed_data(data[key], draw)
    return copy


def changed_array(array, draw: random.Random):
    if draw.random() < 0.3:
        return draw.choice((array[..., :-1] if array.ndim else array, array.ravel(), np.zeros(7), array.astype("U")))
    if array.dtype.kind not in "fiu" or not array.size:
        return np.array([None]).astype("U9")
    copy, numbers = array.copy(), (np.nan, -1.0, 0.0, np.inf, 1e300) if array.dtype.kind == "f" else (0, 1, 100)
    copy.flat[draw.randrange(copy.size)] = draw.choice(numbers)
    return copy


def changed_headers(data: bytes, draw: random.Random) -> bytes:
    """An .npz file in which bytes inside the headers of arrays are others, such as a digit of a shape."""
    places, changed = [found.start() for found in re.finditer(b"\x93NUMPY", data)], bytearray(data)
    for _ in range(draw.choice((1, 1, 1, 3))):
        at = draw.choice(places)
        size = 10 + int.from_bytes(data[at + 8 : at + 10], "little")  # magic, version and length; then the header
        changed[at + draw.randrange(size)] = draw.choice((draw.randrange(256), *b"()[]{}',:012345678|<>fib\n "))
    return bytes(changed)


def small(scene: rc.Scene) -> bool:
    whole = [getattr(scene, name) for name in ("uniform_chain", "tapered_chain")]
    counts = [getattr(each, "count", 0) for each in whole]
    return sum(counts) + sum(getattr(link, "repeat", 1) for link in scene.links or ()) < MOST_LINKS


def read_scene(path: Path) -> None:
    scene = rc.load_scene(path)
    if rc.Scene.from_dict(scene.to_dict()) != scene:
        raise AssertionError("the scene changes when it is written and read")
    if small(scene):
        scene.system()


def read_study(path: Path) -> None:
    study = rc.load_study(path)
    if rc.Study.from_dict(study.to_dict()) != study:
        raise AssertionError("the study changes when it is written and read")


def read_result(path: Path) -> None:
    result = rc.load(path)
    with contextlib.suppress(*storage.WRONG):  # numbers that do not belong together; the process must survive them
        repr(result), result.to_dict()


class Corpus:
    """Files that are right, each with the function that reads it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        files = [*sorted(EXAMPLES.glob("scenes/**/*.toml")), *sorted(EXAMPLES.glob("studies/**/*.toml"))]
        texts = [path.read_text(encoding="utf-8") for path in files]
        self.texts = [(read_study if "vary" in tomllib.loads(text) else read_scene, text) for text in texts]
        self.results = []
        chain = rc.Chain(weight=[5, 1, 0, 1], length=[1, 2, 1, 1], centroid=[1, 0.5, 0.1, -0.2], radius_of_gyration=0.3)
        rig = rc.Rig(chain, flywheels=rc.Flywheel(momentum=0.2), support=rc.Support(stiffness=5.0))
        for result in (rc.modes(chain, certify=True), rc.modes(rig), rc.steady_shapes(chain, conical_height=0.4)):
            result.save(folder / "right.npz")
            with np.load(folder / "right.npz") as kept:
                self.results.append(dict(kept))
        self.long = rc.modes(rc.Chain.uniform_rods(2000, length=1.0), 600)  # arrays of more than 4096 bytes, which
        self.long.save(folder / "right.npz")  # zipfile does not read at once
        self.bytes_of_long = (folder / "right.npz").read_bytes()

    def read_long(self, path: Path) -> None:
        if rc.load(path) != self.long:
            raise AssertionError("a damaged file is read, with other numbers")

    def changed(self, draw: random.Random) -> tuple:
        """A function and the file that it is to read."""
        kind = draw.randrange(5)
        if kind == 4:
            path = self.folder / "changed.npz"
            path.write_bytes(changed_headers(self.bytes_of_long, draw))
            return self.read_long, path
        if kind == 3:
            return read_result, self._changed_result(draw)
        read, text = draw.choice(self.texts)
        if kind == 2:
            path = self.folder / "changed.json"
            data = tomllib.loads(text)
            path.write_bytes(json.dumps(changed_data(data, draw)).encode())
            return read, path
        path = self.folder / "changed.toml"
        path.write_bytes(changed_text(text.encode(), draw))
        return read, path

    def _changed_result(self, draw: random.Random) -> Path:
        path, arrays = self.folder / "changed.npz", dict(draw.choice(self.results))
        if draw.random() < 0.5:
            header = changed_data(json.loads(str(arrays[storage.HEADER])), draw)
            arrays[storage.HEADER] = np.asarray(json.dumps(header))
        else:
            name = draw.choice(list(arrays))
            arrays[name] = changed_array(arrays[name], draw)
        np.savez(path, allow_pickle=False, **arrays)
        data = path.read_bytes()
        path.write_bytes(changed_text(data, draw) if draw.random() < 0.2 else data)
        return path


def failure(read, path: Path) -> str:
    """What is wrong with how a file is read or refused; empty if nothing is."""
    try:
        read(path)
    except Exception as error:
        kind = SceneError if read in (read_scene, read_study) else ValueError
        right = isinstance(error, kind) and str(error).startswith(str(path))
        return "" if right else f"{type(error).__name__}: {error}"
    return ""


def hung(*_) -> None:
    raise TimeoutError(f"the call took longer than {LONGEST} s")


def main(seconds: float, first: int = 1, count: int = sys.maxsize) -> int:
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    signal.signal(signal.SIGALRM, hung)
    warnings.simplefilter("ignore")  # results of numbers that do not belong together
    began, seed, failures = time.monotonic(), first, 0
    with tempfile.TemporaryDirectory() as folder:
        corpus = Corpus(Path(folder))
        while seed < first + count and time.monotonic() - began < seconds:
            if sys.stdout.isatty() or seed % 1000 == 0:  # if the process dies: start again from the last number
                print(seed, end="\r" if sys.stdout.isatty() else "\n", flush=True)
            read, path = corpus.changed(random.Random(seed))
            signal.alarm(LONGEST)
            if found := failure(read, path):
                print(f"seed {seed}: {read.__name__}: {found[:2000]}")
                failures += 1
            signal.alarm(0)
            seed += 1
    print(f"{seed - first} files checked, {failures} failures")
    return int(failures > 0)


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1]), *map(int, sys.argv[2:4])))
