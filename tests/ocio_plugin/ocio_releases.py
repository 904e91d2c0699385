# SPDX-License-Identifier: Apache-2.0
"""A LUT file through the newest OpenColorIO and through an older one, the system's."""

import os
import subprocess
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio

BIN = Path(os.environ["METAMER_BIN"])


def newest(file, pixels):
    transform = ocio.FileTransform(src=str(file), interpolation=ocio.INTERP_BEST)
    processor = ocio.Config.CreateRaw().getProcessor(transform)
    flags = ocio.OptimizationFlags(int(ocio.OPTIMIZATION_DEFAULT) & ~int(ocio.OPTIMIZATION_FAST_LOG_EXP_POW))
    cpu = processor.getOptimizedCPUProcessor(ocio.BIT_DEPTH_F32, ocio.BIT_DEPTH_F32, flags)
    result = pixels.copy()
    cpu.applyRGBA(result)
    return result


def older(file, pixels):
    run = subprocess.run([BIN / "ocio_apply", file], input=pixels.tobytes(), capture_output=True, check=True)
    return np.frombuffer(run.stdout, np.float32).reshape(pixels.shape)
