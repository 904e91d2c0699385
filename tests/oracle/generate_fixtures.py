#!/usr/bin/env python3
"""Write the expected values of the C++ tests, computed by other people's software.

Needs colour-science 0.4.7, scipy 1.17 and opencolorio 2.6. Nothing of metamer is used except the numbers in data/
that colour-science also carries, which it reads from its own copy. Random input is seeded, so that two runs agree.
"""

from __future__ import annotations

import argparse
import os
import sys
import warnings
from importlib import metadata
from pathlib import Path
from typing import Any, Iterable

# NumPy's sums differ in their last digits with the number of its threads.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np  # noqa: E402

FOLDER = Path(__file__).resolve().parent
PINNED = {"colour-science": "0.4.7", "opencolorio": "2.6.0"}
SEED = 20220808

# CODATA 2018 second radiation constant in m K; colour-science's own default is rounded to 1.4388e-2.
C2 = 6.62607015e-34 * 299792458.0 / 1.380649e-23
DOMAIN = np.arange(380.0, 781.0)
LIGHTS = ("A", "D65", "FL11", "HP1")
OBSERVERS = {
    "CIE 1931 2": "CIE 1931 2 Degree Standard Observer",
    "CIE 1964 10": "CIE 1964 10 Degree Standard Observer",
}
SPACES = {
    "ACEScg": "ACEScg",
    "ACES2065-1": "ACES2065-1",
    "Rec.709": "ITU-R BT.709",
    "P3-D65": "P3-D65",
    "Rec.2020": "ITU-R BT.2020",
    "ARRI Wide Gamut 3": "ARRI Wide Gamut 3",
    "ARRI Wide Gamut 4": "ARRI Wide Gamut 4",
    "S-Gamut3": "S-Gamut3",
    "S-Gamut3.Cine": "S-Gamut3.Cine",
    "V-Gamut": "V-Gamut",
    "REDWideGamutRGB": "REDWideGamutRGB",
    "Canon Cinema Gamut": "Cinema Gamut",
    "DaVinci Wide Gamut": "DaVinci Wide Gamut",
}
CATS = {"vonkries": "Von Kries", "bradford": "Bradford", "cat02": "CAT02", "cat16": "CAT16"}
# Styles with a curve or gamut of ours, and the encoding, the linear space and the adaptation to ACES white they use.
OCIO_STYLES = {
    "ACEScct_to_ACES2065-1": "ACEScct,cat02",
    "ARRI_ALEXA-LOGC-EI800-AWG_to_ACES2065-1": "ARRI LogC3,cat02",
    "ARRI_LOGC4_to_ACES2065-1": "ARRI LogC4,cat02",
    "SONY_SLOG3-SGAMUT3_to_ACES2065-1": "S-Log3 S-Gamut3,cat02",
    "SONY_SLOG3-SGAMUT3.CINE_to_ACES2065-1": "S-Log3 S-Gamut3.Cine,cat02",
    "PANASONIC_VLOG-VGAMUT_to_ACES2065-1": "V-Log V-Gamut,bradford",
    "RED_LOG3G10-RWG_to_ACES2065-1": "Log3G10 REDWideGamutRGB,bradford",
    "CANON_CLOG2-CGAMUT_to_ACES2065-1": "Canon Log 2 Cinema Gamut,cat02",
    "CANON_CLOG3-CGAMUT_to_ACES2065-1": "Canon Log 3 Cinema Gamut,cat02",
}

Rows = Iterable[Iterable[Any]]


def generator(salt: int) -> np.random.Generator:
    """Return a random generator of its own for each fixture, so that a change of one leaves the others alone."""
    return np.random.Generator(np.random.PCG64([SEED, salt]))


def cell(value: Any) -> str:
    """Return text as it is and a number so that it reads back as the same double."""
    return value if isinstance(value, str) else repr(float(value))


def write(folder: Path, name: str, by: str, columns: str, rows: Rows) -> None:
    """Write one fixture."""
    lines = [f"# generate_fixtures.py with {by}", columns]
    lines += [",".join(cell(value) for value in row) for row in rows]
    (folder / name).write_text("\n".join(lines) + "\n", encoding="utf-8")


def on_domain(colour: Any, distribution: Any) -> Any:
    """Return a distribution on the 1 nm domain: linear between samples, zero outside."""
    values = np.interp(DOMAIN, distribution.wavelengths, distribution.values, left=0, right=0)
    return colour.SpectralDistribution(values, DOMAIN)


