# SPDX-License-Identifier: Apache-2.0
"""Lamps as the programs of meters and spreadsheets export them: each function gives a file's name and its bytes.

Written after what the makers' programs export; the files are of our own making.
"""


def number(value, comma=False):
    text = f"{value:.9g}"
    return text.replace(".", ",") if comma else text


def lines(rows, encoding="utf-8", end="\r\n"):
    return (end.join(rows) + end).encode(encoding)


def table(lamp, separator, comma=False, unit=1.0, suffix=""):
    return [f"{number(nm * unit, comma)}{suffix}{separator}{number(v, comma)}" for nm, v in lamp]


def at_interval(lamp, interval):
    return [(nm, value) for nm, value in lamp if nm % interval == 0]


def plain_csv(lamp):
    return "lamp.csv", lines(["wavelength_nm,power", *table(lamp, ",")], end="\n")


def spreadsheet_german(lamp):
    return "lamp.csv", lines(["sep=;", "Wellenlänge (nm);Leistung", *table(lamp, ";", comma=True)])


def latin1_tabs(lamp):
    return "lamp.txt", lines(["Longueur d'onde (nm)\tÉnergie (µW/cm²/nm)", *table(lamp, "\t", comma=True)], "latin-1")


def utf16_little(lamp):
    return "lamp.txt", b"\xff\xfe" + lines(["Wavelength\tPower", "(nm)\t(W/m²/nm)", *table(lamp, "\t")], "utf-16-le")


def utf16_big(lamp):
    return "lamp.csv", b"\xfe\xff" + lines(["波長,放射照度", *table(lamp, ",")], "utf-16-be")


def sekonic_c7000(lamp):
    """5 nm, then 1 nm, under the same labels."""
    head = ["Date Saved,15/03/2021 3:44:14 p.m.", "Title,LAMP_001_02°_3262K", "", "Measuring Mode,Ambient",
            "Viewing Angle [°],2", "Tcp [K],3262", "⊿uv,-0.0029", "Illuminance [lx],30.1", "CRI R1,87.6", "SSI1,---", ""]
    labelled = lambda rows: [f"Spectral Data {nm}[nm],{value:.12f}" for nm, value in rows]
    coarse = at_interval(lamp, 5)
    return "lamp.csv", lines([*head, *labelled(coarse), *(["", *labelled(lamp)] if len(lamp) > len(coarse) else [])])


def sekonic_c800_comma(lamp):
    return "lamp.csv", lines(["Titel;Lampe", "Tcp [K];3262", "",
                              *(f"Spectral Data {nm}[nm];{number(v, True)}" for nm, v in lamp)])


def uprtek(lamp):
    head = ["Model Name\tCV600", "Serial Number\t19J00789", "Time\t2021/01/04_23:14:46", "Memo\t", "LUX\t695.154907",
            "CCT\t5198.000000", "Duv\t-0.000620", "R1\t91.651062", "IRR\t2.607891"]
    return "lamp.xls", lines([*head, *table(lamp, "\t", suffix="nm")])


def ocean_spectrasuite(lamp):
    head = ["SpectraSuite Data File", "++++++++++++++++++++++++++++++++++++", "Date: 04-12-2014, 13:04:39", "User: lab",
            "Dark Spectrum Present: Yes", "Integration Time (usec): 100000 (USB2+H00000)", "Spectra Averaged: 1",
            "Boxcar Smoothing: 0", "Number of Sampled Component Spectra: 1", ">>>>>Begin Processed Spectral Data<<<<<"]
    return "lamp.txt", lines([*head, *table(lamp, "\t", comma=True), ">>>>>End Processed Spectral Data<<<<<"])


