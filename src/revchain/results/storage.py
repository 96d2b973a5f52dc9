# SPDX-License-Identifier: GPL-3.0-or-later
"""Results in files: .npz with numpy alone, .nc (netCDF 4) through xarray. Nothing is pickled."""

from __future__ import annotations

import os
import zlib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import IO, Any

import numpy as np

from .. import _core
from ..systems.chain import Chain
from ..systems.extras import require
from ..systems.numbers import file_path
from ..systems.rig import Rig
from .files import hdf5_file, naming, written_aside
from .modes import Modes
from .record import extra_columns, extra_fields, to_xarray
from .rig_modes import OtherModes, RigModes, WhirlModes

KIND = "revchain modes 1"
RIG_KIND = "revchain rig modes 1"
STATE = "chain_state_"
RIGGING = "rig_"
SEAL = b"revchain"  # then the CRC-32 of all bytes before it


def save(modes: Modes | RigModes, path: str | os.PathLike[str]) -> None:
    """See `Modes.save`, `RigModes.save`."""
    ending = _ending(f"revchain.{type(modes).__name__}.save", path)
    if isinstance(modes, RigModes) and ending != ".npz":
        raise ValueError(f"modes of a rig are kept in .npz files, got {os.fspath(path)}")
    dataset = _dataset(modes) if isinstance(modes, Modes) and ending == ".nc" else None
    with naming(path), written_aside(path) as [aside]:
        if dataset is not None:
            _write_netcdf(dataset, aside)
        else:
            with open(aside, "wb") as file:  # given a name, numpy may add to it
                np.savez(
                    file, allow_pickle=False, **(_arrays(modes) if isinstance(modes, Modes) else _rig_arrays(modes))
                )
        if aside.is_file():
            with open(aside, "r+b") as whole:
                whole.write(_seal(whole))


def load(path: str | os.PathLike[str]) -> Modes | RigModes:
    """Read a result that `Modes.save` or `RigModes.save` wrote.

    Parameters
    ----------
    path : path-like
        Ends in ``.npz`` or ``.nc``.

    Returns
    -------
    Modes or RigModes
        Equal to what was saved, bit for bit.

    Raises
    ------
    ValueError
        If the path has another ending, or the file holds something else or is damaged: its checksum tells.
    ImportError
        If what ``.nc`` needs is not installed; the message says how to install it.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> import revchain as rc, tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "result.npz"
    >>> chain = rc.Chain.uniform_rods(120, length=0.36)
    >>> rc.modes(chain, count=3).save(path)
    >>> rc.load(path).chain == chain
    True
    """
    ending = _ending("revchain.load", path)
    if ending == ".nc":
        xarray = _netcdf("reading .nc files")
    with open(path, "rb") as file:  # the ordinary OSError where it cannot be read
        size = max(os.fstat(file.fileno()).st_size - len(SEAL) - 4, 0)
        if _seal(file, size) != file.read():
            reason = "not a result that revchain saved, or damaged since; compute and save it again"
            raise ValueError(f"{os.fspath(path)}: {reason}")
        if ending == ".npz":
            return _from_arrays(dict(np.load(path, allow_pickle=False)))
    with xarray.open_dataset(path, engine="h5netcdf") as dataset:
        return _from_dataset(dataset.load())


def _seal(file: IO[bytes], size: int | None = None) -> bytes:
    """What ends a file of ours, by its first `size` bytes. Readers of .npz and .nc files pass over it."""
    checksum = 0
    while chunk := file.read(2**20 if size is None else min(2**20, size)):
        checksum = zlib.crc32(chunk, checksum)
        size = None if size is None else size - len(chunk)
    return SEAL + checksum.to_bytes(4, "little")


def _write_netcdf(dataset: Any, path: Path) -> None:
    from xarray.backends import H5NetCDFStore

    h5netcdf = require("h5netcdf", "netcdf", "saving .nc files")
    with hdf5_file(path) as file, h5netcdf.File(file, "w") as target:
        dataset.dump_to_store(H5NetCDFStore(target))


def _netcdf(purpose: str) -> Any:
    """xarray, once what it needs for .nc files is known to be there."""
    for module in ("h5py", "h5netcdf"):
        require(module, "netcdf", purpose)
    return require("xarray", "netcdf", purpose)


def _ending(place: str, path: str | os.PathLike[str]) -> str:
    ending = Path(file_path(place, "path", path)).suffix.lower()
    if ending not in (".npz", ".nc"):
        raise ValueError(f"results are kept in .npz or .nc files, got {os.fspath(path)}")
    return ending


def _state(chain: Chain) -> dict[str, Any]:
    return {f"{STATE}{index}": np.asarray(item) for index, item in enumerate(chain._compiled.__getstate__())}