def observer_on_domain(colour: Any, name: str) -> Any:
    """Return colour matching functions cropped to the 1 nm domain."""
    functions = colour.MSDS_CMFS[OBSERVERS[name]].copy()
    return functions.trim(colour.SpectralShape(380, 780, 1))


def write_tristimulus(colour: Any, folder: Path, by: str) -> None:
    """Write random reflectances and what they integrate to."""
    random = generator(1)
    wavelengths = np.arange(400.0, 731.0, 10.0)  # inside the domain, so that holding the end values is tested too
    reflectances = np.round(random.random((len(wavelengths), 12)), 6)
    names = [f"r{k}" for k in range(reflectances.shape[1])]
    write(
        folder,
        "reflectances.csv",
        by,
        "wavelength_nm," + ",".join(names),
        ([w, *row] for w, row in zip(wavelengths, reflectances)),
    )
    rows = []
    for light in LIGHTS:
        illuminant = on_domain(colour, colour.SDS_ILLUMINANTS[light])
        for observer in OBSERVERS:
            functions = observer_on_domain(colour, observer)
            for k, name in enumerate(names):
                # Constant beyond the ends.
                sampled = np.interp(DOMAIN, wavelengths, reflectances[:, k])
                xyz = (
                    colour.sd_to_XYZ(
                        colour.SpectralDistribution(sampled, DOMAIN),
                        functions,
                        illuminant,
                        method="Integration",
                    )
                    / 100
                )
                rows.append([light, observer, name, *xyz, *colour.XYZ_to_xy(xyz)])
    write(folder, "tristimulus.csv", by, "light,observer,reflectance,X,Y,Z,x,y", rows)


def write_lab(colour: Any, folder: Path, by: str) -> None:
    """Write CIELAB and u'v' of random tristimuli, a few of them negative."""
    random = generator(2)
    rows = []
    for white in ((0.31270, 0.32900), (0.34567, 0.35850), (0.44758, 0.40745)):
        for xyz in np.round(random.uniform(-0.02, 1.2, (40, 3)) ** 3, 9):
            uv = colour.xy_to_Luv_uv(colour.XYZ_to_xy(xyz))
            rows.append([*white, *xyz, *colour.XYZ_to_Lab(xyz, white), *uv])
    write(folder, "lab.csv", by, "white_x,white_y,X,Y,Z,L,a,b,u,v", rows)


def write_delta_e(colour: Any, folder: Path, by: str) -> None:
    """Write CIEDE2000 of random pairs: near, far, and neutral."""
    random = generator(3)
    first = np.column_stack([random.uniform(0, 100, 240), random.uniform(-128, 128, (240, 2))])
    step = np.repeat([0.5, 5.0, 150.0], 80)[:, None]
    second = first + step * random.uniform(-1, 1, (240, 3))
    first[::40, 1:] = 0
    first, second = np.round(first, 4), np.round(second, 4)
    rows = ([*a, *b, colour.delta_E(a, b, method="CIE 2000")] for a, b in zip(first, second))
    write(folder, "delta_e_2000.csv", by, "L1,a1,b1,L2,a2,b2,dE", rows)


def write_adaptation(colour: Any, folder: Path, by: str) -> None:
    """Write random tristimuli adapted from one random white to another."""
    random = generator(4)
    rows = []
    for name, transform in CATS.items():
        for _ in range(25):
            whites = [colour.xy_to_XYZ(np.round(random.uniform(0.28, 0.45, 2), 6)) for _ in range(2)]
            xyz = np.round(random.uniform(0, 1, 3), 6)
            matrix = colour.adaptation.matrix_chromatic_adaptation_VonKries(*whites, transform=transform)
            rows.append([name, *whites[0], *whites[1], *xyz, *(matrix @ xyz)])
    columns = "cat,Xs,Ys,Zs,Xd,Yd,Zd,X,Y,Z,Xa,Ya,Za"
    write(folder, "chromatic_adaptation.csv", by, columns, rows)


def write_spaces(colour: Any, folder: Path, by: str) -> None:
    """Write the matrices of the RGB spaces, derived from primaries and white."""
    rows = []
    for ours, theirs in SPACES.items():
        space = colour.RGB_COLOURSPACES[theirs].copy()
        space.use_derived_transformation_matrices(True)
        rows.append([ours, *space.matrix_RGB_to_XYZ.ravel(), *space.matrix_XYZ_to_RGB.ravel()])
    columns = [f"{way}{i}{j}" for way in ("to", "from") for i in range(3) for j in range(3)]
    write(folder, "rgb_spaces.csv", by, "space," + ",".join(columns), rows)