def oceanview(lamp):
    head = ["Data from lamp_AbsoluteIrradiance_13-04-39-802.txt Node", "", "Date: Fri Jun 13 13:04:39 CEST 2014",
            "User: lab", "Spectrometer: USB2+H14392", "Trigger mode: 0", "Integration Time (sec): 1.000000E-1",
            "Scans to average: 1", "Nonlinearity correction enabled: true", "XAxis mode: Wavelengths",
            f"Number of Pixels in Spectrum: {len(lamp)}", ">>>>>Begin Spectral Data<<<<<"]
    below = [(lamp[0][0] - 2, -6.5), (lamp[0][0] - 1, float("nan"))]
    return "lamp.txt", lines([*head, *table(below, "\t"), *table(lamp, "\t")])


def asensetek(lamp):
    head = ["Lighting Passport,ALP-01", "Date,2019/05/02 10:11:12", "CCT(K),3262", "CRI(Ra),87.5", "λp(nm),608", "",
            "Wavelength(nm),Spectrum(mW/m^2/nm)"]
    return "lamp.csv", lines([*head, *table(lamp, ","), "", "PPFD,0.41", "Flicker,none"])


def konica_minolta_cl500a(lamp):
    """One measurement a row, wavelengths over the columns behind the figures."""
    fields = ["No.", "Data Name", "Date", "Ev[lx]", "x", "y", "Tcp[K]", *(f"{nm}[nm]" for nm, _ in lamp)]
    row = ["1", "lamp", "2019/05/02 10:11:12", "30.08", "0.4159", "0.3889", "3262", *(number(v) for _, v in lamp)]
    return "lamp.csv", lines(["CL-S10w,1.90", "", ",".join(fields), ",".join(row)])


def konica_minolta_cs2000(lamp):
    fields = ["Name", "Lv", *(f"{nm}nm" for nm, _ in lamp)]
    return "lamp.txt", lines(["\t".join(fields), "\t".join(["lamp", "101.2", *(number(v) for _, v in lamp)])])


def cgats_head(lamp, kind):
    return [f"{kind}   ", "", 'DESCRIPTOR "Argyll Spectral power data"', 'ORIGINATOR "Argyll CMS"',
            'CREATED "Thu May 02 10:11:12 2019"', 'MEAS_TYPE "EMISSION"', f'SPECTRAL_BANDS "{len(lamp)}"',
            f'SPECTRAL_START_NM "{lamp[0][0]:.6f}"', f'SPECTRAL_END_NM "{lamp[-1][0]:.6f}"', 'SPECTRAL_NORM "1.000000"']


def argyll_sp(lamp):
    return "lamp.sp", lines([*cgats_head(lamp, "SPECT"), "", f"NUMBER_OF_FIELDS {len(lamp)}", "BEGIN_DATA_FORMAT",
                             " ".join(f"SPEC_{nm}" for nm, _ in lamp), "END_DATA_FORMAT", "", "NUMBER_OF_SETS 1",
                             "BEGIN_DATA", " ".join(number(v) for _, v in lamp) + " ", "END_DATA"], end="\n")


def argyll_ti3(lamp):
    """Sets of patches beside: the one called lamp is asked for."""
    fields = "SAMPLE_ID SAMPLE_LOC RGB_R RGB_G RGB_B XYZ_X XYZ_Y XYZ_Z"
    dark = " ".join("0.01" for _ in lamp)
    return "lamp.ti3:lamp", lines([
        *cgats_head(lamp, "CTI3"), 'DEVICE_CLASS "DISPLAY"', 'COLOR_REP "RGB_XYZ"', "", f"NUMBER_OF_FIELDS {8 + len(lamp)}",
        "BEGIN_DATA_FORMAT", f"{fields} " + " ".join(f"SPEC_{nm}" for nm, _ in lamp), "END_DATA_FORMAT", "",
        "NUMBER_OF_SETS 2", "BEGIN_DATA", f'dark "A1" 0 0 0 0.1 0.1 0.1 {dark}',
        'lamp "A2" 100 100 100 95 100 108 ' + " ".join(number(v) for _, v in lamp), "END_DATA"], end="\n")


