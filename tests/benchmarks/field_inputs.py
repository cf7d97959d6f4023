#!/usr/bin/env python3
"""Makes small inputs of the kinds that people bring, with right values from closed forms, and gives them to the programs.

    field_inputs.py BIN [--only WORD] [--keep FOLDER]

BIN holds the programs. Prints a line for each input: what is right, what came, and "ok", "refused" or "WRONG". Right is
a value within its tolerance, or status 2 with one line that has the word. Needs NumPy, tifffile and imagecodecs. Exit
status 1 if a line is wrong.
"""

import collections
import functools
import json
import math
import pathlib
import struct
import tempfile

import imagecodecs
import numpy as np
import tifffile

from measure import Run, arguments_of, head, row

SECONDS = 30
FIT = ("-o", "FOLDER/out.json", "--summary", "FOLDER/figures.json", "--lobes", 3, "--gap", 0.05)
CASES = []  # (program, name of the file, what writes it, options, what is right: figures, or a word of the refusal)


def case(program, name, content, right, *options):
    """The content is text, bytes, a dict of more files beside by their endings, or a function of the path."""
    CASES.append((program, name, content, options, right))


# --- height maps: ground of rms 12 about 300, a corner of which may be missing -----------------------------------------
WIDTH, HEIGHT = 96, 80
k = np.hypot(*np.meshgrid(np.fft.fftfreq(WIDTH), np.fft.fftfreq(HEIGHT)))
k[0, 0] = 1
G = np.real(np.fft.ifft2(np.fft.fft2(np.random.default_rng(1).normal(size=k.shape)) * k**-1.2))
G = 12 * (G - G.mean()) / G.std() + 300
F, WHOLE, TENTHS = G.astype("f4"), np.round(G), np.round(10 * (G - 300))
HOLE = np.add.outer(np.arange(HEIGHT), np.arange(WIDTH)) < 40
holed = functools.partial(np.where, HOLE)


def tiff(data, nodata=None, step=(2.0, 2.0), keys=(), item="", at=(1000.0, 2000.0), matrix=None, **options):
    """What writes a GeoTIFF with the sides of its pixels, its GeoKeys, and metadata of GDAL."""
    tags = []
    if matrix:
        tags.append((34264, "d", 16, matrix, True))
    elif step:
        tags += [(33550, "d", 3, (*step, 0.0), True), (33922, "d", 6, (0.0, 0.0, 0.0, *at, 0.0), True)]
    if keys:
        tags.append((34735, "H", 4 * len(keys) + 4, (1, 1, 0, len(keys), *sum(keys, ())), True))
    if nodata is not None:
        tags.append((42113, "s", 0, nodata, True))
    if item:
        items = "".join(f'<Item name="{role}" sample="0" role="{role}">{value}</Item>' for role, value in item.items())
        tags.append((42112, "s", 0, f"<GDALMetadata>{items}</GDALMetadata>", True))
    return lambda path: tifffile.imwrite(path, data, extratags=tags, metadata=None, **options)


def heights(name, content, data=G, *options, hole=False, **right):
    right = dict(rms=(data[~HOLE] if hole else data).std(), missing=HOLE.mean() if hole else 0.0) | right
    case("fit_gabor", name, content, right, *options)


for kind in ("f4", "f8", "f2", "u2", "i2", "u4", "i4"):
    data = (G if kind[0] == "f" else WHOLE).astype(kind)
    heights(f"{kind}.tif", tiff(data), data.astype("f8"), px=2.0)
heights("lzw_predictor.tif", tiff(G, compression="lzw", predictor=True), px=2.0)
heights("deflate_tiled.tif", tiff(F, compression="deflate", predictor=True, tile=(32, 48)), px=2.0)
heights("zstd_bigtiff_msb.tif", tiff(F, compression="zstd", bigtiff=True, byteorder=">"), px=2.0)
for mark in ("nan", "-9999", "3.4e38", "-3.4028234663852886e+38", "0"):
    heights(f"nodata_{mark}.tif", tiff(holed(float(mark), G).astype("f4"), mark), hole=True)
for mark, kind in ((-32768, "i2"), (-9999, "f4"), (32767, "i2"), (9999, "f4"), (65535, "u2"), (0, "u2")):
    heights(f"unnamed_{mark}.tif", tiff(holed(mark, WHOLE * 10).astype(kind)), WHOLE * 10, hole=True)
