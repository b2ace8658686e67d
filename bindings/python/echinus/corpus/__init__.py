"""Labels for learning: inside or outside, and signed distances, for points around each mesh of a corpus.

``python3 -m echinus label`` labels a folder (docs/labels.md). :func:`sample` gives the samples and labels of one mesh,
:func:`label` labels many, and :func:`verify` checks existing labels.
"""

from echinus.corpus._corpus import Corpus
from echinus.corpus._run import Summary, label
from echinus.corpus._samples import Frame, Refused, Samples, Sampling, sample
from echinus.corpus._sources import find_meshes
from echinus.corpus._verification import verify

__all__ = ["Corpus", "Frame", "Refused", "Samples", "Sampling", "Summary", "find_meshes", "label", "sample", "verify"]
