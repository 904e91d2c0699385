# SPDX-License-Identifier: Apache-2.0
"""Times that a shared machine cannot spoil: calls take turns, and medians are compared."""

import os
import platform
import statistics
import time
from pathlib import Path

import numpy as np


def interleaved(calls, rounds):
    """Seconds of each call, the calls taking turns: {name: array of `rounds`}."""
    seconds = {name: [] for name in calls}
    for call in calls.values():
        call()
    for _ in range(rounds):
        for name, call in calls.items():
            start = time.perf_counter()
            call()
            seconds[name].append(time.perf_counter() - start)
    return {name: np.array(values) for name, values in seconds.items()}


def interleaved_medians(calls, rounds):
    return {name: float(np.median(values)) for name, values in interleaved(calls, rounds).items()}


def spread(values):
    """Half the interquartile range over the median: what noise did to a time."""
    low, middle, high = np.percentile(values, (25, 50, 75))
    return float((high - low) / (2 * middle))


def exponent(sizes, costs):
    """Slope of log cost over log size: cost grows as size to this power."""
    return float(np.polyfit(np.log(sizes), np.log(costs), 1)[0])


def median_seconds(call, rounds):
    seconds = []
    for _ in range(rounds):
        start = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - start)
    return statistics.median(seconds)


def machine():
    model = next((line.split(":")[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines()
                  if line.startswith("model name")), platform.processor())
    return f"{model}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"
