# SPDX-License-Identifier: Apache-2.0
"""The engine and its map behind their C interface (door.cpp, engine_door.cpp)."""

import ctypes

import numpy as np

_DOUBLE, _SIZE, _HANDLE, _TEXT, _INT = ctypes.c_double, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int


def _pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


def _rows(array):
    return np.ascontiguousarray(array, np.float64).reshape(-1, 3)


class Door:
    """The library, with the session that holds one pair of lights: map, exact engine, converged engine, probes."""

    def __init__(self, path):
        self.library = ctypes.CDLL(str(path))
        signatures = {
            "metamerOpen": (_HANDLE, [_TEXT, _TEXT, _TEXT]), "metamerClose": (None, [_HANDLE]),
            "metamerBuildSeconds": (_DOUBLE, [_HANDLE]), "metamerProbes": (_SIZE, [_HANDLE, _HANDLE]),
            "metamerMap": (None, [_HANDLE, _HANDLE, _HANDLE, _SIZE]),
            "metamerCopy": (None, [_HANDLE, _HANDLE, _SIZE]),
            "metamerExact": (None, [_HANDLE, _HANDLE, _HANDLE, _SIZE, _INT]),
            "metamerDeltaE": (None, [_HANDLE, _HANDLE, _HANDLE, _HANDLE, _SIZE]),
            "metamerTimeSolves": (None, [_TEXT, _INT, _INT, _HANDLE, _SIZE, _HANDLE]),
            "metamerEngine": (_HANDLE, [_TEXT, _TEXT, _INT, _TEXT, _TEXT, _DOUBLE]), "metamerEngineClose": (None, [_HANDLE]),
            "metamerRecipeEngine": (_HANDLE, [_TEXT, _INT]),
            "metamerEngineApply": (_DOUBLE, [_HANDLE, _HANDLE, _HANDLE, _SIZE]),
            "metamerEngineDiagnostics": (None, [_HANDLE, _HANDLE]),
            "metamerObserverDiagnostics": (_INT, [_TEXT, _TEXT, _HANDLE]),
            "metamerEngineLargestGain": (_DOUBLE, [_HANDLE, _HANDLE, _SIZE]),
            "metamerKnown": (None, [_HANDLE, _TEXT, _TEXT, _HANDLE, _SIZE, _HANDLE, _HANDLE]),
            "metamerEngineFolds": (_DOUBLE, [_HANDLE, _HANDLE, _SIZE]),
            "metamerBuildMap": (_HANDLE, [_HANDLE, _DOUBLE]), "metamerMapClose": (None, [_HANDLE]),
            "metamerMapSize": (None, [_HANDLE, _HANDLE]),
            "metamerMapApply": (None, [_HANDLE, _HANDLE, _HANDLE, _SIZE]),
            "metamerMapEvaluate": (None, [_HANDLE, _INT, _HANDLE, _HANDLE, _SIZE]),
            "metamerTargets": (ctypes.c_int64, []), "metamerTargetName": (_TEXT, [ctypes.c_int64]),
            "metamerUseTarget": (None, [ctypes.c_int64]),
        }
        for name, (result, arguments) in signatures.items():
            function = getattr(self.library, name)
            function.restype, function.argtypes = result, arguments

    def open(self, source, destination, scene="smooth"):
        return self.library.metamerOpen(source.encode(), destination.encode(), scene.encode())

    def close(self, handle):
        self.library.metamerClose(handle)

    def probes(self, handle):
        """Colours of the error protocol at stop 0."""
        rgb = np.empty((self.library.metamerProbes(handle, None), 3))
        self.library.metamerProbes(handle, _pointer(rgb))
        return rgb

    def exact(self, handle, rgb, converged):
        rgb = _rows(rgb)
        result = np.empty_like(rgb)
        self.library.metamerExact(handle, _pointer(rgb), _pointer(result), len(rgb), int(converged))
        return result

    def map(self, handle, source, destination):
        self.library.metamerMap(handle, _pointer(source), _pointer(destination), source.size // 4)

    def copy(self, source, destination):
        self.library.metamerCopy(_pointer(source), _pointer(destination), source.size // 4)

    def observer_diagnostics(self, observer, light):
        """Condition number, relaxation and gain of an observer under a light; None where the engine refuses them."""
        three = np.empty(3)
        if not self.library.metamerObserverDiagnostics(observer.encode(), light.encode(), _pointer(three)):
            return None
        return {"condition": three[0], "relaxation": three[1], "matrix_gain": three[2]}

    def delta_e(self, handle, a, b):
        a, b = _rows(a), _rows(b)
        result = np.empty(len(a))
        self.library.metamerDeltaE(handle, _pointer(a), _pointer(b), _pointer(result), len(a))
        return result

    def time_solves(self, light, bands, upper_bound, xyz):
        """Seconds of each solve; -1 where there is no such spectrum."""
        xyz = _rows(xyz)
        seconds = np.empty(len(xyz))
        self.library.metamerTimeSolves(light.encode(), bands, int(upper_bound), _pointer(xyz), len(xyz),
                                       _pointer(seconds))
        return seconds


class Engine:
    """The exact engine at a number of bands, under a scene, which may have a set or a strength. `refused` where
    it has no meaning for these lights."""

    def __init__(self, door, source, destination, bands, scene="smooth", surfaces="", strength=1.0):
        self.library, self.lights = door.library, (source.encode(), destination.encode())
        self.handle = self.library.metamerEngine(source.encode(), destination.encode(), bands,
                                                 scene.encode(), surfaces.encode(), strength)
        self.refused = self.handle is None

    def __del__(self):
        if self.handle is not None:
            self.library.metamerEngineClose(self.handle)

    def apply(self, rgb):
        """Result and seconds."""
        rgb = _rows(rgb)
        result = np.empty_like(rgb)
        seconds = self.library.metamerEngineApply(self.handle, _pointer(rgb), _pointer(result), len(rgb))
        return result, seconds

    def known(self, reflectances):
        """RGB of known reflectances (rows over 380 ... 780 nm) under the input light, and under the output light."""
        reflectances = np.ascontiguousarray(reflectances, np.float64)
        given, wanted = np.empty((len(reflectances), 3)), np.empty((len(reflectances), 3))
        self.library.metamerKnown(self.handle, *self.lights, _pointer(reflectances), len(reflectances), _pointer(given),
                                  _pointer(wanted))
        return given, wanted

    def diagnostics(self):
        three = np.empty(3)
        self.library.metamerEngineDiagnostics(self.handle, _pointer(three))
        return {"condition": three[0], "relaxation": three[1], "matrix_gain": three[2]}

    def largest_gain(self, rgb):
        rgb = _rows(rgb)
        return self.library.metamerEngineLargestGain(self.handle, _pointer(rgb), len(rgb))

    def folds(self, rgb):
        """Share of colours where the map of chromaticities folds."""
        rgb = _rows(rgb)
        return self.library.metamerEngineFolds(self.handle, _pointer(rgb), len(rgb))


class RecipeEngine(Engine):
    """The exact engine of a recipe's text."""

    def __init__(self, door, recipe, bands):
        self.library = door.library
        self.handle = self.library.metamerRecipeEngine(recipe.encode(), bands)
        self.refused = self.handle is None


class Map:
    """The homogeneous map of an engine."""

    def __init__(self, engine, tolerance):
        self.library, self.engine = engine.library, engine
        self.handle = self.library.metamerBuildMap(engine.handle, tolerance)
        three = np.empty(3)
        self.library.metamerMapSize(self.handle, _pointer(three))
        self.build_seconds, self.patches, self.bytes = float(three[0]), int(three[1]), int(three[2])

    def __del__(self):
        self.library.metamerMapClose(self.handle)

    def run(self, source, destination):
        self.library.metamerMapApply(self.handle, _pointer(source), _pointer(destination), source.size // 4)

    def evaluate(self, precision, rgba):
        """The tables in double (64) or long double (80) arithmetic."""
        rgb = np.empty((rgba.size // 4, 3))
        self.library.metamerMapEvaluate(self.handle, precision, _pointer(rgba), _pointer(rgb), len(rgb))
        return rgb


def targets(door):
    """{name: bit} of the instruction sets that can run here."""
    bits = door.library.metamerTargets()
    return {door.library.metamerTargetName(1 << i).decode(): 1 << i for i in range(62) if bits >> i & 1}


def use_target(door, bit):
    """One instruction set alone from now on; 0: the best again."""
    door.library.metamerUseTarget(bit)
