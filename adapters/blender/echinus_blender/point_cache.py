"""PC2 files, which the Mesh Cache modifier reads. This file does not need Blender."""

import os
import pathlib
import struct

import numpy as np


def write_point_cache(path, samples):
    """Writes one sample per frame. The file is written atomically; missing folders are created.

    Parameters
    ----------
    samples : (sample_count, vertex_count, 3)
    """
    samples = np.ascontiguousarray(samples, "<f4")
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(path.name + ".unfinished")
    try:
        with open(unfinished, "wb") as file:
            # signature, version, vertices, first frame, frames from one sample to the next, samples
            file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, samples.shape[1], 0, 1, samples.shape[0]))
            file.write(samples.tobytes())
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)