def i1profiler(lamp):
    """Sets that go on over several lines."""
    values = [number(v) for _, v in lamp]
    return "lamp.txt", lines(["CGATS.17", 'CREATED "2019-05-02" # by hand', f"NUMBER_OF_FIELDS {2 + len(lamp)}",
                              "BEGIN_DATA_FORMAT", "SAMPLE_ID\tSAMPLE_NAME\t" + "\t".join(f"nm{nm}" for nm, _ in lamp),
                              "END_DATA_FORMAT", "NUMBER_OF_SETS 1", "BEGIN_DATA", '1\t"Key lamp"\t' + "\t".join(values[:9]),
                              "\t".join(values[9:]), "END_DATA"])


def curves_in_rows(lamp):
    other = ",".join("1" for _ in lamp)
    return "lamp.csv:key", lines(["name," + ",".join(str(nm) for nm, _ in lamp),
                                  "key," + ",".join(number(v) for _, v in lamp), f"fill,{other}"])


def units_and_names(lamp):
    return "lamp.csv:2", lines(["Lamp,fill,key", "Wavelength,Power,Power", "(nm),(W/m2/nm),(W/m2/nm)",
                                *(f"{nm},1,{number(v)}" for nm, v in lamp)])


def summary_tail(lamp):
    return "lamp.csv", lines(["Wavelength,Power", *table(lamp, ","), "", "CCT,3262", "Ra,87.5"])


def gnuplot(lamp):
    return "lamp.txt", lines(["# lamp by hand", "# wavelength(um) power", *table(lamp, "  ", unit=1e-3)], end="\n")


def matlab(lamp):
    return "lamp.txt", lines(["% lamp", "% nm  W", *(f"  {row}  % ok" for row in table(lamp, " "))], end="\n")


def assembler_comments(lamp):
    return "lamp.csv", lines(["; lamp", "// by hand", "! not calibrated", *table(lamp, ",")], end="\n")


def angstrom_falling(lamp):
    return "lamp.csv", lines(["Wavelength (Angstrom),Flux", *reversed(table(lamp, ",", unit=10))])


def quoted(lamp):
    return "lamp.csv", lines(['"Wavelength","Power, W","Remark"', *(f'"{nm}","{number(v)}","ok"' for nm, v in lamp)])


def padded_commas(lamp):
    return "lamp.dat", lines([f"{nm:.2f},\t{value:.7E}" for nm, value in lamp])


def avantes(lamp):
    """What was measured stands beside what was made of it; the dark signal is no lamp."""
    rows = [f" {nm:.2f};  {value * 9e3:.3f};  {-14.5 if nm % 2 else 6.333:.3f};  {number(value)}" for nm, value in lamp]
    return "lamp.TXT:Irradiance", lines(
        ["", "Integration time [ms]:  84.900", "Averaging Nr. [scans]: 10", "Smoothing Nr. [pixels]: 1",
         "Data measured with spectrometer [name]: 1501154U1", "Wave   ;Sample   ;Dark     ;Irradiance",
         "[nm]   ;[counts] ;[counts] ;[uWatt/cm2/nm]", "", *rows])


def spectrasuite_japanese(lamp):
    return "lamp.txt", lines(
        ["SpectraSuiteﾃﾞｰﾀﾌｧｲﾙ", "++++++++++++++++++++++++++++++++++++", "日時: Mon Jun 11 14:59:44 JST 2018",
         "ﾀﾞｰｸｽﾍﾟｸﾄﾙ: はい", "分光器: USB4F06998", "Integration Time (usec): 60000 (USB4F06998)",
         "ﾊﾟﾙｽ信号/光源有効: はい (USB4F06998)", ">>>>>Begin Processed Spectral Data<<<<<", *table(lamp, "\t")], "cp932")


FORMATS = [plain_csv, spreadsheet_german, latin1_tabs, utf16_little, utf16_big, sekonic_c7000, sekonic_c800_comma, uprtek,
           ocean_spectrasuite, oceanview, asensetek, konica_minolta_cl500a, konica_minolta_cs2000, argyll_sp, argyll_ti3,
           i1profiler, curves_in_rows, units_and_names, summary_tail, gnuplot, matlab, assembler_comments, angstrom_falling,
           quoted, padded_commas, avantes, spectrasuite_japanese]