scaled = tiff(holed(-32768, TENTHS).astype("i2"), "-32768", item={"scale": 0.1, "offset": 300})
heights("scaled.tif", scaled, TENTHS / 10, hole=True)
heights("kilometres.tif", tiff(G / 1000, item={"unittype": "km"}))
heights("feet.tif", tiff(G / 0.3048, item={"unittype": "ft"}))
PLANE, GLOBE = (1024, 0, 1, 1), ((1024, 0, 1, 2), (2048, 0, 1, 4326))
heights("survey_feet.tif", tiff(F, keys=(PLANE, (3072, 0, 1, 2229)), at=(6.5e6, 1.8e6)), px=2 * 1200 / 3937)
heights("degrees.tif", tiff(F, step=(1e-4, 1e-4), keys=GLOBE, at=(7.0, 0.004)), px=math.radians(1e-4) * 6378137)
c, s = 2 * math.cos(0.5), 2 * math.sin(0.5)
heights("turned.tif", tiff(F, matrix=(c, s, 0, 1000, s, -c, 0, 2000, *[0] * 7, 1)), px=2.0)
for name, content, word in (
    ("most_missing", tiff(np.where(np.arange(WIDTH) < 60, -9999, G).astype("f4"), "-9999"), "fewer gaps"),
    ("degrees_at_46", tiff(F, step=(1e-4, 1e-4), keys=GLOBE, at=(7.0, 46.0)), "gdalwarp"),
    ("oblong", tiff(F, step=(2.0, 3.0)), "--mm-per-px"), ("complex", tiff(F.astype("c8")), "magnitude"),
    ("bands", tiff(np.stack([F] * 7), photometric="minisblack", planarconfig="separate"), "gdal_translate")):  # fmt: skip
    case("fit_gabor", f"{name}.tif", content, word)


