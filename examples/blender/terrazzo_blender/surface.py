# How large a surface is, from its triangles in space and in UV space, and which size and Mapping fit it. Plain Python
# and NumPy.
import math

import numpy

LARGEST = 32768


class Surface:
    """What triangles say: metres that a step of 1 in U and in V covers, and the part of the UV plane that they use."""

    def __init__(self, metres_per_uv, low, high, stretch):
        self.metres_per_uv = metres_per_uv
        self.low, self.high = low, high
        self.stretch = stretch  # the greatest density over the least, of 5 % to 95 % of the area; 1 if even


def measure(points, uvs):
    """points: (n, 3, 3) triangles in metres, uvs: (n, 3, 2). Raises ValueError with a sentence."""
    points, uvs = numpy.asarray(points, float), numpy.asarray(uvs, float)
    if len(points) == 0:
        raise ValueError("No face of the object has this material.")
    edges = points[:, 1:] - points[:, :1]
    steps = uvs[:, 1:] - uvs[:, :1]
    determinant = steps[:, 0, 0] * steps[:, 1, 1] - steps[:, 0, 1] * steps[:, 1, 0]
    area = numpy.linalg.norm(numpy.cross(edges[:, 0], edges[:, 1]), axis=1) / 2
    usable = (numpy.abs(determinant) > 1e-12) & (area > 1e-12)
    if not usable.any():
        raise ValueError("The object has no usable UV map: unwrap it first (in Edit Mode: UV > Unwrap).")
    edges, steps, determinant, area = edges[usable], steps[usable], determinant[usable], area[usable]
    along_u = (edges[:, 0] * steps[:, 1, 1:] - edges[:, 1] * steps[:, 0, 1:]) / determinant[:, None]
    along_v = (edges[:, 1] * steps[:, 0, :1] - edges[:, 0] * steps[:, 1, :1]) / determinant[:, None]
    lengths = numpy.stack([numpy.linalg.norm(along_u, axis=1), numpy.linalg.norm(along_v, axis=1)], axis=1)
    mean = (lengths * area[:, None]).sum(axis=0) / area.sum()
    density = numpy.sqrt(lengths[:, 0] * lengths[:, 1])
    order = numpy.argsort(density)
    share = numpy.cumsum(area[order]) / area.sum()
    least, most = (density[order][min(numpy.searchsorted(share, s), len(order) - 1)] for s in (0.05, 0.95))
    used = uvs[usable].reshape(-1, 2)
    return Surface(tuple(mean), tuple(used.min(axis=0)), tuple(used.max(axis=0)), float(most / least))


class Fit:
    """size in pixels, Scale and Location of the Mapping node, whether the result repeats, and notes."""

    def __init__(self, size, scale, offset, repeats, notes):
        self.size, self.scale, self.offset, self.repeats, self.notes = size, scale, offset, repeats, notes


def fit(surface, pixels_per_metre, most=8192):
    """The result that covers all of the surface once; of at most `most` pixels a side: then it repeats."""
    size, scale, notes, repeats = [], [], [], False
    for low, high, metres in zip(surface.low, surface.high, surface.metres_per_uv):
        wanted = math.ceil((high - low) * metres * pixels_per_metre)
        size.append(max(1, min(wanted, most, LARGEST)))
        repeats |= size[-1] < wanted
        scale.append(metres * pixels_per_metre / size[-1])
    if repeats:
        covers = " x ".join(f"{s / pixels_per_metre:.3g}" for s in size)
        notes.append(f"The surface needs more than {most} pixels a side: the result covers {covers} m and repeats.")
    if surface.stretch > 1.5:
        notes.append(f"The UVs are stretched: pixels per metre differ by a factor of {surface.stretch:.1f} on the object.")
    offset = tuple(-low * s for low, s in zip(surface.low, scale))
    return Fit(tuple(size), tuple(scale), offset, repeats, notes)


def density_now(surface, exemplar_pixels, repeats):
    """The pixels per metre that the object shows now, with the exemplar repeated over the uv square."""
    return max(1.0, float(numpy.mean([p * r / m for p, r, m in zip(exemplar_pixels, repeats, surface.metres_per_uv)])))


def scale_of(size, exemplar_pixels, repeats):
    """Scale of the Mapping node with which a result of a size shows its features as large as before."""
    return tuple(r * p / s for r, p, s in zip(repeats, exemplar_pixels, size))