def log_curves(colour: Any) -> dict[str, tuple[Any, Any]]:
    """Return the log curves of colour-science by our names: encoding and decoding."""
    m = colour.models
    return {
        "ACEScct": (m.log_encoding_ACEScct, m.log_decoding_ACEScct),
        "LogC3": (m.log_encoding_ARRILogC3, m.log_decoding_ARRILogC3),
        "LogC4": (m.log_encoding_ARRILogC4, m.log_decoding_ARRILogC4),
        "S-Log3": (m.log_encoding_SLog3, m.log_decoding_SLog3),
        "V-Log": (m.log_encoding_VLog, m.log_decoding_VLog),
        "Log3G10": (m.log_encoding_Log3G10, m.log_decoding_Log3G10),
        "Canon Log 2": (m.log_encoding_CanonLog2, m.log_decoding_CanonLog2),
        "Canon Log 3": (m.log_encoding_CanonLog3, m.log_decoding_CanonLog3),
        "DaVinci Intermediate": (m.oetf_DaVinciIntermediate, m.oetf_inverse_DaVinciIntermediate),
    }


def write_log_encodings(colour: Any, folder: Path, by: str) -> None:
    """Write both directions of the log curves, dense about the cuts and below zero."""
    random = generator(5)
    rows = []
    for name, (encode, decode) in log_curves(colour).items():
        linear = np.concatenate([random.uniform(-0.05, 0.05, 40), 60 * random.random(40) ** 4])
        linear = np.round(np.append(linear, [0.0, 0.18, -0.05, 60.0]), 9)
        signal = np.round(random.uniform(-0.1, 1.0, 60), 9)
        rows += [[name, "encode", x, encode(x)] for x in linear]
        rows += [[name, "decode", s, decode(s)] for s in signal]
    write(folder, "log_encodings.csv", by, "encoding,way,in,out", rows)


def write_similarity(colour: Any, folder: Path, by: str) -> None:
    """Write the spectral similarity index of pairs of illuminants, unrounded and as reported."""
    names = ("A", "C", "D50", "D65", "FL2", "FL11", "HP1", "LED-B3", "LED-RGB1", "ISO 7589 Studio Tungsten")
    rows = []
    for light in names:
        for reference in names:
            pair = (colour.SDS_ILLUMINANTS[light], colour.SDS_ILLUMINANTS[reference])
            index = colour.spectral_similarity_index
            rows.append([light, reference, index(*pair, round_result=False), index(*pair)])
    write(folder, "spectral_similarity.csv", by, "light,reference,index,rounded", rows)


def write_radiators(colour: Any, folder: Path, by: str) -> None:
    """Write blackbodies and daylights, 1 at 560 nm."""
    wavelengths = np.arange(360.0, 831.0, 10.0)
    rows = []
    for kelvin in (500, 1000, 2700, 3200, 5600, 6504, 12000, 100000):
        radiance = colour.colorimetry.planck_law(wavelengths * 1e-9, kelvin, c2=C2)
        reference = colour.colorimetry.planck_law(560e-9, kelvin, c2=C2)
        rows += [[kelvin, w, r / reference] for w, r in zip(wavelengths, radiance)]
    write(folder, "blackbody.csv", by, "kelvin,wavelength_nm,power", rows)
    rows = []
    for kelvin in (4000, 5003, 5600, 6504, 7000, 7001, 9300, 25000):
        xy = colour.temperature.CCT_to_xy_CIE_D(kelvin)
        light = colour.sd_CIE_illuminant_D_series(xy)
        rows += [[kelvin, w, light[w] / light[560.0]] for w in wavelengths]
    write(folder, "daylight.csv", by, "kelvin,wavelength_nm,power", rows)


def locus_uv(functions: np.ndarray, mired: complex) -> np.ndarray:
    """Return CIE 1960 u, v of a blackbody; a complex argument carries the derivative in its imaginary part."""
    power = 1 / (DOMAIN**5 * (np.exp(C2 * 1e9 * mired * 1e-6 / DOMAIN) - 1))
    x, y, z = functions.T @ (power / abs(power[180]))
    return np.array([4 * x, 6 * y]) / (x + 15 * y + 3 * z)


