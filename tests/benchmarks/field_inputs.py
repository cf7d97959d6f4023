#!/usr/bin/env python3
"""Tries programs on small files of the kinds that people bring, and compares what they find with the right value.

    field_inputs.py BIN [--only WORD]

Needs numpy and rasterio. Each kind is one function below: it makes its input, runs the program and returns what was
found and whether that is right. Right values come from closed forms, NumPy or the same data in another file. A refusal
is right where no program could know more: status 2 and one line. Prints a row for each kind; exit status 1 if one is
wrong. --only takes the kinds whose words contain WORD.
"""

import contextlib
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import warnings

import numpy as np

from measure import arguments_of, head, row

KINDS = []


def kind(words, right):
    """Adds a kind: its words, its right value in words, and the function that tries it."""

    def add(function):
        KINDS.append((words, right, function))
        return function

    return add


class Tried:
    """What a program did: its exit status, its words, and the figures of its summary."""

    def __init__(self, folder, command, summary):
        run = subprocess.run([str(c) for c in command], cwd=folder, capture_output=True, text=True)
        self.status, self.words = run.returncode, run.stderr + run.stdout
        self.figures = json.loads(summary.read_text()) if summary.exists() else {}
        summary.unlink(missing_ok=True)

    def refused(self, *words):
        """Found and right of a file that must be refused, in one line that has these words."""
        line = self.words.strip()
        good = self.status == 2 and "\n" not in line and all(word in line for word in words)
        return f"status {self.status}: {line[-110:]}", good


