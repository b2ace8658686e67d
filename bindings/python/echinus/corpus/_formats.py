"""Converts samples to the bytes of files in the formats of other projects.

The same samples give the same bytes: nothing is compressed, and no file contains a date.
"""

from __future__ import annotations

import io
import json
import tarfile
import zipfile
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from echinus.corpus._samples import Samples

Format = Literal["occupancy", "deepsdf", "webdataset"]


def names_of(name: str, form: Format) -> list[str]:
    """The files that a mesh may have, outside of archives."""
    if form == "occupancy":
        return [f"{name}/points.npz", f"{name}/pointcloud.npz"]
    return [f"{name}.npz"] if form == "deepsdf" else []


def files_of(samples: Samples, name: str, form: Format) -> dict[str, bytes]:
    """The files of one mesh, by their paths below the output folder or in the archive."""
    if form == "occupancy":
        return _occupancy_networks(samples, name)
    if form == "deepsdf":
        return dict(zip(names_of(name, form), [_npz(_deepsdf(samples))]))
    return _webdataset(samples, name)


def _occupancy_networks(s: Samples, name: str) -> dict[str, bytes]:
    """points.npz and pointcloud.npz of Mescheder et al. 2019: packed bits, and the position and size of the frame."""
    frame: dict[str, Any] = {"loc": s.loc, "scale": np.float64(s.scale)}
    occupancies, certain = np.packbits(s.occupancy), np.packbits(s.certain)
    points = frame | {"points": s.points, "occupancies": occupancies, "certain": certain}
    cloud = frame | {"points": s.surface, "normals": s.normals}
    return dict(zip(names_of(name, "occupancy"), [_npz(points), *([_npz(cloud)] if len(s.surface) else [])]))


def _deepsdf(s: Samples) -> dict[str, Any]:
    """pos and neg of Park et al. 2019: rows x, y, z, signed distance; a distance of 0 is in pos."""
    rows = np.concatenate([s.points.astype(np.float32), s.distance[:, None]], axis=1)
    outside = s.distance >= 0
    return {
        "pos": rows[outside],
        "neg": rows[~outside],
        "pos_certain": s.certain[outside],
        "neg_certain": s.certain[~outside],
        "offset": -s.loc,
        "scale": np.float64(1 / s.scale),
    }


def _webdataset(s: Samples, name: str) -> dict[str, bytes]:
    """Files whose names are equal up to the first dot of the last part are one sample."""
    arrays = {
        "points": s.points,
        "occupancy": s.occupancy,
        "distance": s.distance,
        "nearest": s.nearest,
        "certain": s.certain,
        "surface": s.surface,
        "normals": s.normals,
    }
    files = {f"{name}.{field}.npy": _npy(array) for field, array in arrays.items()}
    return files | {f"{name}.json": json.dumps(s.report, sort_keys=True).encode()}


def archive_of(files: Mapping[str, bytes]) -> bytes:
    """A tar archive of the files."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for name, content in files.items():
            entry = tarfile.TarInfo(name)
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))
    return packed.getvalue()


def _npy(array: Any) -> bytes:
    packed = io.BytesIO()
    np.save(packed, array, allow_pickle=False)
    return packed.getvalue()


def _npz(arrays: Mapping[str, Any]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_STORED) as archive:
        for name, array in arrays.items():
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), _npy(array))
    return packed.getvalue()