def nearest_mired(functions: np.ndarray, uv: np.ndarray) -> float:
    """Return the nearest blackbody: scipy's bounded minimum, then the root of the distance's derivative about it."""
    from scipy.optimize import brentq, minimize_scalar

    grid = np.linspace(10, 1000, 500)
    distances = [np.sum((locus_uv(functions, m) - uv) ** 2) for m in grid]
    about = grid[int(np.argmin(distances))]
    bounds = (max(10.0, about - 4), min(1000.0, about + 4))
    least = minimize_scalar(
        lambda m: np.sum((locus_uv(functions, m) - uv) ** 2), bounds=bounds, method="bounded", options={"xatol": 1e-9}
    ).x

    def slope(mired: float) -> float:
        stepped = locus_uv(functions, mired + 1e-20j)
        return float(np.sum((stepped.real - uv) * stepped.imag) / 1e-20)

    return brentq(slope, least - 1e-2, least + 1e-2, xtol=1e-13, rtol=1e-15)


def write_temperatures(colour: Any, folder: Path, by: str) -> None:
    """Write correlated colour temperatures by direct minimisation, and by Ohno's 2013 method."""
    random = generator(6)
    curves = observer_on_domain(colour, "CIE 1931 2")
    functions = curves.values
    rows = []
    for _ in range(60):
        mired = 10 ** random.uniform(np.log10(45), np.log10(700))
        duv = random.uniform(-0.02, 0.02)
        stepped = locus_uv(functions, mired + 1e-20j)
        tangent = stepped.imag / np.linalg.norm(stepped.imag)
        normal = np.array([-tangent[1], tangent[0]])
        normal *= np.sign(normal[1])
        u, v = stepped.real + duv * normal
        xyz = np.round([3 * u / (2 * v), 1.0, (4 - u - 10 * v) / (2 * v)], 12)
        total = xyz[0] + 15 * xyz[1] + 3 * xyz[2]
        uv = np.array([4 * xyz[0], 6 * xyz[1]]) / total
        nearest = nearest_mired(functions, uv)
        offset = uv - locus_uv(functions, nearest).real
        ohno = colour.temperature.uv_to_CCT_Ohno2013(uv, curves)
        rows.append([*xyz, 1e6 / nearest, np.sign(offset[1]) * np.linalg.norm(offset), *ohno])
    write(folder, "cct.csv", by, "X,Y,Z,cct_direct,duv_direct,cct_ohno,duv_ohno", rows)


def write_ocio(folder: Path) -> None:
    """Write OpenColorIO's built-in camera transforms at random log pixels."""
    import PyOpenColorIO as ocio

    random = generator(7)
    config = ocio.Config.CreateRaw()
    rows = []
    for style, ours in OCIO_STYLES.items():
        processor = config.getProcessor(ocio.BuiltinTransform(style))
        cpu = processor.getOptimizedCPUProcessor(ocio.OPTIMIZATION_NONE)
        for signal in random.uniform(0.0, 0.8, (20, 3)).astype(np.float32):
            rows.append([style, *ours.split(","), *signal, *cpu.applyRGB(signal.tolist())])
    by = f"OpenColorIO {ocio.__version__}"
    write(folder, "ocio_builtins.csv", by, "style,space,cat,r,g,b,R,G,B", rows)


def generate(folder: Path) -> None:
    """Write every fixture into a folder."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import colour

        by = f"colour-science {colour.__version__}"
        for write_fixture in (
            write_tristimulus,
            write_lab,
            write_delta_e,
            write_adaptation,
            write_spaces,
            write_log_encodings,
            write_similarity,
            write_radiators,
            write_temperatures,
        ):
            write_fixture(colour, folder, by)
        write_ocio(folder)
    write_bounded_engine(folder)


def write_bounded_engine(folder: Path) -> None:
    """Write colours through the transform as bounded_engine.py has it."""
    sys.path.insert(0, str(FOLDER))
    import bounded_engine

    write(folder, "bounded_engine.csv", "bounded_engine.py", bounded_engine.COLUMNS, bounded_engine.rows(generator(18)))


def missing_package() -> str | None:
    """Return what to install where a pinned package is missing or of another version."""
    for name, version in PINNED.items():
        try:
            found = metadata.version(name)
        except metadata.PackageNotFoundError:
            found = None
        if found != version:
            return f"{name}=={version}"
    return None


def main() -> int:
    """Write the fixtures into the folder of this file or the one asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=FOLDER)
    arguments = parser.parse_args()
    if missing := missing_package():
        print(f"generate_fixtures.py: needs {missing}; install it with pip", file=sys.stderr)
        return 1
    generate(arguments.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