def _chain(state: Mapping[str, Any]) -> Chain:
    items = [np.asarray(state[f"{STATE}{index}"]) for index in range(sum(name.startswith(STATE) for name in state))]
    core = _core.Chain.__new__(_core.Chain)
    core.__setstate__(tuple(item.item() if item.dtype.kind in "iub" else item for item in items))
    return Chain._wrap(core)


def _arrays(modes: Modes) -> dict[str, Any]:
    arrays = {
        "kind": np.asarray(KIND),
        "method": np.asarray(modes.method),
        "status": np.asarray(modes.status),
        "precision": np.asarray(modes.precision),
        "number": modes.number,
        "conical_height": modes.conical_height,
        "error_bound": modes.error_bound,
        **extra_columns(modes),
        **_state(modes.chain),
    }
    if modes.shape is not None and modes.residual is not None and modes.nodes is not None:
        arrays["shape"] = modes.shape
        arrays["residual"] = modes.residual
        arrays["node_count"] = np.array([nodes.size for nodes in modes.nodes], dtype=np.int64)
        arrays["node_position"] = np.concatenate([modes.conical_height[:0], *modes.nodes])
    return arrays


def _rig_arrays(modes: RigModes) -> dict[str, Any]:
    arrays = {
        "kind": np.asarray(RIG_KIND),
        **{name: np.asarray(getattr(modes, name)) for name in _RIG_FACTS},
        **_state(modes.rig.chain),
        **{RIGGING + name: np.asarray(value) for name, value in modes.rig._given.items() if value is not None},
    }
    for part, kind in _RIG_PARTS.items():
        for field in fields(kind):
            value = getattr(getattr(modes, part), field.name)
            if value is not None:
                arrays[f"{part}_{field.name}"] = np.asarray(value)
    return arrays


def _rig_from_arrays(arrays: Mapping[str, Any]) -> RigModes:
    given = {name.removeprefix(RIGGING): value for name, value in arrays.items() if name.startswith(RIGGING)}
    rig = Rig(_chain(arrays), **{name: value if value.ndim else value.item() for name, value in given.items()})
    parts: dict[str, Any] = {}
    for part, kind in _RIG_PARTS.items():
        columns = [arrays.get(f"{part}_{field.name}") for field in fields(kind)]
        parts[part] = kind(*(x if x is None or x.ndim else x.item() for x in columns))
    facts = {name: arrays[name] if arrays[name].ndim else arrays[name].item() for name in _RIG_FACTS}
    return RigModes(rig=rig, **parts, **facts)


_RIG_FACTS = ("gravity", "has_momentum", "slack_link", "slack_speed", "complete", "method", "status")
_RIG_PARTS: dict[str, type[Any]] = {"forward": WhirlModes, "backward": WhirlModes, "other": OtherModes}


def _from_arrays(arrays: Mapping[str, Any]) -> Modes | RigModes:
    if str(arrays["kind"]) == RIG_KIND:
        return _rig_from_arrays(arrays)
    if str(arrays["kind"]) != KIND:
        raise ValueError(f"its kind is {arrays['kind']}")
    nodes = None
    if "shape" in arrays:
        nodes = np.split(arrays["node_position"], np.cumsum(arrays["node_count"]))[:-1]
    return Modes(
        chain=_chain(arrays),
        number=arrays["number"],
        conical_height=arrays["conical_height"],
        error_bound=arrays["error_bound"],
        shape=arrays.get("shape"),
        residual=arrays.get("residual"),
        nodes=nodes,
        method=str(arrays["method"]),
        status=str(arrays["status"]),
        precision=str(arrays["precision"]),
        **extra_fields(arrays),
    )


def _dataset(modes: Modes) -> Any:
    _netcdf("saving .nc files")
    dataset = to_xarray(modes).assign_attrs(kind=KIND)
    for name, item in _state(modes.chain).items():
        dataset[name] = ([f"{name}_{axis}" for axis in range(item.ndim)], item)
    return dataset


def _from_dataset(dataset: Any) -> Modes:
    if dataset.attrs["kind"] != KIND:
        raise ValueError(f"its kind is {dataset.attrs['kind']}")
    names = set(dataset.variables)
    nodes = None
    if "shape" in names:
        nodes = [row[~np.isnan(row)] for row in dataset["node_position"].values]
    return Modes(
        chain=_chain({name: dataset[name].values for name in names if name.startswith(STATE)}),
        number=dataset["mode"].values,
        conical_height=dataset["conical_height"].values,
        error_bound=dataset["error_bound"].values,
        shape=dataset["shape"].values if nodes is not None else None,
        residual=dataset["residual"].values if nodes is not None else None,
        nodes=nodes,
        method=dataset.attrs["method"],
        status=dataset.attrs["status"],
        precision=dataset.attrs["precision"],
        **extra_fields({name: dataset[name].values for name in names}),
    )