class Bench:
    """The programs, and a folder for the files of one kind."""

    def __init__(self, programs, folder):
        self.programs, self.folder = programs, pathlib.Path(folder)

    def path(self, name):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        return self.folder / name

    def write(self, name, content):
        self.path(name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def run(self, program, *arguments):
        summary = self.folder / "summary.json"
        return Tried(self.folder, [self.programs / program, *arguments, "--summary", summary], summary)

    def fit(self, name, *arguments):
        return self.run("fit_gabor", name, "-o", "fitted.json", *arguments)

    def raster(self, name, values, transform=(2, 0, 600000, 0, -2, 4000000), frame="EPSG:32633", **more):
        """Writes a GeoTIFF, or another format by driver=. The transform has the order of an affine matrix."""
        import rasterio

        described = {key: more.pop(key) for key in ("units", "scales", "offsets") if key in more}
        bands = 3 if more.get("driver") == "WEBP" else 1
        options = {"driver": "GTiff", "count": bands, **({"lossless": True} if bands == 3 else {}), **more}
        height, width = values.shape
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with rasterio.open(
                self.path(name), "w", width=width, height=height, dtype=values.dtype, crs=frame,
                transform=rasterio.Affine(*transform) if transform else None, **options) as file:  # fmt: skip
                for band in range(bands):
                    file.write(values, band + 1)
                for key, value in described.items():
                    setattr(file, key, (value,))
        return name


def rock(n, seed, beta=2.0, along=0.0):
    """A field of unit variance with spectrum k^-beta; along > 0 draws ridges along the diagonal."""
    rng = np.random.default_rng(seed)
    f, g = np.fft.fftfreq(n)[:, None], np.fft.fftfreq(n)[None, :]
    k = np.hypot((f + g) / 2**0.5 * (1 + along), (f - g) / 2**0.5)
    k[0, 0] = 1
    s = np.fft.ifft2(np.fft.fft2(rng.normal(size=(n, n))) * k ** (-beta / 2) * (k > 2 / n)).real
    return (s - s.mean()) / s.std()


def ground(n=96, seed=1, rms=7.0):
    """Heights in metres of this standard deviation, about 350."""
    return (350 + rms * rock(n, seed)).astype("f4")


def with_hole(values, mark):
    values = values.copy()
    values[30:50, 30:60] = mark
    return values


def near(value, right, share=0.01):
    return value is not None and abs(value - right) <= share * abs(right) + 1e-12


def heights(tried, rms=None, missing=None, pixel=None, words=()):
    """Found and right of a fitted height map."""
    image = tried.figures.get("image", {})
    found = {"rms": image.get("height_rms"), "missing": image.get("missing"), "pixel": image.get("metres_per_pixel")}
    due = {"rms": rms, "missing": missing, "pixel": pixel}
    good = tried.status == 0 and all(near(found[key], right) for key, right in due.items() if right is not None)
    good = good and all(word in tried.words for word in words)
    if tried.status != 0:
        return tried.refused()[0], False
    return ", ".join(f"{key} {found[key]:.4g}" for key in due if due[key] is not None and found[key] is not None), good


def known_rms(values, mark):
    return float(values[values != mark].astype(float).std())


# --- a raster and what stands beside it -------------------------------------------------------------------------------
ENVI = "ENVI\nsamples = {0}\nlines = {0}\nbands = 1\nheader offset = 0\nfile type = ENVI Standard\ndata type = 1\n\
interleave = bsq\nbyte order = 0\n"
EHDR = "NROWS {0}\nNCOLS {0}\nNBANDS 1\nNBITS 8\nBYTEORDER I\nLAYOUT BIL\n"


def beside_header(bench, driver, name, header):
    values = (np.clip(0.5 + 0.15 * rock(256, 4), 0, 1) * 255).round().astype("u1")
    bench.raster("alone/" + name, values, None, None, driver=driver)
    bench.raster(name, values, None, None, driver=driver)
    bench.write(name.rpartition(".")[0] + ".hdr", header.format(128))
    lobes = [bench.fit(file).figures.get("lobes") for file in ("alone/" + name, name)]
    return f"{lobes[1]} lobes, alone {lobes[0]}", lobes[0] is not None and lobes[0] == lobes[1]


for _driver, _name in (("PNG", "site.png"), ("JPEG", "site.jpg"), ("WEBP", "site.webp")):
    for _words, _header in (("ENVI", ENVI), ("EHdr", EHDR)):
        kind(f"{_driver} beside a foreign header of {_words}", "as alone")(
            lambda bench, d=_driver, n=_name, h=_header: beside_header(bench, d, n, h))


@kind("Arc ASCII grid beside a foreign header of ENVI", "rms 7, pixel 2")
def _(bench):
    values = ground()
    bench.raster("site.asc", values, (2, 0, 5000, 0, -2, 5000), None, driver="AAIGrid")
    bench.write("site.hdr", ENVI.format(64))
    return heights(bench.fit("site.asc"), float(values.std()), pixel=2)


@kind("bytes of another kind beside a header of ENVI that states fewer", "refused")
def _(bench):
    bench.write("site.bmp", b"BM" + bytes(range(256)) * 300)
    bench.write("site.hdr", ENVI.format(128))
    return bench.fit("site.bmp").refused("site.bmp")


@kind("raw bytes of the size that their header of ENVI states", "27 lobes and more")
def _(bench):
    values = (np.clip(0.5 + 0.15 * rock(128, 4), 0, 1) * 255).round().astype("u1")
    bench.write("site.raw", values.tobytes())
    bench.write("site.hdr", ENVI.format(128))
    tried = bench.fit("site.raw")
    return f"{tried.figures.get('lobes')} lobes", tried.status == 0


def pam(*lines):
    return f'<PAMDataset>{lines[0] if len(lines) > 1 else ""}<PAMRasterBand band="1">{lines[-1]}</PAMRasterBand></PAMDataset>'


@kind("no data in .aux.xml", "rms of the rest, 6.5 % missing")
def _(bench):
    values = with_hole(ground(), -100)
    bench.raster("a.tif", values)
    bench.write("a.tif.aux.xml", pam("<NoDataValue>-100</NoDataValue>"))
    return heights(bench.fit("a.tif"), known_rms(values, -100), 600 / 9216)


@kind("a unit in .aux.xml", "rms .3048 times 7")
def _(bench):
    bench.raster("a.tif", ground())
    bench.write("a.tif.aux.xml", pam("<UnitType>ft</UnitType>"))
    return heights(bench.fit("a.tif"), 0.3048 * ground().std())


@kind("scale and offset in .aux.xml", "rms .1 times 70")
def _(bench):
    values = (10 * ground()).round().astype("i2")
    bench.raster("a.tif", values)
    bench.write("a.tif.aux.xml", pam("<Scale>0.1</Scale><Offset>100</Offset>"))
    return heights(bench.fit("a.tif"), 0.1 * values.std())


@kind("frame and pixels in .aux.xml of a .png", "pixel 3")
def _(bench):
    bench.raster("a.png", ground().round().astype("u2"), None, None, driver="PNG")
    bench.write("a.png.aux.xml", pam(
        '<SRS>PROJCS["p",GEOGCS["g",DATUM["d",SPHEROID["s",1737400,0]],PRIMEM["m",0],UNIT["degree",0.0174532925199433]],'
        'PROJECTION["Equirectangular"],UNIT["metre",1]]</SRS><GeoTransform>100, 3, 0, 200, 0, -3</GeoTransform>', ""))
    return heights(bench.fit("a.png"), float(ground().round().std()), pixel=3)


@kind("a folder that cannot be written gets no .aux.xml", "none")
def _(bench):
    bench.raster("a.tif", ground())
    bench.fit("a.tif")
    beside = sorted(file.name for file in bench.folder.glob("*.xml"))
    return str(beside), not beside


# --- no data ---------------------------------------------------------------------------------------------------------
for _floor in (0.0, 9999.0, 32767.0):

    @kind(f"ground at {_floor:g} where the file names -9999 as no data", "nothing missing")
    def _(bench, floor=_floor):
        values = np.where(rock(96, 8, 3) > -0.5, ground(), floor).astype("f4")
        bench.raster("a.tif", values, nodata=-9999)
        tried = bench.fit("a.tif")
        return heights(tried, float(values.astype(float).std()), 0.0)


@kind("-9999 where the file names no value", "missing, with a note")
def _(bench):
    values = with_hole(ground(), -9999)
    bench.raster("a.tif", values)
    return heights(bench.fit("a.tif"), known_rms(values, -9999), 600 / 9216, words=["-9999"])


# --- units of heights ---------------------------------------------------------------------------------------------------
FEET = 1200 / 3937
for _unit, _metres in {
    "US survey foot": FEET, "US survey feet": FEET, "us survey ft": FEET, "U.S. survey foot": FEET, "usft": FEET,
    "Foot_US": FEET, "US_survey_foot": FEET, "survey feet": FEET, "feet": 0.3048, "Feet": 0.3048, "international feet": 0.3048,
    "international foot": 0.3048, "dm": 0.1, "decimetre": 0.1, "decimeters": 0.1, "inch": 0.0254, "inches": 0.0254, "in": 0.0254,
    "yard": 0.9144, "hm": 100.0, "m.": 1.0, "Meters": 1.0, "[m]": 1.0, "km": 1000.0,
}.items():  # fmt: skip

    @kind(f'heights in "{_unit}"', f"7 times {_metres:.6g}")
    def _(bench, unit=_unit, metres=_metres):
        bench.raster("a.tif", ground(), units=unit)
        return heights(bench.fit("a.tif"), metres * ground().std())


@kind('heights in "um"', ".07 of 70000")
def _(bench):
    bench.raster("a.tif", ground(rms=7e4), units="um")
    return heights(bench.fit("a.tif"), 0.07)


@kind("a vertical frame in US survey feet", "7 US survey feet")
def _(bench):
    bench.raster("a.tif", ground(), frame="EPSG:32633+6360")
    return heights(bench.fit("a.tif"), FEET * ground().std())


@kind("a plane in feet, heights without a unit", "said in the first line")
def _(bench):
    bench.raster("a.tif", ground(), frame="EPSG:2225", transform=(3, 0, 6e6, 0, -3, 2e6))
    tried = bench.fit("a.tif")
    found, good = heights(tried, float(ground().std()), pixel=3 * FEET)
    first = tried.words.splitlines()[0]
    return found + "; " + first[-90:], good and "--height-unit" in first


@kind("--height-unit ft", "7 feet")
def _(bench):
    bench.raster("a.tif", ground())
    return heights(bench.fit("a.tif", "--height-unit", "ft"), 0.3048 * ground().std())


@kind("--height-unit of a 16-bit .png with --mm-per-px", "7 cm")
def _(bench):
    bench.raster("a.png", ground().round().astype("u2"), None, None, driver="PNG")
    return heights(bench.fit("a.png", "--height-unit", "cm", "--mm-per-px", "20"), 0.01 * ground().round().std(), pixel=0.02)


# --- the way of rows and columns -----------------------------------------------------------------------------------------
def slopes(power):
    """The correlation of the slopes to the east and to the north of heights with this power spectrum."""
    f, g = np.fft.fftfreq(power.shape[0])[:, None], np.fft.fftfreq(power.shape[1])[None, :]
    x, y = 2 * np.sin(np.pi * g), -2 * np.sin(np.pi * f)
    return float((power * x * y).sum() / np.sqrt((power * x * x).sum() * (power * y * y).sum()))


for _words, _transform, _turn in (
    ("north-up", (2, 0, 0, 0, -2, 9e3), lambda z: z),
    ("south-up", (2, 0, 0, 0, 2, 9e3), lambda z: z[::-1]),
    ("west-running", (-2, 0, 9e3, 0, -2, 9e3), lambda z: z[:, ::-1]),
    ("turned by 180 degrees", (-2, 0, 9e3, 0, 2, 9e3), lambda z: z[::-1, ::-1]),
):

    @kind(f"a {_words} raster of ridges along the diagonal", "slopes correlate as on the ground")
    def _(bench, transform=_transform, turn=_turn):
        z = (7 * rock(256, 3, 3.0, 9.0)).astype("f4")
        due = slopes(np.abs(np.fft.fft2(z)) ** 2)
        bench.raster("a.tif", np.ascontiguousarray(turn(z)), transform=transform, frame=None)
        tried = bench.fit("a.tif", "--spectrum", "a.npy")
        if tried.status != 0:
            return tried.refused()[0], False
        found = slopes(np.load(bench.folder / "a.npy"))
        return f"{found:.2f} of {due:.2f}", abs(found - due) < 0.25 * abs(due)


# --- grids of text, degrees ----------------------------------------------------------------------------------------------
def asc(values, cell, west, south, mark=None):
    rows, columns = values.shape
    lines = [f"ncols {columns}", f"nrows {rows}", f"xllcorner {west}", f"yllcorner {south}", f"cellsize {cell}"]
    lines += [f"NODATA_value {mark}"] if mark is not None else []
    return "\n".join(lines + [" ".join(f"{v:.6g}" for v in r) for r in values]) + "\n"


@kind(".asc with nan in its first row", "rms 7, 1.04 % missing")
def _(bench):
    values = ground()
    values[0] = np.nan
    bench.write("a.asc", asc(values, 2, 5000, 7000))
    return heights(bench.fit("a.asc"), float(np.nanstd(values)), 1 / 96)


@kind(".asc of whole numbers with nan in its first row", "rms 7, 1.04 % missing")
def _(bench):
    values = ground().round()
    values[0] = np.nan
    bench.write("a.asc", asc(values, 2, 5000, 7000))
    return heights(bench.fit("a.asc"), float(np.nanstd(values)), 1 / 96)


@kind(".asc of whole numbers with nan in a later row", "rms 7, .1 % missing, or refused")
def _(bench):
    values = ground().round()
    values[80, :10] = np.nan
    bench.write("a.asc", asc(values, 2, 5000, 7000))
    return heights(bench.fit("a.asc"), float(np.nanstd(values)), 10 / 9216)


@kind(".asc in degrees without .prj", "refused with a word")
def _(bench):
    bench.write("a.asc", asc(ground(), 1 / 3600, 11.2, 46.1))
    return bench.fit("a.asc").refused("degrees")


@kind("GeoTIFF in degrees without a frame", "refused with a word")
def _(bench):
    bench.raster("a.tif", ground(), (1 / 1200, 0, -110.2, 0, -1 / 1200, 35.1), None)
    return bench.fit("a.tif").refused("degrees")


@kind("a scan in metres by .5 mm", "taken in metres")
def _(bench):
    bench.raster("a.tif", ground(rms=0.001), (5e-4, 0, 0.25, 0, -5e-4, 0.25), None)
    return heights(bench.fit("a.tif"), pixel=5e-4)


# --- pixels that are not square --------------------------------------------------------------------------------------------
@kind("an .hgt at 45 degrees north", "rms 7 of square pixels")
def _(bench):
    values = ground(1201).round().astype(">i2")
    bench.write("N45E007.hgt", values.tobytes())
    tried = bench.fit("N45E007.hgt")
    found, good = heights(tried, pixel=92.77)
    rms = tried.figures["image"]["height_rms"] if good else 0  # waves between the Nyquist lengths of x and y are gone
    return found, good and near(rms, float(values.astype(float).std()), 0.04)


@kind("pixels of 2 by 3 m", "rms, and a period of 20 pixels along x and y alike")
def _(bench):
    y, x = np.mgrid[0:128, 0:192]
    values = (5 * np.sin(2 * np.pi * x / 30) + 5 * np.sin(2 * np.pi * y / 20)).astype("f4")
    bench.raster("a.tif", values, (2, 0, 0, 0, -3, 9e3))
    tried = bench.fit("a.tif")
    found, good = heights(tried, 5.0, 0.0, 3.012)  # on the ground; the plane has 3 m
    period = tried.figures.get("period")
    return f"{found}; periods {period}", good and period == {"x_px": 20, "y_px": 20}


@kind("--mm-per-px of two sides", "square pixels")
def _(bench):
    bench.raster("a.tif", ground(), None, None)
    return heights(bench.fit("a.tif", "--mm-per-px", "2000", "--mm-per-px-y", "3000"), pixel=3.0)


# --- arrays of Python --------------------------------------------------------------------------------------------------------
@contextlib.contextmanager
def package():
    import astrolith

    yield astrolith


def array_kind(words, make):
    @kind(f"Python: {words}", "rms of the rest, 6.5 % missing")
    def _(bench):
        try:
            with package() as astrolith:
                fit = astrolith.fit_texture(make())
        except (ImportError, ValueError) as error:
            return str(error)[-110:], False
        rms = float(np.sqrt(sum(channel["variance"] for channel in fit.figures["channels"])))
        due = known_rms(with_hole(ground(), -9999), -9999)
        missing = fit.figures["image"]["missing"]
        return f"rms {rms:.4g}, missing {missing:.3g}", near(rms, due, 0.03) and near(missing, 600 / 9216)


array_kind("a masked array", lambda: np.ma.masked_equal(with_hole(ground(), -9999), -9999))
array_kind("NaN", lambda: with_hole(ground(), np.nan))
array_kind("a masked array of whole numbers", lambda: np.ma.masked_equal(with_hole(ground().round(), -9999).astype("i2"), -9999))
array_kind("a masked array of float64", lambda: np.ma.masked_invalid(with_hole(ground(), np.nan).astype(float)))


# --- further formats ---------------------------------------------------------------------------------------------------------
@kind("VRT of two tiles in its folder", "rms 7")
def _(bench):
    z = ground()
    bench.raster("l.tif", np.ascontiguousarray(z[:, :48]))
    bench.raster("r.tif", np.ascontiguousarray(z[:, 48:]), (2, 0, 600096, 0, -2, 4000000))
    source = '<SimpleSource><SourceFilename relativeToVRT="1">{0}</SourceFilename><SourceBand>1</SourceBand>\
<SrcRect xOff="0" yOff="0" xSize="48" ySize="96"/><DstRect xOff="{1}" yOff="0" xSize="48" ySize="96"/></SimpleSource>'
    bench.write("a.vrt", '<VRTDataset rasterXSize="96" rasterYSize="96"><GeoTransform>600000, 2, 0, 4000000, 0, -2</GeoTransform>\
<VRTRasterBand dataType="Float32" band="1">' + source.format("l.tif", 0) + source.format("r.tif", 48) + "</VRTRasterBand></VRTDataset>")
    return heights(bench.fit("a.vrt"), float(z.std()), pixel=2)


@kind("VRT that names a file elsewhere", "refused")
def _(bench):
    bench.raster("other/l.tif", ground())
    bench.write("sub/a.vrt", '<VRTDataset rasterXSize="96" rasterYSize="96"><VRTRasterBand dataType="Float32" band="1"><SimpleSource>\
<SourceFilename relativeToVRT="1">../other/l.tif</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>')
    return bench.fit("sub/a.vrt").refused("folder")


def netcdf(variables):
    """A netCDF file (classic) of variables {name: (dimensions, values, {attribute: text})}; x and y come first."""
    def word(text):
        return struct.pack(">i", len(text)) + text.encode() + b"\0" * (-len(text) % 4)

    names = [name for name in variables if variables[name][0] == [name]]
    start = b"CDF\1" + struct.pack(">i", 0) + struct.pack(">ii", 10, len(names))
    start += b"".join(word(name) + struct.pack(">i", len(variables[name][1])) for name in names) + struct.pack(">ii", 0, 0)

    def header(offsets):
        made = start + struct.pack(">ii", 11, len(variables))
        for (name, (dimensions, values, attributes)), offset in zip(variables.items(), offsets):
            made += word(name) + struct.pack(">i", len(dimensions))
            made += b"".join(struct.pack(">i", names.index(d)) for d in dimensions) + struct.pack(">ii", 12, len(attributes))
            made += b"".join(word(key) + struct.pack(">i", 2) + word(text) for key, text in attributes.items())
            made += struct.pack(">iii", 6, 8 * np.size(values), offset)
        return made

    at, offsets = len(header([0] * len(variables))), []
    for _, values, _ in variables.values():
        offsets.append(at)
        at += 8 * np.size(values)
    return header(offsets) + b"".join(np.asarray(values, ">f8").tobytes() for _, values, _ in variables.values())


@kind("netCDF .grd, from the south", "rms 7, pixel 2")
def _(bench):
    x, y, z = 5001 + 2.0 * np.arange(96), 7001 + 2.0 * np.arange(96), ground()[::-1]
    bench.write("a.grd", netcdf({"x": (["x"], x, {"long_name": "x", "axis": "X"}), "y": (["y"], y, {"long_name": "y", "axis": "Y"}),
                                 "z": (["y", "x"], z, {"long_name": "z"})}))  # fmt: skip
    return heights(bench.fit("a.grd"), float(z.std()), pixel=2)


@kind("netCDF .grd in degrees without a frame", "refused with a word")
def _(bench):
    x, y, z = 11.2 + np.arange(96) / 3600, 46.1 + np.arange(96) / 3600, ground()[::-1]
    bench.write("a.grd", netcdf({"lon": (["lon"], x, {"units": "degrees_east"}), "lat": (["lat"], y, {"units": "degrees_north"}),
                                 "z": (["lat", "lon"], z, {"units": "m"})}))  # fmt: skip
    return bench.fit("a.grd").refused("degrees")


@kind(".grd of Surfer", "rms 7, pixel 2")
def _(bench):
    z = ground()[::-1]
    bench.write("a.grd", f"DSAA\n96 96\n5001 5191\n7001 7191\n{z.min()} {z.max()}\n" + "\n".join(" ".join(map(str, r)) for r in z))
    return heights(bench.fit("a.grd"), float(z.std()), pixel=2)


for _ending, _type in ((".r16", "<u2"), (".r32", "<f4"), (".raw", "<u2")):

    @kind(f"{_ending} with a stated size", "rms 7, pixel 1")
    def _(bench, ending=_ending, type_=_type):
        z = ground(97)[:96].round().astype(type_)
        bench.write("a" + ending, z.tobytes())
        return heights(bench.fit("a" + ending, "--raw-size", "97x96", "--height-unit", "m", "--mm-per-px", "1000"),
                       float(z.astype(float).std()), pixel=1)  # fmt: skip


@kind(".r16 of another size than stated", "refused")
def _(bench):
    bench.write("a.r16", ground(97)[:96].round().astype("<u2").tobytes())
    return bench.fit("a.r16", "--raw-size", "96x96").refused("a.r16", "96 x 96")


@kind(".r16 without a size", "refused with a word")
def _(bench):
    bench.write("a.r16", ground().round().astype("<u2").tobytes())
    return bench.fit("a.r16").refused("--raw-size")


# --- points that are measured ------------------------------------------------------------------------------------------------
AXES = np.array([1.8, 1.3, 1.0])
ELLIPSOID = 4 / 3 * np.pi * AXES.prod()


def cloud(n=20000, noise=0.0, seed=2, half=False):
    """Points of an ellipsoid, in km; those of half of it have x above 0."""
    rng = np.random.default_rng(seed)
    u = rng.normal(size=(3 * n, 3))
    u /= np.linalg.norm(u, axis=1)[:, None]
    area = np.linalg.norm(u / AXES, axis=1)
    u = u[rng.random(len(u)) < area / area.max()][:n]
    p = u * AXES + noise * rng.normal(size=(len(u), 3))
    n = u / AXES
    keep = p[:, 0] > 0 if half else slice(None)
    return p[keep], (n / np.linalg.norm(n, axis=1)[:, None])[keep]


def rows_of(*columns, separator=" ", first=""):
    return first + "\n".join(separator.join(f"{v:.9g}" for v in r) for r in np.column_stack(columns)) + "\n"


def ply(columns, names):
    header = "ply\nformat binary_little_endian 1.0\n" + f"element vertex {len(columns)}\n"
    header += "".join(f"property float {name}\n" for name in names) + "end_header\n"
    return header.encode() + np.asarray(columns, "<f4").tobytes()


def volume(tried, right=ELLIPSOID, share=0.003, words=()):
    found = tried.figures["body"]["volume_m3"] * 1e-9 if "body" in tried.figures else None
    if tried.status != 0 or found is None:
        return tried.refused()[0], False
    said = " ".join(tried.words.split())[:150]
    return f"{100 * (found / right - 1):+.2f} %; {said}", near(found, right, share) and all(w in tried.words for w in words)


def weigh(bench, name, *arguments):
    return bench.run("gravity", name, "--wrap", "--unit", "km", "--density", "1000", *arguments)


def point_kind(words, name, content):
    @kind(f"points: {words}", "volume within .3 %")
    def _(bench):
        bench.write(name, content())
        return volume(weigh(bench, name))


for _share in (0.003, 0.005, 0.01):

    @kind(f"points: noise of {100 * _share:g} % of the length", "volume within .3 %, noise within 15 %")
    def _(bench, share=_share):
        bench.write("a.xyz", rows_of(cloud(30000, 3.6 * share)[0]))
        tried = weigh(bench, "a.xyz")
        found, good = volume(tried)
        noise = tried.figures.get("repair", {}).get("noise", 0)
        return f"noise {noise / 3.6:.4f} of the length; {found}", good and near(noise, 3.6 * share, 0.15)


def read_ply(file):
    """Vertices and triangles of a binary .ply of the programs."""
    header, _, data = file.read_bytes().partition(b"end_header\n")
    lines = header.decode().splitlines()
    count, faces = (int(line.split()[2]) for line in lines if line.startswith("element"))
    width = sum(line.startswith("property float") for line in lines)
    vertices = np.frombuffer(data, "<f4", count * width).reshape(count, width)[:, :3].astype(float)
    rows = np.frombuffer(data, np.dtype([("n", "u1"), ("corners", "<i4", 3)]), faces, 4 * count * width)
    return vertices, rows["corners"]


def scattered(vertices, faces, count, rng):
    """Places spread evenly over a mesh, and the normals there; and the mesh's volume."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    k = rng.choice(len(faces), count, p=areas / areas.sum())
    u, v = rng.random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    places = a[k] + u * (b - a)[k] + v * (c - a)[k]
    return places, normals[k] / areas[k][:, None], float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6


def distances(places, surface, normals):
    """From places to a surface of many points, along its normals."""
    nearest = np.concatenate([((surface[None] - part[:, None]) ** 2).sum(2).argmin(1) for part in np.array_split(places, 100)])
    return np.einsum("ij,ij->i", places - surface[nearest], normals[nearest])


for _body in ("eros", "bennu", "itokawa", "bacchus", "hygiea", "ida"):
    for _share in (0.003, 0.01):

        @kind(f"points of {_body} with noise of {100 * _share:g} % of the length", "volume within .3 %, distance over noise <= .5")
        def _(bench, body=_body, share=_share):
            bench.run("synth", body, "-o", "true.ply", "--triangles", "60000")
            vertices, faces = read_ply(bench.path("true.ply"))
            rng = np.random.default_rng(6)
            p, _, true_volume = scattered(vertices, faces, 30000, rng)
            noise = share * np.ptp(vertices, axis=0).max()
            bench.write("a.xyz", rows_of(p + noise * rng.normal(size=p.shape)))
            tried = bench.run("gravity", "a.xyz", "--wrap", "--unit", "km", "--density", "1000", "--at", "vertices",
                              "--tolerance", "1e-2", "-o", "laid.ply")  # fmt: skip
            if tried.status != 0:
                return tried.refused()[0], False
            places, _, laid_volume = scattered(*read_ply(bench.path("laid.ply")), 1000, rng)
            off = distances(places, *scattered(vertices, faces, 60000, rng)[:2])
            over = float(np.sqrt((off**2).mean())) / noise
            error = 100 * (laid_volume / true_volume - 1)
            stated = tried.figures["repair"]["noise"] / noise
            return f"{error:+.2f} %, {over:.2f}, noise found {stated:.3f}", abs(error) <= 0.3 and over <= 0.5


colors = np.random.default_rng(1).integers(0, 256, (20000, 3))
point_kind(".ply without normals", "a.ply", lambda: ply(cloud()[0], ("x", "y", "z")))
point_kind(".ply with normals of any length", "a.ply", lambda: ply(np.hstack((cloud()[0], 3 * cloud()[1])), ("x", "y", "z", "nx", "ny", "nz")))
point_kind(".ply with normals of 0", "a.ply", lambda: ply(np.hstack((cloud()[0], 0 * cloud()[1])), ("x", "y", "z", "nx", "ny", "nz")))
point_kind(".obj of vertices alone", "a.obj", lambda: "".join("v %.9g %.9g %.9g\n" % tuple(p) for p in cloud()[0]))
point_kind(".xyz with a first line //X Y Z", "a.xyz", lambda: rows_of(cloud()[0], first="//X Y Z\n"))
point_kind(".asc of CloudCompare with colours and normals", "a.asc",
           lambda: rows_of(cloud()[0], colors, cloud()[1], first="//X Y Z R G B Nx Ny Nz\n"))  # fmt: skip
point_kind(".pts with a count, intensities and colours", "a.pts", lambda: rows_of(cloud()[0], colors[:, 0] - 1000, colors, first="20000\n"))
point_kind(".xyzn", "a.xyzn", lambda: rows_of(*cloud()))
point_kind(".xyzrgb", "a.xyzrgb", lambda: rows_of(cloud()[0], colors / 255))
point_kind(".csv with names", "a.csv", lambda: rows_of(cloud()[0], colors, separator=",", first="X,Y,Z,R,G,B\n"))
point_kind(".txt of x, y, z", "a.txt", lambda: rows_of(cloud()[0]))
point_kind(".txt of x, y, z and normals", "a.txt", lambda: rows_of(*cloud()))


@kind("points: half of a body", "refused, with the share")
def _(bench):
    bench.write("a.xyz", rows_of(cloud(half=True)[0]))
    return weigh(bench, "a.xyz").refused("%", "--fill-unseen")


@kind("points: half of a body with --fill-unseen", "status 0, with the share")
def _(bench):
    bench.write("a.xyz", rows_of(cloud(half=True)[0]))
    tried = weigh(bench, "a.xyz", "--fill-unseen")
    return " ".join(tried.words.split())[:200], tried.status == 0 and near(tried.figures.get("repair", {}).get("unseen_share"), 0.5, 0.15)


@kind("points: 40 strays", "volume within .3 %, the strays said")
def _(bench):
    p = np.vstack((cloud()[0], 10 * np.random.default_rng(4).normal(size=(40, 3))))
    bench.write("a.xyz", rows_of(p))
    return volume(weigh(bench, "a.xyz"), words=["stray"])


# --- all of them -------------------------------------------------------------------------------------------------------------
def main():
    arguments = arguments_of(__doc__, "bin", only="")
    head("kind", "right", "found", "")
    wrong = 0
    for words, right, function in KINDS:
        if arguments.only not in words:
            continue
        with tempfile.TemporaryDirectory() as folder:
            found, good = function(Bench(arguments.bin.resolve(), folder))
        wrong += not good
        row(words, right, " ".join(found.split()).replace(folder, "").replace("|", "/"), "right" if good else "WRONG")
    print(f"\n{len([k for k in KINDS if arguments.only in k[0]])} kinds, {wrong} wrong")
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
