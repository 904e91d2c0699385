# SPDX-License-Identifier: Apache-2.0
"""Runs every look, named transform and view of a config, in the newest OpenColorIO and in an older one, the system's."""

import os
import subprocess
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio

# The probes of ocio_run_config.cpp.
PROBES = np.array([
    [0.18, 0.18, 0.18], [8.0, 6.0, 5.0], [0.002, 0.003, 0.001], [0.5, 0.1, 0.05], [0.05, 0.3, 0.6], [0.4, 0.3, -0.01],
], np.float32)
FLAGS = ocio.OptimizationFlags(int(ocio.OPTIMIZATION_DEFAULT) & ~int(ocio.OPTIMIZATION_FAST_LOG_EXP_POW))


def older(config):
    """(kind, name) to what the probes become; raises with OCIO's message."""
    program = Path(os.environ["METAMER_BIN"]) / "ocio_run_config"
    run = subprocess.run([program, str(config)], capture_output=True, text=True, timeout=600)
    if run.returncode != 0:
        raise AssertionError(f"{config}: {run.stderr}")
    results = {}
    for line in run.stdout.splitlines():
        kind, name, *colours = line.split("\t")
        results[kind, name] = np.array([[float(x) for x in colour.split()] for colour in colours])
    return results


def through(processor):
    cpu = processor.getOptimizedCPUProcessor(ocio.BIT_DEPTH_F32, ocio.BIT_DEPTH_F32, FLAGS)
    pixels = PROBES.copy()
    cpu.applyRGB(pixels)
    shader = ocio.GpuShaderDesc.CreateShaderDesc(language=ocio.GPU_LANGUAGE_GLSL_4_0)
    processor.getDefaultGPUProcessor().extractGpuShaderInfo(shader)
    assert "OCIOMain" in shader.getShaderText()
    return pixels


def newest(config_file):
    """The same with the newest release."""
    config = ocio.Config.CreateFromFile(str(config_file))
    config.validate()
    results = {}

    def run(kind, name, processor):
        results[kind, name] = through(processor)

    for name in config.getLookNames():
        look = ocio.LookTransform(src="aces_interchange", dst="aces_interchange", looks=name)
        run("look", name, config.getProcessor(look))
    for name in config.getNamedTransformNames():
        named = config.getNamedTransform(name)
        forward = named.getTransform(ocio.TRANSFORM_DIR_FORWARD) is not None
        run("named transform", name, config.getProcessor(named.getTransform(
            ocio.TRANSFORM_DIR_FORWARD if forward else ocio.TRANSFORM_DIR_INVERSE)))
    for display in config.getDisplays():
        for view in config.getViews(display):
            transform = ocio.DisplayViewTransform(src=ocio.ROLE_SCENE_LINEAR, display=display, view=view)
            run("view", f"{display}, {view}", config.getProcessor(transform))
    return results
