# SPDX-License-Identifier: GPL-3.0-or-later
"""Results in files: .npz by numpy, .nc (netCDF 4) by xarray, without pickles."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from tokenize import TokenError
from typing import IO, TYPE_CHECKING, Any
from zipfile import ZIP_STORED, BadZipFile, ZipFile

import numpy as np

from ..systems.extras import require
from ..systems.numbers import file_path
from ..systems.units import SPEED_UNITS
from ..systems.system import System
from ..systems.system import restored as system_from
from .files import hdf5_file, naming, written_aside
from .kinds import KINDS, restored

if TYPE_CHECKING:
    from .base import Result

FORMAT = 2  # raised when files are written that earlier versions cannot read; no release wrote files of format 1
HEADER = "revchain"  # name of the entry that describes the contents of a file
COMPRESSED = "holds arrays larger than the file, as revchain saves none; compute and save the result again"
NOT_OURS = "is not a result that revchain saved, or was damaged since; compute and save it again"


class NotRead(ValueError):
    """The error for a file that is not read for a known reason."""


class UnknownKind(ValueError):
    """The error for a result of a class that this version does not have."""


WRONG = (  # what the readers raise for a file that is damaged or that somebody else made
    *(ArithmeticError, AttributeError, BadZipFile, EOFError, LookupError, MemoryError, NotImplementedError),
    *(OSError, RuntimeError, SyntaxError, TokenError, TypeError, ValueError),
)


def save(result: Any, path: str | os.PathLike[str]) -> None:
    """Write a result to a file; described by `Result.save`."""
    ending = _ending(f"revchain.{type(result).__name__}.save", path)
    arrays: dict[str, np.ndarray[Any, Any]] = {}
    if ending == ".nc":
        _netcdf("saving .nc files")
        labelled = result.to_xarray()  # computes the fields of the table, so that they are saved, too
    said = {"format": f"revchain {FORMAT}", "version": _version()}
    header = json.dumps({**said, "result": _packed(result, type(result).__name__, arrays, {})})
    dataset = _dataset(labelled, header, arrays) if ending == ".nc" else None
    with naming(path), written_aside(path) as [aside]:
        if dataset is not None:
            _write_netcdf(dataset, aside)
        else:
            with open(aside, "wb") as file:  # numpy may add an ending to a name
                np.savez(file, allow_pickle=False, **{HEADER: np.asarray(header)}, **arrays)


def load(path: str | os.PathLike[str]) -> Result:
    """Return a result from a file written by its method `save`.

    Parameters
    ----------
    path : path-like
        Path that ends in ``.npz`` or ``.nc``.

    Returns
    -------
    Modes or another result
        The result, equal to the saved one bit for bit.

    Raises
    ------
    ValueError
        If the path has another ending, or the file does not contain a result, is damaged, or was saved by a later version
        and cannot be read by this one.
    ImportError
        If a package for ``.nc`` is not installed; the message says how to install it.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> import revchain as rc, tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "result.npz"
    >>> chain = rc.Chain.uniform_rods(120, length=0.36)
    >>> rc.modes(chain, 3).save(path)
    >>> rc.load(path).system == chain
    True
    """
    ending = _ending("revchain.load", path)
    if ending == ".nc":
        xarray = _netcdf("reading .nc files")
    with open(path, "rb") as file:  # raises the ordinary OSError if it cannot be read
        size = os.fstat(file.fileno()).st_size
        try:
            if ending == ".npz":
                arrays = _arrays(file, size)
                return _loaded(arrays.get(HEADER), arrays)
            with xarray.open_dataset(file, engine="h5netcdf", decode_times=False) as dataset:
                if dataset.nbytes > size:
                    raise NotRead(COMPRESSED)
                whole = dataset.load()
                return _loaded(whole.attrs.get(HEADER), {name: whole[name].values for name in whole.variables})
        except NotRead as error:
            raise ValueError(f"{os.fspath(path)}: {error}") from error
        except WRONG as error:
            raise ValueError(f"{os.fspath(path)}: {NOT_OURS} ({error or type(error).__name__})") from error


def _arrays(file: IO[bytes], size: int) -> dict[str, np.ndarray[Any, Any]]:
    """The arrays of an .npz file that holds no pickles and no compressed data."""
    with ZipFile(file) as entries:
        if any(entry.compress_type != ZIP_STORED or entry.file_size > size for entry in entries.infolist()):
            raise NotRead(COMPRESSED)
        arrays: dict[str, np.ndarray[Any, Any]] = {}
        for entry in entries.namelist():
            name = entry.removesuffix(".npy")
            try:
                arrays[name] = whole_array(entries, entry)
            except ValueError as error:
                reason = "is not loaded: it is damaged or holds pickled Python objects, which may run any code"
                raise NotRead(f"the array {name!r} {reason} ({error}); compute and save the result again") from None
    return arrays


def whole_array(entries: ZipFile, name: str) -> np.ndarray[Any, Any]:
    """The array in an entry of an .npz file, which is read to its end, where its checksum is compared."""
    with entries.open(name) as file:
        found: np.ndarray[Any, Any] = np.lib.format.read_array(file, allow_pickle=False)
        if file.read():
            raise ValueError("there are bytes after its end")
        return found


def _loaded(header: Any, arrays: Mapping[str, Any]) -> Result:
    if header is None:
        raise NotRead(NOT_OURS)
    said = json.loads(str(header))
    number = re.fullmatch(r"revchain (\d{1,9})", str(said.get("format")))
    if number and int(number[1]) > FORMAT:
        raise NotRead(f"has format {number[1]}, but revchain {_version()} reads formats up to {FORMAT}; {_install(said)}")
    if not number or int(number[1]) < FORMAT:
        raise NotRead(NOT_OURS)
    try:
        found: Result = _unpacked(said["result"], arrays, {})
    except UnknownKind as error:
        raise NotRead(f"holds a {error}, which revchain {_version()} does not know; {_install(said)}") from None
    return found


def _version() -> str:
    from .. import __version__

    return __version__


def _install(said: Mapping[str, Any]) -> str:
    """Return the advice for a file that this version cannot read."""
    version = said.get("version")
    known = isinstance(version, str) and re.fullmatch(r"[\w.+-]{1,40}", version)
    return f"it was saved by revchain {version}: install that version or a later one" if known else "install a later version"


def _packed(value: Any, name: str, arrays: dict[str, Any], made: dict[int, str]) -> Any:
    """Return `value` as data for JSON. Arrays go into `arrays` by name; a system is written once, named in `made`."""
    if isinstance(value, np.ndarray):
        if value.dtype.kind != "c":
            arrays[name] = value
            return {"array": name}
        arrays[name] = np.stack([value.real, value.imag], axis=-1)  # netCDF has no complex numbers
        return {"complex": name}
    if hasattr(value, "_fields") and hasattr(value, "_state"):
        state = {key: _packed(item, f"{name}.{key}", arrays, made) for key, item in value._state().items()}
        return {"result": type(value).__name__, "module": type(value).__module__, "state": state}
    if isinstance(value, System):
        if id(value) in made:
            return {"same": made[id(value)]}
        made[id(value)] = name
        return {"system": type(value).__name__, "name": name, "state": _packed(value._state(), name, arrays, made)}
    if isinstance(value, dict):
        return {"dict": {key: _packed(item, f"{name}.{key}", arrays, made) for key, item in value.items()}}
    if isinstance(value, tuple) and value and all(isinstance(x, np.ndarray) and x.ndim == 1 for x in value):
        arrays[name] = np.concatenate(value)  # one array, not one for each mode
        return {"arrays": name, "lengths": [len(x) for x in value]}
    if isinstance(value, tuple):
        return {"tuple": [_packed(item, f"{name}.{k}", arrays, made) for k, item in enumerate(value)]}
    return value.item() if isinstance(value, np.generic) else value


def _unpacked(value: Any, arrays: Mapping[str, Any], made: dict[str, Any]) -> Any:
    if not isinstance(value, dict):
        return value
    if "array" in value:
        return arrays[value["array"]]
    if "complex" in value:
        pairs = arrays[value["complex"]]
        number = np.empty(pairs.shape[:-1], np.complex128)
        number.real, number.imag = pairs[..., 0], pairs[..., 1]
        return number
    if "result" in value:
        state = {key: _unpacked(item, arrays, made) for key, item in value["state"].items()}
        if value["result"] not in KINDS and str(value.get("module")).startswith("revchain.closed_forms."):
            import_module(value["module"])  # imported when they are first needed
        if value["result"] not in KINDS:
            raise UnknownKind(str(value["result"]))
        if state.get("_speed_unit", "s") not in SPEED_UNITS:
            raise ValueError(f"holds a result in the unit {state['_speed_unit']}, which is none of speeds")
        return restored(KINDS[value["result"]], state)
    if "system" in value:
        made[value["name"]] = system_from(value["system"], _unpacked(value["state"], arrays, made))
        return made[value["name"]]
    if "same" in value:
        return made[value["same"]]
    if "arrays" in value:
        return tuple(np.split(arrays[value["arrays"]], np.cumsum(value["lengths"])[:-1]))
    if "dict" in value:
        return {key: _unpacked(item, arrays, made) for key, item in value["dict"].items()}
    return tuple(_unpacked(item, arrays, made) for item in value["tuple"])


def _dataset(dataset: Any, header: str, arrays: dict[str, Any]) -> Any:
    """The labelled data set with the data from which the result is restored."""
    dataset = dataset.assign_attrs({HEADER: header})
    for name in [name for name, column in dataset.variables.items() if column.dtype.kind == "c"]:
        dataset[f"{name}_real"], dataset[f"{name}_imaginary"] = dataset[name].real, dataset[name].imag
        dataset = dataset.drop_vars(name)
    return dataset.assign(
        {name: ([f"{name}_{axis}" for axis in range(array.ndim)], array) for name, array in arrays.items()}
    )


def _write_netcdf(dataset: Any, path: Path) -> None:
    from xarray.backends import H5NetCDFStore

    h5netcdf = require("h5netcdf", "netcdf", "saving .nc files")
    with hdf5_file(path) as file, h5netcdf.File(file, "w") as target:
        dataset.dump_to_store(H5NetCDFStore(target))


def _netcdf(purpose: str) -> Any:
    """The package xarray; an ImportError if a package for .nc files is missing."""
    for module in ("h5py", "h5netcdf"):
        require(module, "netcdf", purpose)
    return require("xarray", "netcdf", purpose)


def _ending(caller: str, path: str | os.PathLike[str]) -> str:
    ending = Path(file_path(caller, "path", path)).suffix.lower()
    if ending not in (".npz", ".nc"):
        more = "; for a picture: result.plot().figure.savefig(...); for a scene: revchain.load_scene"
        raise ValueError(f"results are kept in .npz or .nc files, got {os.fspath(path)}{more}")
    return ending
