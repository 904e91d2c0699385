# SPDX-License-Identifier: Apache-2.0
"""The peers: OpenColorIO's own operators over lattices and files, and the pictures that all run on."""

from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio
import skimage

PAIRS = [("D65", "A"), ("D65", "HP1"), ("D65", "FL11"), ("D65", "LED-RGB1"), ("A", "D65"), ("FL11", "D50")]
WIDTH, HEIGHT = 1920, 1080


def photograph(name):
    """A public photograph, cropped to 16:9, resized to 1920x1080, linearised into ACEScg: float32 RGBA."""
    import colour
    from skimage.transform import resize

    picture = skimage.io.imread(Path(skimage.__file__).parent / "data" / f"{name}.png")[..., :3] / 255.0
    height = picture.shape[1] * HEIGHT // WIDTH
    top = (picture.shape[0] - height) // 2
    picture = np.clip(resize(picture[top:top + height], (HEIGHT, WIDTH), order=3), 0, 1)
    linear = colour.RGB_to_RGB(colour.models.eotf_sRGB(picture), "sRGB", "ACEScg", "Bradford")
    return np.ascontiguousarray(np.dstack([linear, np.ones(linear.shape[:2])]), np.float32)


def acescct(linear):
    """ACEScct, Academy S-2016-001."""
    return np.where(linear <= 0.0078125, 10.5402377416545 * linear + 0.0729055341958355,
                    (np.log2(np.maximum(linear, 1e-30)) + 9.72) / 17.52)


def acescct_inverse(signal):
    return np.where(signal <= 0.155251141552511, (signal - 0.0729055341958355) / 10.5402377416545,
                    np.exp2(signal * 17.52 - 9.72))


def acescct_transform(direction):
    transform = ocio.LogCameraTransform([0.0078125] * 3, base=2.0, direction=direction)
    transform.setLogSideSlopeValue([1 / 17.52] * 3)
    transform.setLogSideOffsetValue([9.72 / 17.52] * 3)
    transform.setLinearSlopeValue([10.5402377416545] * 3)
    return transform


def sampled_cube(exact, size, log_out):
    """CPU processor: ACEScct shaper, tetrahedral lattice sampled from `exact`, and the antilog where it holds logs."""
    grid = np.linspace(0, 1, size)
    nodes = acescct_inverse(np.stack(np.meshgrid(grid, grid, grid, indexing="ij"), -1).reshape(-1, 3))
    values = exact(nodes)
    lattice = ocio.Lut3DTransform(gridSize=size, interpolation=ocio.INTERP_TETRAHEDRAL)
    lattice.setData((acescct(values) if log_out else values).astype(np.float32).ravel())
    group = ocio.GroupTransform([acescct_transform(ocio.TRANSFORM_DIR_FORWARD), lattice])
    if log_out:
        group.appendTransform(acescct_transform(ocio.TRANSFORM_DIR_INVERSE))
    return cpu_processor(group)


def matrix(exact):
    """The one matrix that is exact for colours near neutral."""
    near = np.full((3, 3), 0.18) + 0.001 * np.eye(3)
    padded = np.eye(4)
    padded[:3, :3] = np.linalg.solve(near, exact(near)).T
    return cpu_processor(ocio.MatrixTransform(padded.ravel().tolist()))


def file_processor(path, log_in_out):
    """A LUT file of ours; `log_in_out`: one that takes and gives ACEScct, run here from linear to linear."""
    file = ocio.FileTransform(str(path), interpolation=ocio.INTERP_BEST)
    if not log_in_out:
        return cpu_processor(file)
    return cpu_processor(ocio.GroupTransform([acescct_transform(ocio.TRANSFORM_DIR_FORWARD), file,
                                              acescct_transform(ocio.TRANSFORM_DIR_INVERSE)]))


def cpu_processor(transform):
    return ocio.Config.CreateRaw().getProcessor(transform).getOptimizedCPUProcessor(
        ocio.BIT_DEPTH_F32, ocio.BIT_DEPTH_F32, ocio.OPTIMIZATION_DEFAULT)


def run_ocio(processor, source, destination):
    height, width = source.shape[:2]
    processor.apply(ocio.PackedImageDesc(source, width, height, 4), ocio.PackedImageDesc(destination, width, height, 4))


def protocol_error(door, handle, run, stops=range(-10, 11), keep=None):
    """Error protocol of a candidate: mean, p99, max CIEDE2000. `keep`: which probes, by their colours."""
    probes = door.probes(handle)
    if keep is not None:
        probes = probes[keep(probes)]
    expected = door.exact(handle, probes, converged=True)
    errors = []
    for stop in stops:
        source = np.ones((1, len(probes), 4), np.float32)
        source[0, :, :3] = probes * 2.0 ** stop
        destination = np.empty_like(source)
        run(source, destination)
        errors.append(door.delta_e(handle, expected, destination[0, :, :3] / 2.0 ** stop))
    errors = np.sort(np.concatenate(errors))
    return {"mean": float(errors.mean()), "p99": float(errors[int(np.ceil(0.99 * len(errors))) - 1]),
            "max": float(errors[-1])}


def protocol_errors(door, handle, run):
    """Over all probes and stops, and inside the gamut within seven stops: what a log cube can hold."""
    return {"all": protocol_error(door, handle, run),
            "inside": protocol_error(door, handle, run, range(-7, 8), lambda p: p.min(axis=1) >= 0)}