def isis(data, kind, base=0.0, factor=1.0, tile=None, order="Lsb"):
    shape = "Format = BandSequential"
    body = data.tobytes()
    if tile:
        shape = f"Format = Tile\nTileSamples = {tile}\nTileLines = {tile}"
        full = np.pad(data, [(0, -n % tile) for n in data.shape])
        body = full.reshape(full.shape[0] // tile, tile, -1, tile).swapaxes(1, 2).tobytes()
    label = f"""Object = IsisCube\nObject = Core\nStartByte = 4097\n{shape}\nGroup = Dimensions\nSamples = {WIDTH}\nLines = {HEIGHT}
Bands = 1\nEnd_Group\nGroup = Pixels\nType = {kind}\nByteOrder = {order}\nBase = {base}\nMultiplier = {factor}\nEnd_Group\nEnd_Object
Group = Mapping\nProjectionName = Equirectangular\nCenterLongitude = 0.0\nCenterLatitude = 0.0\nTargetName = Moon
EquatorialRadius = 1737400.0\nPolarRadius = 1737400.0\nLatitudeType = Planetocentric\nLongitudeDirection = PositiveEast
LongitudeDomain = 360\nUpperLeftCornerX = 0.0\nUpperLeftCornerY = 80.0\nPixelResolution = 2.0\nEnd_Group\nEnd_Object\nEnd\n"""
    return label.encode().ljust(4096, b"\0") + body


NULL = np.frombuffer(b"\xfb\xff\x7f\xff", "<f4")[0]
heights("real.cub", isis(holed(NULL, F).astype("<f4"), "Real"), hole=True, px=2.0)
heights("tiles.cub", isis(holed(NULL, F).astype("<f4"), "Real", tile=32), hole=True, px=2.0)
heights("msb.cub", isis(F.astype(">f4"), "Real", order="Msb"), px=2.0)
heights("signed.cub", isis(holed(-32766, TENTHS).astype("<i2"), "SignedWord", 300, 0.1), TENTHS / 10, hole=True, px=2.0)
heights("unsigned.cub", isis(holed(1, TENTHS + 900).astype("<u2"), "UnsignedWord", 210, 0.1), TENTHS / 10, hole=True, px=2.0)


def pds3(kind, bits, lines, image="41"):
    record = WIDTH * bits // 8
    label = f"""PDS_VERSION_ID = PDS3\nRECORD_TYPE = FIXED_LENGTH\nRECORD_BYTES = {record}\nFILE_RECORDS = 120
^IMAGE = {image}\nTARGET_NAME = MOON\nOBJECT = IMAGE\n LINES = {HEIGHT}\n LINE_SAMPLES = {WIDTH}
 SAMPLE_TYPE = {kind}\n SAMPLE_BITS = {bits}\n{lines}\nEND_OBJECT = IMAGE\nEND\n""".replace("\n", "\r\n").encode()
    return label if "." in image else label.ljust(40 * record)


SCALED = " UNIT = METER\n SCALING_FACTOR = 0.1\n OFFSET = 300"
MISSING = "\n MISSING_CONSTANT = -32768"
big, little = holed(-32768, TENTHS).astype(">i2").tobytes(), TENTHS.astype("<i2").tobytes()
heights("msb.img", pds3("MSB_INTEGER", 16, SCALED + MISSING) + big, TENTHS / 10, hole=True)
heights("kilometres.img", pds3("PC_REAL", 32, " UNIT = KILOMETER") + (F / 1000).astype("<f4").tobytes())
hexadecimal = pds3("IEEE_REAL", 32, " UNIT = METER\n MISSING_CONSTANT = 16#FF7FFFFB#")
heights("hexadecimal.img", hexadecimal + holed(NULL, F).astype(">f4").tobytes(), hole=True)
heights("apart.lbl", {".lbl": pds3("LSB_INTEGER", 16, SCALED, '"apart.img"'), ".img": little}, TENTHS / 10)
case("fit_gabor", "pixels.img", {".lbl": pds3("LSB_INTEGER", 16, SCALED, '"pixels.img"'), ".img": little}, "give pixels.lbl")
case("fit_gabor", "alone.lbl", pds3("LSB_INTEGER", 16, SCALED, '"gone.img"'), "put the file that it names beside it")
case("fit_gabor", "vax.img", pds3("VAX_REAL", 32, " UNIT = METER") + F.tobytes(), "floats of a VAX")
axis = "<Axis_Array><axis_name>{}</axis_name><elements>{}</elements><sequence_number>{}</sequence_number></Axis_Array>"
pds4 = f"""<?xml version="1.0"?>\n<Product_Observational xmlns="http://pds.nasa.gov/pds4/pds/v1"><File_Area_Observational><File>
<file_name>four.img</file_name></File><Array_2D_Image><offset unit="byte">0</offset><axes>2</axes>
<axis_index_order>Last Index Fastest</axis_index_order><Element_Array><data_type>SignedMSB2</data_type><unit>m</unit>
<scaling_factor>0.1</scaling_factor><value_offset>300</value_offset></Element_Array>{axis.format("Line", HEIGHT, 1)}
{axis.format("Sample", WIDTH, 2)}<Special_Constants><missing_constant>-32768</missing_constant></Special_Constants>
</Array_2D_Image></File_Area_Observational></Product_Observational>\n"""
heights("four.xml", {".xml": pds4, ".img": big}, TENTHS / 10, hole=True)
envi = f"ENVI\nsamples = {WIDTH}\nlines = {HEIGHT}\nbands = 1\ndata type = 4\ninterleave = bsq\nbyte order = 1\n"
envi += "data ignore value = -9999\nmap info = {Arbitrary, 1, 1, 0, 0, 2, 2, 0, units=Meters}\n"
pair = {".hdr": envi, ".dat": holed(-9999, G).astype(">f4").tobytes()}
heights("envi.dat", pair, hole=True, px=2.0)
case("fit_gabor", "header.hdr", pair, "give header.dat")
grid = f"ncols {WIDTH}\nnrows {HEIGHT}\nxllcorner 1000\nyllcorner 2000\ncellsize 2\nNODATA_value -9999\n"
grid += "".join(" ".join("%.4f" % v for v in line) + "\n" for line in holed(-9999, G))
heights("grid.asc", grid, hole=True, px=2.0)
heights("commas.asc", grid.replace(".", ","), hole=True, px=2.0)
tile = np.tile(WHOLE, (16, 13))[:1201, :1201]
heights("N00E006.hgt", tile.astype(">i2").tobytes(), tile, px=92.76)

# --- pictures: mean and rms of brightness ------------------------------------------------------------------------------
P = np.clip((G - 240) / 120, 0, 1)
B, B16 = np.round(255 * P).astype("u1"), np.round(65535 * P).astype("u2")
RGB, A = np.dstack([B, np.roll(B, 9, 0) // 2, 255 - B // 3]), np.where(HOLE, 128, 255).astype("u1")
LUMA, PREMULTIPLIED = RGB / 255 @ [0.2126, 0.7152, 0.0722], np.round(RGB * (A[..., None] / 255)).astype("u1")
COLORS = np.tile(257 * (np.arange(256) ** 2 // 255), (3, 1)).astype("u2")
for name, data, values, options in (
    ("white_is_zero", 65535 - B16, P, dict(photometric="miniswhite")), ("bits", B > 128, B > 128, dict(photometric="minisblack")),
    ("apart", np.moveaxis(RGB, 2, 0).copy(), LUMA, dict(photometric="rgb", planarconfig="separate")),
    ("alpha", np.dstack([RGB, A]), LUMA, dict(photometric="rgb", extrasamples=["unassalpha"])),
    ("multiplied", np.dstack([PREMULTIPLIED, A]), LUMA, dict(photometric="rgb", extrasamples=["assocalpha"])),
    ("palette", B, (B.astype(int) ** 2 // 255) / 255, dict(photometric="palette", colormap=COLORS))):  # fmt: skip
    case("fit_gabor", f"{name}.tif", tiff(data, step=None, **options), dict(mean=np.mean(values), contrast=np.std(values)))
case("fit_gabor", "lossless.jp2", imagecodecs.jpeg2k_encode(B16, level=0, reversible=True), dict(mean=P.mean(), contrast=P.std()))

# --- shapes: a box of 2 x 3 x 5 with a corner at 1, 1, 1 ---------------------------------------------------------------
V = np.array([[x, y, z] for z in (1, 6) for y in (1, 4) for x in (1, 3)], float)
Q = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
T = [t for a, b, c, d in Q for t in ((a, b, c), (a, c, d))]


def box(name, content, *options, unit="km", **right):
    case("gravity", name, content, dict(volume=30.0, area=62.0, x=2.0, y=2.5, z=3.5, unit=unit) | right, *options)


def lines(form, rows, base=0):
    return "".join(form % tuple(np.add(r, base)) + "\n" for r in rows)


OBJ = lines("v %g %g %g", V) + lines("f %d %d %d %d", Q, 1)
box("box.obj", OBJ)
box("below_zero.obj", lines("v %g %g %g 0.5 0.5 0.1", V) + lines("f %d %d %d %d", Q, -8))
box("joined.obj", OBJ.replace(" ", " \\\n"))
box("returns.obj", "\ufeff# Units: meters\n".encode() + OBJ.encode().replace(b"\n", b"\r"), unit="m")
box("doubled.obj", lines("v %g %g %g", V) + lines("f %d %d %d", T + T, 1))
box("two_sided.obj", lines("v %g %g %g", V) + lines("f %d %d %d", T + [t[::-1] for t in T], 1))
box("soup.obj", lines("v %g %g %g", V[np.array(T)].reshape(-1, 3)) + lines("f %d %d %d", np.arange(36).reshape(-1, 3), 1))
box("inside_out.obj", lines("v %g %g %g", V) + lines("f %d %d %d", [t[::-1] for t in T[:7]] + T[7:], 1))
both = lines("v %g %g %g", [*V, *(V + [1, 1, 1])]) + lines("f %d %d %d %d", Q, 1) + lines("f %d %d %d %d", Q, 9)
box("overlap.obj", both, "--union", volume=60.0 - 8.0, area=124.0 - 28.0, x=2.5, y=3.0, z=4.0)
for name, content, word in (
    ("utf16.obj", OBJ.encode("utf-16"), "UTF-16"), ("commas.obj", OBJ.replace("v 1 1 1", "v 1,0 1,0 1,0"), "decimal comma"),
    ("feet.obj", "# units = feet\n" + OBJ, "convert"), ("part.step", "ISO-10303-21;\nHEADER;\n", "export it as triangles"),
    ("part.stl", " " * 72 + "S      1\n" + "1H,,1H;\n" * 20, "does not begin with 'solid'"), ("a.bds", "DAS/DSK " * 9, "dskexp"),
    ("a.3mf", b"PK\3\4" + bytes(26) + b"3D/3dmodel.model", "export it"), ("a.glb", b"glTF\2\0\0\0", "export it")):  # fmt: skip
    case("gravity", name, content, word)
STL = "solid a\n" + "".join("facet normal 0 0 0\nouter loop\n" + lines("vertex %e %e %e", V[list(t)]) + "endloop\nendfacet\n" for t in T)
box("capitals.stl", "\ufeff \n" + (STL + "end solid\n").upper())
facets = b"".join(struct.pack("<12fH", 0, 0, 0, *V[list(t)].ravel(), 0) for t in T)
box("millimetres.stl", b"scan UNITS=mm".ljust(80) + struct.pack("<I", 12) + facets, unit="mm")
PLY = "ply\nformat ascii 1.0\nobj_info unit = m\nelement vertex 8\nproperty int x\nproperty double y\nproperty float z\n"
PLY += "element face 6\nproperty list short uint vertex_index\nend_header\n"
box("odd_types.ply", PLY + lines("%g %g %g", V) + lines("4 %d %d %d %d", Q), unit="m")
box("normals.off", "CNOFF # made by hand\n\n8 6 12\n" + lines("%g %g %g 0 0 1 255 0 0 255", V) + lines("4 %d %d %d %d", Q))
box("type_3.ver", "8 12\n" + lines("%g %g %g", V) + lines("%d %d %d", T, 1))
box("type_4.ver", "8 6\n" + lines("%g %g %g", V) + "".join("4\n" + lines("%d %d %d %d", [q], 1) for q in Q))
label = 'PDS_VERSION_ID = PDS3\r\n^TABLE = "PLATES.TAB"\r\nOBJECT = COLUMN\r\nUNIT = METER\r\nEND_OBJECT\r\nEND\r\n'
plates = "8 12\n" + lines("%d %g %g %g", np.c_[1:9, V]) + lines("%d %d %d %d", np.c_[0:12, T], 1)
box("plates.tab", {".tab": plates, ".lbl": label}, unit="m")
star = [(math.cos(i * math.pi / 5) * (1 - 0.6 * (i % 2)), math.sin(i * math.pi / 5) * (1 - 0.6 * (i % 2))) for i in range(10)]
caps = "20 12\n" + "".join(lines("%.9f %.9f %.9f", np.c_[star, [z] * 10]) for z in (0, 2))
caps += "10 " + lines("%d " * 10, [range(9, -1, -1)]) + "10 " + lines("%d " * 10, [range(10, 20)])
caps += lines("4 %d %d %d %d", [(i, (i + 1) % 10, 10 + (i + 1) % 10, 10 + i) for i in range(10)])
case("gravity", "star.off", "OFF " + caps, dict(volume=2 * 10 / 2 * 0.4 * math.sin(math.pi / 5)))
# r = 1 + .2 sin(lon) cos(lat), whose centre of mass is (e + 3/5 e^3) / (1 + e^2) from the origin
for name, turn, names in (("radians.tab", 1, "lon[rad],lat[rad],r[m]"), ("west.tab", -180 / math.pi, "W_Longitude;Latitude;Radius (m)")):
    angles = [(math.radians(a), math.radians(o)) for a in range(-90, 91, 3) for o in range(0, 360, 3)]
    rows = [(turn * o % (2 * math.pi * abs(turn)), abs(turn) * a, 1 + 0.2 * math.sin(o) * math.cos(a)) for a, o in angles]
    form = "%.9f;%.9f;%.9f" if ";" in names else "%.9f,%.9f,%.9f"
    case("gravity", name, names + "\n" + lines(form, rows), dict(y=(0.2 + 0.6 * 0.2**3) / 1.04, unit="m"))
case("gravity", "half.tab", lines("%g %g 1", [(a, o) for a in range(0, 91, 5) for o in range(0, 360, 5)]), "name its columns")

# --- places ------------------------------------------------------------------------------------------------------------
for name, text, right in (
    ("excel.csv", '\ufeff"Name","X (m)","Y (m)","Z (m)"\r\n"far, old",10000,20000,30000\r\n', (10, 20, 30)),
    ("semicolons.csv", "id;z;y;x\n7;30;20;10\n", (10, 20, 30)), ("lines.txt", "10, 20, 30\n", (10, 20, 30)),
    ("west.csv", "lat,lon_w,radius\n0,270,40\n", (0, 40, 0)), ("angles.csv", "lon (rad),lat (rad),r (m)\n0,0,40000\n", (40, 0, 0)),
    ("state.csv", "utc,x,y,z,vx,vy,vz\n2001-01-01T00:00,10,20,30,1,1,1\n", (10, 20, 30)), ("wide.txt", "1 2 3 4\n", "name the columns"),
    ("altitude.csv", "lat,lon,altitude\n1,2,3\n", "name the columns"), ("quoted_commas.csv", 'x,y,z\n"1,5","2,5","3,5"\n', "decimal point"),
    ("mixed.csv", "x_m,y_km,z_km\n1,2,3\n", "convert"), ("pole.csv", "lat,lon,radius\n95,0,40\n", "beyond a pole")):  # fmt: skip
    case("gravity", name, {pathlib.Path(name).suffix: text, ".obj": OBJ}, right if isinstance(right, str) else dict(place=right),
         "--unit", "km", "--points", f"FOLDER/{name}", "-o", "FOLDER/out.csv")  # fmt: skip


# --- the run -----------------------------------------------------------------------------------------------------------
def figures_of(program, folder, done):
    """The figures of a run by the names that cases give them."""
    if program == "gravity":
        body, unit, table = done.json()["body"], done.json()["unit"], folder / "out.csv"
        metres = {"km": 1e3, "m": 1.0, "cm": 0.01, "mm": 0.001}[unit]
        place = np.loadtxt(table, delimiter=",", skiprows=1, ndmin=2)[0, :3].round(6).tolist() if table.exists() else None
        return dict(zip("xyz", np.divide(body["center_of_mass_m"], metres)), volume=body["volume_m3"] / metres**3,
                    area=body["area_m2"] / metres**2, unit=unit, place=place)  # fmt: skip
    image, layer = (json.loads((folder / name).read_text()) for name in ("figures.json", "out.json"))
    image, layer = image["image"], layer["layers"][0]
    return dict(rms=image.get("height_rms", math.nan), px=image.get("metres_per_pixel", math.nan), missing=image["missing"],
                mean=layer["exemplar_mean"], contrast=layer["exemplar_rms"])  # fmt: skip


def main():
    given = arguments_of(__doc__, "bin", only="", keep="")
    count = collections.Counter()
    own = tempfile.TemporaryDirectory()
    folder = pathlib.Path(given.keep or own.name)
    folder.mkdir(parents=True, exist_ok=True)
    head("program, input", "right", "came", "")
    for program, name, content, options, right in CASES:
        if given.only not in name:
            continue
        file = folder / name
        if callable(content):
            content(file)
        else:
            for ending, data in (content if isinstance(content, dict) else {file.suffix: content}).items():
                file.with_suffix(ending).write_bytes(data if isinstance(data, bytes) else data.encode())
        (folder / "out.csv").unlink(missing_ok=True)
        shape = file.with_suffix(".obj") if "--points" in options else file
        usual = ("--density", 1000, "--json", "--sample", 0) if program == "gravity" else FIT
        options = [str(o).replace("FOLDER", str(folder)) for o in (*usual, *options)]
        done = Run(given.bin / program, shape, *options, check=False, most_seconds=SECONDS)
        errors = [line.replace(f"{folder}/", "") for line in done.errors.splitlines() if not line.startswith("note:")]
        if isinstance(right, str):
            verdict = "refused" if done.status == 2 and len(errors) == 1 and right in errors[0] else "WRONG"
            came = " ".join(errors)
        else:
            got = figures_of(program, folder, done) if done.status == 0 else {}
            close = [got[n] == v if n == "unit" else np.allclose(got[n], v, rtol=2e-3, atol=1e-4) for n, v in right.items() if got]
            verdict = "ok" if got and all(close) else "WRONG"
            right, came = (", ".join(f"{n} {v:.5g}" if isinstance(v, float) else f"{n} {v}" for n, v in d.items())
                           for d in (right, {n: got.get(n) for n in right}))  # fmt: skip
            came = came if got else f"status {done.status}: {' '.join(errors)}"
        count[verdict] += 1
        row(f"{program} {name}", right, came, verdict)
    print(f"\n{sum(count.values())} inputs: " + ", ".join(f"{number} {verdict}" for verdict, number in count.items()))
    return count["WRONG"] > 0


if __name__ == "__main__":
    raise SystemExit(main())
