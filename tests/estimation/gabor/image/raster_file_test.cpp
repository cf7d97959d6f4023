// Rasters that GDAL reads: what their files state about values, ground and gaps.
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/gabor/image/image_reader.h"
#include "estimation/gabor/image/missing_ground.h"
#include "estimation/gabor/image/square_pixels.h"
#include "numerics/errors.h"
#include "synthesis/picture/image_file.h"
#include "tests/estimation/gabor/image/raster_inputs.h"
#include "tests/support/comma_locale.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using testing::has;
using testing::place;
using testing::RasterInput;
using testing::write_raster;
using testing::write_tiff;
namespace fs = std::filesystem;

class RasterFileTest : public ::testing::Test {
 protected:
  ImageFile read(const RasterInput& input, std::vector<double> values,
                 const std::function<void(GDALDataset&)>& describe = {}) {
    return read_image(write_raster(folder / "raster", input, std::move(values), describe), false);
  }
  std::string error_message(const fs::path& file) {
    return testing::refusal_text([&] { read_image(file, false); });
  }
  static void expect_values(const GreyImage& image, const std::vector<double>& expected) {
    ASSERT_EQ(image.values.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(image.values[i], expected[i], 1e-12) << i;
  }

  testing::ScratchFolder folder;
};

const std::vector<double> kSteps{0.0, 1.0, 2.0, 3.0, 4.0, 5.0};

TEST_F(RasterFileTest, EveryDepthHasItsFullScale) {
  const auto shares = [&](GDALDataType type, const char* bits, double full) {
    RasterInput input{"GTiff", type};
    if (bits != nullptr) input.options = {bits};
    expect_values(read(input, {0.0, full, 1.0, 2.0, 3.0, 4.0}).planes[0],
                  {0.0, 1.0, 1.0 / full, 2.0 / full, 3.0 / full, 4.0 / full});
  };
  shares(GDT_Byte, nullptr, 255.0);
  shares(GDT_Byte, "NBITS=4", 15.0);
  shares(GDT_UInt16, nullptr, 65535.0);
  shares(GDT_UInt16, "NBITS=12", 4095.0);
  shares(GDT_UInt32, nullptr, 4294967295.0);
}

TEST_F(RasterFileTest, FloatsAndSignedIntegersStayAsTheyAre) {
  const std::vector<double> values{-2.0, 0.5, 0.0, 3.0, 65504.0, 1.0};
  for (const GDALDataType type : {GDT_Float32, GDT_Float64})
    expect_values(read({"GTiff", type}, values).planes[0], values);
  expect_values(read({"GTiff", GDT_Float32, 3, 2, 1, {"NBITS=16"}}, values).planes[0], values);
  const std::vector<double> whole{-128.0, 0.0, 127.0, 3.0, -1.0, 1.0};
  for (const GDALDataType type : {GDT_Int16, GDT_Int32, GDT_Int64})
    expect_values(read({"GTiff", type}, whole).planes[0], whole);
  expect_values(
      read({"GTiff", GDT_Byte, 3, 2, 1, {"PIXELTYPE=SIGNEDBYTE"}}, {128.0, 0.0, 127.0, 3.0, 255.0, 1.0})
          .planes[0],
      whole);
}

TEST_F(RasterFileTest, PlanesTilesAndCompressionMakeNoDifference) {
  const std::vector<double> colors{65535, 0, 0,     0, 65535, 0, 0,     0, 65535,
                                   0,     0, 65535, 0, 65535, 0, 65535, 0, 0};
  const auto planes = [&](std::vector<const char*> options) {
    write_raster(folder / "c.tif", {"GTiff", GDT_UInt16, 3, 2, 3, std::move(options)}, colors);
    return read_image(folder / "c.tif", true).planes;
  };
  const auto together = planes({"PHOTOMETRIC=RGB"});
  EXPECT_EQ(together[0].values, (std::vector<double>{1, 0, 0, 0, 1, 0}));
  for (const char* option : {"INTERLEAVE=BAND", "TILED=YES", "COMPRESS=LZW"}) {
    const auto other = planes({"PHOTOMETRIC=RGB", option});
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(other[k].values, together[k].values) << option;
  }
}

TEST_F(RasterFileTest, WhiteMayBeZero) {
  expect_values(
      read({"GTiff", GDT_UInt16, 3, 2, 1, {"PHOTOMETRIC=MINISWHITE"}}, {65535, 0, 13107, 0, 0, 0}).planes[0],
      {0.0, 1.0, 0.8, 1.0, 1.0, 1.0});
  expect_values(
      read({"GTiff", GDT_Byte, 3, 2, 1, {"PHOTOMETRIC=MINISWHITE"}}, {255, 0, 51, 0, 0, 0}).planes[0],
      {0.0, 1.0, 0.8, 1.0, 1.0, 1.0});
}

TEST_F(RasterFileTest, PalettesAreExpanded) {
  write_raster(folder / "p.tif", {"GTiff", GDT_Byte}, {0, 1, 0, 1, 0, 1}, [](GDALDataset& raster) {
    GDALColorTable table;
    const GDALColorEntry red{255, 0, 51, 255}, blue{0, 102, 255, 255};
    table.SetColorEntry(0, &red);
    table.SetColorEntry(1, &blue);
    raster.GetRasterBand(1)->SetColorTable(&table);
  });
  const ImageFile color = read_image(folder / "p.tif", true);
  EXPECT_DOUBLE_EQ(color.planes[0].values[0], 1.0);
  EXPECT_DOUBLE_EQ(color.planes[2].values[0], 0.2);
  EXPECT_DOUBLE_EQ(color.planes[1].values[1], 0.4);
}

TEST_F(RasterFileTest, ColoursUnderAlphaAreThoseStored) {
  const std::vector<std::uint8_t> pixels{51, 102, 204, 255, 51, 102, 204, 128,
                                         51, 102, 204, 0,   51, 102, 204, 255};
  const auto with_alpha = [&](std::uint16_t kind) {
    write_tiff(folder / "a.tif", 4, 4, pixels,
               [&](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &kind); });
    return read_image(folder / "a.tif", true);
  };
  const ImageFile apart = with_alpha(EXTRASAMPLE_UNASSALPHA);
  EXPECT_EQ(apart.planes[0].values, std::vector<double>(4, 0.2));
  ASSERT_EQ(apart.remarks.size(), 1u);
  EXPECT_TRUE(has(apart.remarks[0], "50.0 %"));
  // What was multiplied in is divided out, and nothing is left where alpha is 0.
  const ImageFile associated = with_alpha(EXTRASAMPLE_ASSOCALPHA);
  EXPECT_DOUBLE_EQ(associated.planes[0].values[0], 0.2);
  EXPECT_DOUBLE_EQ(associated.planes[0].values[1], 0.2 * 255.0 / 128.0);
  EXPECT_EQ(associated.planes[0].missing, (std::vector<bool>{false, false, true, false}));
}

TEST_F(RasterFileTest, AHeightMapStatesItsPixelsHeightsAndGaps) {
  const ImageFile map = read({"GTiff", GDT_Int16}, {-9999, 10, 20, 30, 20, 10}, [](GDALDataset& raster) {
    place(raster, 2.5, "+proj=eqc +R=1737400 +units=m");
    GDALRasterBand& band = *raster.GetRasterBand(1);
    band.SetNoDataValue(-9999);
    band.SetScale(0.5);
    band.SetOffset(100.0);
    band.SetUnitType("km");
  });
  ASSERT_TRUE(map.scale.has_value());
  EXPECT_TRUE(map.scale->heights);
  EXPECT_DOUBLE_EQ(map.scale->pixel_width, 2.5);
  EXPECT_EQ(map.scale->pixel_source, "");
  EXPECT_EQ(map.planes[0].missing, (std::vector<bool>{true, false, false, false, false, false}));
  EXPECT_NEAR(map.planes[0].values[3] - map.planes[0].values[1], 1e4, 1e-9);
  EXPECT_NEAR(known_mean(map.planes[0]), 0.0, 1e-9);
  EXPECT_TRUE(std::isfinite(map.planes[0].values[0]));
}

TEST_F(RasterFileTest, DegreesBecomeMetresByTheBodysRadius) {
  const ImageFile map = read({"GTiff", GDT_Float32}, kSteps, [](GDALDataset& raster) {
    std::array<double, 6> transform{10.0, 0.01, 0.0, 0.01, 0.0, -0.01};
    raster.SetGeoTransform(transform.data());
    OGRSpatialReference moon;
    moon.SetGeogCS("Moon", "D_Moon", "Moon", 1737400.0, 0.0);
    raster.SetSpatialRef(&moon);
  });
  EXPECT_NEAR(map.scale->pixel_height, 1737400.0 * 0.01 * std::acos(-1.0) / 180.0, 1e-6);
  EXPECT_NEAR(map.scale->pixel_width, map.scale->pixel_height, 1e-4);
  EXPECT_EQ(map.scale->pixel_source, "degrees on a body of radius 1737.4 km");
  EXPECT_EQ(map.scale->height_source, "no unit is stated");
}

// Mercator's pixels at 60 degrees are twice as large as the ground below them.
TEST_F(RasterFileTest, AProjectionMayStretchTheGround) {
  const ImageFile map = read({"GTiff", GDT_Float32}, kSteps, [](GDALDataset& raster) {
    const double north = 1737400.0 * std::log(std::tan(75.0 * std::acos(-1.0) / 180.0));
    std::array<double, 6> transform{-15.0, 10.0, 0.0, north + 10.0, 0.0, -10.0};
    raster.SetGeoTransform(transform.data());
    OGRSpatialReference reference;
    reference.SetFromUserInput("+proj=merc +R=1737400 +units=m");
    raster.SetSpatialRef(&reference);
  });
  EXPECT_NEAR(map.scale->pixel_width, 5.0, 1e-4);
  EXPECT_NEAR(map.scale->pixel_height, 5.0, 1e-3);
  EXPECT_EQ(map.scale->pixel_source, "on the ground, where the projection has 10 m");
}

// Six digits of a size are read back by the C library in Python's caller's locale, or not by it.
TEST_F(RasterFileTest, PixelsAreTheSameInEveryLocale) {
  const testing::CommaLocale comma;
  if (!comma.is_set()) GTEST_SKIP() << "no locale with a comma can be made";
  const ImageFile map = read({"GTiff", GDT_Float32}, kSteps, [](GDALDataset& raster) {
    std::array<double, 6> transform{2e6, 3.0, 0.0, 8399738.0, 0.0, -3.0};
    raster.SetGeoTransform(transform.data());
    OGRSpatialReference reference;
    reference.SetFromUserInput("EPSG:3857");
    raster.SetSpatialRef(&reference);
  });
  EXPECT_NEAR(map.scale->pixel_width, 1.5, 1e-5);
}

// PROJ without its database knows neither Web Mercator nor the feet of California.
TEST_F(RasterFileTest, PixelsAreUnknownWithoutTheDataOfProj) {
  const auto map = [](const char* frame, double north) {
    return [=](GDALDataset& raster) {
      std::array<double, 6> transform{2e6, 3.0, 0.0, north, 0.0, -3.0};
      raster.SetGeoTransform(transform.data());
      OGRSpatialReference reference;
      reference.SetFromUserInput(frame);
      raster.SetSpatialRef(&reference);
    };
  };
  const RasterInput input{"GTiff", GDT_Float32};
  const auto mercator = write_raster(folder / "mercator.tif", input, kSteps, map("EPSG:3857", 8399738.0));
  const auto feet = write_raster(folder / "feet.tif", input, kSteps, map("EPSG:2225", 2e6));
  const auto moon =
      write_raster(folder / "moon.tif", input, kSteps, map("+proj=merc +R=1737400 +units=m", 2e6));
  EXPECT_NEAR(read_image(mercator, false).scale->pixel_width, 1.5, 1e-5);
  EXPECT_NEAR(read_image(feet, false).scale->pixel_width, 3.0 * 1200.0 / 3937.0, 1e-9);
  char** const paths = OSRGetPROJSearchPaths();
  const char* const nowhere[] = {folder.path().c_str(), nullptr};
  OSRSetPROJSearchPaths(nowhere);
  OSRCleanup();
  for (const auto& file : {mercator, feet, moon}) {
    EXPECT_TRUE(read_image(file, false).scale->unknown) << file;
    EXPECT_EQ(read_image(file, false).scale->pixel_source, "of a map that PROJ cannot evaluate");
  }
  OSRSetPROJSearchPaths(paths);
  OSRCleanup();
  CSLDestroy(paths);
  EXPECT_FALSE(read_image(feet, false).scale->unknown);
}

TEST_F(RasterFileTest, AFootIsNoMetre) {
  const ImageFile map = read({"GTiff", GDT_Float32}, kSteps, [](GDALDataset& raster) {
    place(raster, 10.0, "+proj=eqc +R=1737400 +units=ft");
    raster.GetRasterBand(1)->SetUnitType("ft");
  });
  EXPECT_NEAR(map.scale->pixel_width, 3.048, 1e-9);
  EXPECT_NEAR(map.planes[0].values[5] - map.planes[0].values[0], 1.524, 1e-9);
}

TEST_F(RasterFileTest, PicturesFromAboveHavePixelsAndNoHeights) {
  const ImageFile picture =
      read({"GTiff", GDT_Byte}, kSteps, [](GDALDataset& raster) { place(raster, 0.5); });
  ASSERT_TRUE(picture.scale.has_value());
  EXPECT_FALSE(picture.scale->heights);
  EXPECT_DOUBLE_EQ(picture.scale->pixel_width, 0.5);
  EXPECT_DOUBLE_EQ(picture.planes[0].values[5], 5.0 / 255.0);
  EXPECT_FALSE(read({"GTiff", GDT_Float32}, kSteps, [](GDALDataset& raster) {
                 place(raster, 0.5);
                 raster.GetRasterBand(1)->SetUnitType("I/F");
               }).scale->heights);
}

// A size of pixels without a place on the ground, which GDAL calls invalid.
TEST_F(RasterFileTest, APixelScaleByItselfCounts) {
  TIFF* tiff = TIFFOpen((folder / "s.tif").c_str(), "w");
  static char name[] = "ModelPixelScale";
  const TIFFFieldInfo field{33550, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, name};
  TIFFMergeFieldInfo(tiff, &field, 1);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 2);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  const double scale[] = {3.0, 3.0, 0.0};
  TIFFSetField(tiff, 33550, 3, scale);
  float row[] = {-1850.0f, -1851.0f};
  TIFFWriteScanline(tiff, row, 0);
  TIFFClose(tiff);
  const ImageFile map = read_image(folder / "s.tif", false);
  ASSERT_TRUE(map.scale.has_value());
  EXPECT_DOUBLE_EQ(map.scale->pixel_width, 3.0);
  expect_values(map.planes[0], {0.5, -0.5});
}

TEST_F(RasterFileTest, TheHeightMapsOfSynthAreReadBack) {
  std::vector<float> heights{1.0f, 2.0f, 3.0f, std::numeric_limits<float>::quiet_NaN(), 5.0f, 6.0f};
  write_geotiff(heights, 3, 2, 0.25, "heights", folder / "g.tif");
  const ImageFile map = read_image(folder / "g.tif", false);
  ASSERT_TRUE(map.scale.has_value());
  EXPECT_TRUE(map.scale->heights);
  EXPECT_DOUBLE_EQ(map.scale->pixel_width, 0.25);
  EXPECT_EQ(map.scale->pixel_source, "");
  EXPECT_NEAR(missing_share(map.planes[0]), 1.0 / 6.0, 1e-12);
}

TEST_F(RasterFileTest, MarksThatNoFileNamesAreFound) {
  const ImageFile map = read({"GTiff", GDT_Float32}, {-9999, 10, 11, 12, 11, 10});
  EXPECT_NEAR(missing_share(map.planes[0]), 1.0 / 6.0, 1e-12);
  ASSERT_EQ(map.remarks.size(), 1u);
  EXPECT_TRUE(has(map.remarks[0], "-9999"));
  const auto share = [&](double mark, const std::function<void(GDALDataset&)>& describe) {
    return missing_share(read({"GTiff", GDT_UInt16}, {mark, 310, 311, 312, 311, mark}, describe).planes[0]);
  };
  const auto placed = [](GDALDataset& raster) { place(raster, 2.0); };
  for (const double mark : {0.0, 9999.0, 32767.0, 65535.0}) {
    EXPECT_NEAR(share(mark, placed), 1.0 / 3.0, 1e-12) << mark;
    EXPECT_EQ(share(mark, {}), 0.0) << mark;  // brightness
  }
  EXPECT_EQ(share(5000.0, placed), 0.0);
  // A radius in metres is a height like another.
  EXPECT_EQ(
      missing_share(read({"GTiff", GDT_Float64}, {1.7e6, 1.7e6, 1.7e6 + 1, 1.7e6, 1.7e6, 1.7e6}).planes[0]),
      0.0);
  write_raster(folder / "far.tif", {"GTiff", GDT_Float64}, {1e12, 1, 2, 3, 4, 5});
  EXPECT_TRUE(has(error_message(folder / "far.tif"), "-a_nodata"));
}

TEST_F(RasterFileTest, OneMarkMayHideAnother) {
  std::vector<double> values;
  for (int i = 0; i < 100; ++i) values.push_back(i);
  values[3] = -9999.0, values[50] = 32767.0;
  const ImageFile map = read({"GTiff", GDT_Float32, 10, 10}, values, [](GDALDataset& d) { place(d, 1.0); });
  EXPECT_EQ(map.remarks.size(), 2u);
  EXPECT_TRUE(map.planes[0].missing[3] && map.planes[0].missing[50]);
}

TEST_F(RasterFileTest, FormatsOfPlanetsAndOfMapsAreRead) {
  const std::vector<double> heights{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  for (const char* format : {"ISIS3", "PDS4", "VICAR", "ENVI", "FITS", "EHdr", "HFA", "AAIGrid"}) {
    const fs::path file = folder / (std::string(format) + (std::string(format) == "PDS4" ? ".xml" : ".img"));
    write_raster(file, {format, GDT_Float32, 4, 3}, heights);
    ASSERT_TRUE(fs::exists(file)) << format;
    const GreyImage image = read_image(file, false).planes[0];
    ASSERT_EQ(image.values.size(), 12u) << format;
    EXPECT_NEAR(image.values[5] - image.values[0], 5.0, 1e-6) << format;
    EXPECT_FALSE(fs::exists(file.string() + ".aux.xml") && std::string(format) != "FITS") << format;
  }
}

TEST_F(RasterFileTest, MarksOfIsisAreMissing) {
  const std::vector<double> heights{5, 6, 7, 8, 9, 10, 11, 12};
  const auto share = [&](GDALDataType type, std::vector<double> marks) {
    marks.insert(marks.end(), heights.begin(), heights.end());
    const fs::path file = folder / "marks.cub";
    write_raster(file, {"ISIS3", type, 4, 3}, marks, [](GDALDataset& raster) { place(raster, 2.0); });
    return missing_share(read_image(file, false).planes[0]);
  };
  EXPECT_NEAR(share(GDT_UInt16, {0, 1, 65534, 65535}), 1.0 / 3.0, 1e-12);
  EXPECT_EQ(share(GDT_UInt16, {3, 4, 5, 6}), 0.0);
  EXPECT_NEAR(share(GDT_Int16, {-32768, -32767, -32766, -32764}), 1.0 / 3.0, 1e-12);
}

// A PDS3 image of 3 x 2 pixels, 0 to 5, of big-endian integers of so many bits, with more lines of its label.
std::string pds3(int bits, const std::string& lines, const std::string& image = "3") {
  std::string file =
      "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 512\r\nFILE_RECORDS = 3\r\n"
      "LABEL_RECORDS = 2\r\n^IMAGE = " +
      image + "\r\nOBJECT = IMAGE\r\n LINES = 2\r\n LINE_SAMPLES = 3\r\n SAMPLE_TYPE = " +
      (bits == 8 ? "UNSIGNED_INTEGER" : "MSB_INTEGER") + "\r\n SAMPLE_BITS = " + std::to_string(bits) +
      "\r\n" + lines + "END_OBJECT = IMAGE\r\nEND\r\n";
  file.resize(1536, '\0');
  const auto size = static_cast<std::size_t>(bits / 8);
  for (std::size_t i = 0; i < 6; ++i) file[1024 + size * i + size - 1] = static_cast<char>(i);
  return file;
}

// GDAL keeps the unit of a PDS3 label to itself.
TEST_F(RasterFileTest, ThePds3LabelHasTheUnit) {
  const auto make_map = [&](const std::string& lines) {
    return read_image(folder.write("dem.img", pds3(16, lines)), false);
  };
  const ImageFile map = make_map(" UNIT = \"KILOMETER\"\r\n SCALING_FACTOR = 0.5\r\n");
  ASSERT_TRUE(map.scale.has_value());
  EXPECT_TRUE(map.scale->heights);
  EXPECT_NEAR(map.planes[0].values[5] - map.planes[0].values[0], 2500.0, 1e-9);
  EXPECT_NEAR(make_map(" UNIT = METER\r\n").planes[0].values[5], 5.0, 1e-9);
  EXPECT_FALSE(make_map(" UNIT = \"KM/S\"\r\n").scale.has_value());
}

TEST_F(RasterFileTest, BlanksBehindALabelTakeNoStack) {
  std::string file = pds3(16, "");
  file.replace(file.size() - 400, 1, 70000, ' ');
  file[file.size() - 500] = '\n';
  EXPECT_EQ(read_image(folder.write("dem.img", file), false).planes[0].values.size(), 6u);
}

TEST_F(RasterFileTest, BlackIsMissingWhereThePds3LabelSaysSo) {
  const auto missing = [&](const std::string& lines) {
    return missing_share(read_image(folder.write("p.img", pds3(8, lines)), false).planes[0]);
  };
  EXPECT_EQ(missing(""), 0.0);
  EXPECT_NEAR(missing(" MISSING_CONSTANT = 0\r\n"), 1.0 / 6.0, 1e-12);
}

TEST_F(RasterFileTest, FloatsOfAVaxAndLabelsAloneAreRefused) {
  std::string file = pds3(32, "");
  file.replace(file.find("MSB_INTEGER"), 11, "VAX_REAL   ");
  EXPECT_TRUE(has(error_message(folder.write("v.img", file)), "floats of a VAX (VAX_REAL)"));
  EXPECT_TRUE(has(error_message(folder.write("p.lbl", pds3(8, "", "(\"gone.img\", 1)"))),
                  "put the file that it names beside it"));
}

TEST_F(RasterFileTest, LabelsNameNoFilesOfOtherFolders) {
  const std::string pixels(512, '\1');
  fs::create_directory(folder / "other");
  folder.write("other/p.img", pixels);
  folder.write("p.img", pixels);
  const auto error = [&](const std::string& image) {
    return error_message(folder.write("p.lbl", pds3(8, "", "(\"" + image + "\", 1)")));
  };
  EXPECT_EQ(error("p.img"), "no error");
  EXPECT_TRUE(has(error("other/p.img"), "own folder"));
  folder.write("other/up.lbl", pds3(8, "", "(\"../p.img\", 1)"));
  EXPECT_TRUE(has(error_message(folder / "other/up.lbl"), "own folder"));
  EXPECT_TRUE(has(error_message(folder / "p.img"), "give " + (folder / "p.lbl").string()));
}

// A FITS file of 3 x 2 stored numbers of 16 bits.
std::string fits(const std::vector<int>& stored, const std::vector<std::string>& cards) {
  std::string file;
  const auto add = [&](std::string card) {
    card.resize(80, ' ');
    file += card;
  };
  for (const char* card :
       {"SIMPLE  =                    T", "BITPIX  =                   16", "NAXIS   =                    2",
        "NAXIS1  =                    3", "NAXIS2  =                    2"})
    add(card);
  for (const std::string& card : cards) add(card);
  add("END");
  file.resize(2880, ' ');
  for (const int number : stored) {
    file += static_cast<char>(number >> 8 & 255);
    file += static_cast<char>(number & 255);
  }
  file.resize(5760, '\0');
  return file;
}

TEST_F(RasterFileTest, FitsHasItsUnitAndItsBlanks) {
  const auto make_map = [&](const std::vector<int>& stored, const std::vector<std::string>& cards) {
    return read_image(folder.write("m.fits", fits(stored, cards)), false);
  };
  const ImageFile map =
      make_map({-32768, 1, 2, 3, 4, 5}, {"BLANK   =               -32768", "BUNIT   = 'km      '"});
  ASSERT_TRUE(map.scale.has_value());
  EXPECT_TRUE(map.scale->heights);
  EXPECT_NEAR(missing_share(map.planes[0]), 1.0 / 6.0, 1e-12);
  EXPECT_DOUBLE_EQ(*std::max_element(map.planes[0].values.begin(), map.planes[0].values.end()), 5000.0);
  // Unsigned numbers are stored from -32768.
  const std::string zero = "BZERO   =              32768.0";
  const ImageFile words = make_map({32767, -32768, 0, 0, 0, 0}, {zero});
  const auto [black, white] =
      std::minmax_element(words.planes[0].values.begin(), words.planes[0].values.end());
  EXPECT_DOUBLE_EQ(*black, 0.0);
  EXPECT_DOUBLE_EQ(*white, 1.0);
  const ImageFile gap = make_map({-32768, 1, 2, 3, 4, 5}, {zero, "BLANK   =               -32768"});
  EXPECT_NEAR(missing_share(gap.planes[0]), 1.0 / 6.0, 1e-12);
  // GDAL would cut off fractions.
  folder.write("half.fits", fits({0, 1, 2, 3, 4, 5}, {"BSCALE  =                  0.5"}));
  EXPECT_TRUE(has(error_message(folder / "half.fits"), "scaled integers"));
}

TEST_F(RasterFileTest, MarksCountAsStored) {
  write_raster(folder / "s.tif", {"GTiff", GDT_Int16}, {-9999, 10, 11, 12, 11, 10}, [](GDALDataset& raster) {
    raster.GetRasterBand(1)->SetScale(0.25);
    raster.GetRasterBand(1)->SetOffset(1000.0);
    raster.GetRasterBand(1)->SetUnitType("metres above the ellipsoid");
  });
  const ImageFile map = read_image(folder / "s.tif", false);
  EXPECT_NEAR(missing_share(map.planes[0]), 1.0 / 6.0, 1e-12);
  ASSERT_EQ(map.remarks.size(), 1u);
  EXPECT_TRUE(has(map.remarks[0], "-9999 lies"));
  EXPECT_TRUE(map.scale->heights);
  EXPECT_EQ(map.scale->height_source, "unit \"metres above the ellipsoid\"");
  write_raster(folder / "far.tif", {"GTiff", GDT_Int32}, {-2000000000, 10, 11, 12, 11, 10},
               [](GDALDataset& raster) { raster.GetRasterBand(1)->SetScale(10.0); });
  EXPECT_TRUE(has(error_message(folder / "far.tif"), "-a_nodata -2000000000)"));
}

TEST_F(RasterFileTest, AnUnknownUnitIsSaid) {
  const auto unit = [](const char* name) {
    return [name](GDALDataset& raster) {
      place(raster, 0.5);
      raster.GetRasterBand(1)->SetUnitType(name);
    };
  };
  EXPECT_TRUE(read({"GTiff", GDT_Float32}, kSteps, unit("m (MSL)")).scale->heights);
  for (const char* name : {"m s-1", "m/s", "parsec"}) {
    const ImageFile map = read({"GTiff", GDT_Float32}, kSteps, unit(name));
    EXPECT_FALSE(map.scale->heights) << name;
    ASSERT_EQ(map.remarks.size(), 1u);
    EXPECT_TRUE(has(map.remarks[0], std::string("\"") + name + "\" is no length")) << map.remarks[0];
  }
}

TEST_F(RasterFileTest, APixelWithoutOneColourIsMissing) {
  std::vector<double> values(18, 0.5);
  values[7] = std::numeric_limits<double>::quiet_NaN();
  write_raster(folder / "c.tif", {"GTiff", GDT_Float32, 3, 2, 3, {"PHOTOMETRIC=RGB"}}, values);
  for (const GreyImage& plane : read_image(folder / "c.tif", true).planes)
    EXPECT_EQ(plane.missing, (std::vector<bool>{false, true, false, false, false, false}));
}

TEST_F(RasterFileTest, HeightsUnderPremultipliedAlphaAreNotDivided) {
  std::vector<double> values{-3, 20, 30, 40, 50, 60, 1, 1, 0.5, 1, 1, 1};
  write_raster(folder / "h.tif", {"GTiff", GDT_Float32, 3, 2, 2, {"ALPHA=PREMULTIPLIED"}}, values);
  expect_values(read_image(folder / "h.tif", false).planes[0], {-3, 20, 30, 40, 50, 60});
}

TEST_F(RasterFileTest, OneHugeTileIsRefused) {
  write_raster(folder / "t.tif",
               {"GTiff",
                GDT_Float64,
                64,
                64,
                1,
                {"TILED=YES", "BLOCKXSIZE=2048", "BLOCKYSIZE=2048", "SPARSE_OK=TRUE"}},
               std::vector<double>(4096, 1.0));
  EXPECT_TRUE(has(error_message(folder / "t.tif"), "tiles are much larger"));
}

TEST_F(RasterFileTest, AGlobeInDegreesNeedsAFrame) {
  const auto like_degrees = [&](double west, double side) {
    return read({"GTiff", GDT_Float32, 36, 18}, std::vector<double>(648, 1.0),
                [&](GDALDataset& raster) {
                  std::array<double, 6> transform{west, side, 0.0, 90.0, 0.0, -side};
                  raster.SetGeoTransform(transform.data());
                })
        .scale->like_degrees;
  };
  EXPECT_TRUE(like_degrees(0.0, 10.0));
  EXPECT_TRUE(like_degrees(-180.0, 10.0));
  EXPECT_FALSE(like_degrees(0.0, 1.0));
  EXPECT_FALSE(like_degrees(0.0, 20.0));
}

TEST_F(RasterFileTest, ReadingHeedsAStop) {
  write_raster(folder / "h.tif", {}, kSteps);
  EXPECT_THROW(read_image(folder / "h.tif", false, [](double, std::string_view) { return false; }),
               WorkError);
}

TEST_F(RasterFileTest, JpegOf2000IsRead) {
  std::vector<double> values;
  for (int i = 0; i < 64 * 64; ++i) values.push_back(i % 251 * 16);
  const fs::path file = write_raster(
      folder / "j.jp2", {"JP2OpenJPEG", GDT_UInt16, 64, 64, 1, {"QUALITY=100", "REVERSIBLE=YES"}}, values);
  const GreyImage image = read_image(file, false).planes[0];
  EXPECT_DOUBLE_EQ(image.values[77], 77 * 16 / 65535.0);
}

TEST_F(RasterFileTest, WhatNoReaderShouldGuessIsRefused) {
  write_raster(folder / "complex.tif", {"GTiff", GDT_CFloat32}, kSteps);
  EXPECT_TRUE(has(error_message(folder / "complex.tif"), "complex"));
  write_raster(folder / "five.tif", {"GTiff", GDT_Byte, 3, 2, 5}, std::vector<double>(30, 1.0));
  EXPECT_TRUE(has(error_message(folder / "five.tif"), "5 bands"));
  write_raster(folder / "two.tif", {"GTiff", GDT_Float32, 3, 2, 2}, std::vector<double>(12, 1.0));
  EXPECT_TRUE(has(error_message(folder / "two.tif"), "2 bands"));
  write_raster(folder / "gaps.tif", {"GTiff", GDT_Float32}, {0, 0, 0, 0, 5, 6},
               [](GDALDataset& raster) { raster.GetRasterBand(1)->SetNoDataValue(0); });
  EXPECT_TRUE(has(error_message(folder / "gaps.tif"), "67 %"));
  EXPECT_TRUE(has(error_message(folder.write(
                      "list.vrt", "<VRTDataset rasterXSize=\"9\" rasterYSize=\"9\"></VRTDataset>")),
                  "first bytes"));
}

TEST_F(RasterFileTest, AHeaderSpeaksForItsOwnFileAlone) {
  const std::string envi =
      "ENVI\nsamples = 2\nlines = 2\nbands = 1\nheader offset = 0\nfile type = ENVI Standard\n"
      "data type = 1\ninterleave = bsq\nbyte order = 0\n";
  const std::string ehdr = "NROWS 2\nNCOLS 2\nNBANDS 1\nNBITS 8\nBYTEORDER I\nLAYOUT BIL\n";
  for (const std::string& header : {envi, ehdr}) {
    const fs::path png = write_raster(folder / "site.png", {"PNG", GDT_Byte}, {0, 51, 102, 153, 204, 255});
    folder.write("site.hdr", header);
    expect_values(read_image(png, false).planes[0], {0.0, 0.2, 0.4, 0.6, 0.8, 1.0});
    EXPECT_TRUE(has(error_message(folder.write("site.dat", "123456")), "states 4 bytes of 6"));
    EXPECT_EQ(read_image(folder.write("site.dat", "1234"), false).planes[0].values.size(), 4u);
    fs::remove(folder / "site.png");
    fs::remove(folder / "site.dat");
  }
}

TEST_F(RasterFileTest, WhatStandsInASidecarCounts) {
  const fs::path file = write_raster(folder / "a.tif", {"GTiff", GDT_Int16}, {-100, 10, 20, 30, 20, 10},
                                     [](GDALDataset& raster) { place(raster, 2.0); });
  folder.write("a.tif.aux.xml",
               "<PAMDataset><PAMRasterBand band=\"1\"><NoDataValue>-100</NoDataValue><UnitType>dm</UnitType>"
               "<Offset>5</Offset><Scale>2</Scale></PAMRasterBand></PAMDataset>");
  const ImageFile map = read_image(file, false);
  EXPECT_EQ(map.planes[0].missing, (std::vector<bool>{true, false, false, false, false, false}));
  EXPECT_NEAR(map.planes[0].values[3] - map.planes[0].values[1], 4.0, 1e-9);
}

TEST_F(RasterFileTest, AFloorIsGroundWhereTheFileNamesItsGaps) {
  for (const double floor : {0.0, 9999.0, -9999.0}) {
    const ImageFile map =
        read({"GTiff", GDT_Float32}, {floor, 310, 311, 312, 311, floor}, [](GDALDataset& raster) {
          place(raster, 2.0);
          raster.GetRasterBand(1)->SetNoDataValue(-32768.0);
        });
    EXPECT_EQ(missing_share(map.planes[0]), 0.0) << floor;
    ASSERT_EQ(map.remarks.size(), 1u);
    EXPECT_TRUE(has(map.remarks[0], "counts, since the file names other gaps")) << map.remarks[0];
  }
}

TEST(HeightUnit, HasManySpellings) {
  const double survey = 1200.0 / 3937.0;
  for (const char* name :
       {"US survey foot", "US_survey_foot", "U.S. survey feet", "usft", "ftUS", "Foot_US", "us-ft",
        "survey feet", "US survey feet (NAVD88)", "US survey feet above sea level"})
    EXPECT_DOUBLE_EQ(unit_metres(name), survey) << name;
  for (const char* name : {"ft", "Feet", "foot", "international foot", "feet above the ellipsoid"})
    EXPECT_DOUBLE_EQ(unit_metres(name), 0.3048) << name;
  EXPECT_DOUBLE_EQ(unit_metres("dm"), 0.1);
  EXPECT_DOUBLE_EQ(unit_metres("Decimetres"), 0.1);
  EXPECT_DOUBLE_EQ(unit_metres("inches"), 0.0254);
  EXPECT_DOUBLE_EQ(unit_metres("[m]"), 1.0);
  EXPECT_DOUBLE_EQ(unit_metres("m (MSL)"), 1.0);
  EXPECT_DOUBLE_EQ(unit_metres("KILOMETER"), 1000.0);
  for (const char* name : {"m s-1", "m/s", "us", "parsec", "metres per pixel", "foo above m", ""})
    EXPECT_EQ(unit_metres(name), 0.0) << name;
}

TEST_F(RasterFileTest, TheCallerMayStateTheUnit) {
  const fs::path file = write_raster(folder / "h.tif", {"GTiff", GDT_UInt16}, {0, 10, 20, 30, 40, 50});
  const ImageFile map = read_image(file, false, {}, {"ft", {}});
  EXPECT_TRUE(map.scale->heights);
  EXPECT_NEAR(map.planes[0].values[5] - map.planes[0].values[0], 50 * 0.3048, 1e-9);
}

TEST_F(RasterFileTest, APlaneInFeetIsSaidOfHeightsWithoutAUnit) {
  const ImageFile map = read({"GTiff", GDT_Float32}, kSteps, [](GDALDataset& raster) {
    place(raster, 10.0, "+proj=eqc +R=1737400 +units=us-ft");
  });
  EXPECT_NEAR(map.scale->pixel_width, 12000.0 / 3937.0, 1e-9);
  EXPECT_TRUE(has(map.scale->height_source, "--height-unit says another")) << map.scale->height_source;
}

// Rows from the south, and columns from the east, are turned; the values are those of the ground.
TEST_F(RasterFileTest, NorthIsAboveAndEastToTheRight) {
  const auto values = [&](double x, double y) {
    return read({"GTiff", GDT_Float32}, {0, 1, 2, 3, 4, 10},
                [&](GDALDataset& raster) {
                  std::array<double, 6> transform{100.0, x, 0.0, 200.0, 0.0, y};
                  raster.SetGeoTransform(transform.data());
                })
        .planes[0]
        .values;
  };
  const auto steps = [](const std::vector<double>& v) {
    return std::vector<double>{v[1] - v[0], v[2] - v[0], v[3] - v[0], v[4] - v[0], v[5] - v[0]};
  };
  EXPECT_EQ(steps(values(2, -2)), (std::vector<double>{1, 2, 3, 4, 10}));
  EXPECT_EQ(steps(values(2, 2)), (std::vector<double>{1, 7, -3, -2, -1}));
  EXPECT_EQ(steps(values(-2, -2)), (std::vector<double>{-1, -2, 8, 2, 1}));
  EXPECT_EQ(steps(values(-2, 2)), (std::vector<double>{-6, -7, -8, -9, -10}));
}

TEST_F(RasterFileTest, ArcGridsMayBeginWithNan) {
  const auto grid = [&](const std::string& rows) {
    return read_image(
               folder.write("a.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 2\n" + rows),
               false)
        .planes[0];
  };
  const GreyImage image = grid("nan 1.5 2\n3 4 5\n");
  EXPECT_EQ(image.missing, (std::vector<bool>{true, false, false, false, false, false}));
  EXPECT_NEAR(image.values[5] - image.values[1], 3.5, 1e-6);
  EXPECT_NEAR(missing_share(grid("NaN 1 2\n3 NaN 5\n")), 1.0 / 3.0, 1e-12);
}

TEST_F(RasterFileTest, ListsOfTilesNameFilesOfTheirOwnFolder) {
  write_raster(folder / "l.tif", {}, kSteps);
  fs::create_directory(folder / "other");
  write_raster(folder / "other" / "l.tif", {}, kSteps);
  const auto list = [&](const std::string& source, const std::string& relative = "1") {
    return folder.write(
        "a.vrt",
        "<VRTDataset rasterXSize=\"3\" rasterYSize=\"2\"><VRTRasterBand dataType=\"Float32\" "
        "band=\"1\"><SimpleSource><SourceFilename relativeToVRT=\"" +
            relative + "\">" + source +
            "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>");
  };
  expect_values(read_image(list("l.tif"), false).planes[0], kSteps);
  EXPECT_TRUE(has(error_message(list("other/l.tif")), "own folder"));
  EXPECT_TRUE(has(error_message(list((folder / "l.tif").string(), "0")), "own folder"));
  EXPECT_TRUE(has(error_message(list("/vsicurl/http://localhost/l.tif")), "own folder"));
  folder.write("inner.vrt", "<VRTDataset rasterXSize=\"3\" rasterYSize=\"2\"></VRTDataset>");
  EXPECT_TRUE(has(error_message(list("inner.vrt")), "own folder"));
}

TEST_F(RasterFileTest, NumbersAloneNeedTheirSize) {
  const fs::path file = folder.write("a.r16", std::string("\0\0\1\0\0\1\1\1\2\1\3\1", 12));
  EXPECT_TRUE(has(error_message(file), "--raw-size"));
  const ImageFile map = read_image(file, false, {}, {"m", ImageSize{3, 2}});
  EXPECT_NEAR(map.planes[0].values[5] - map.planes[0].values[0], 259.0, 1e-9);
  EXPECT_TRUE(has(testing::refusal_text([&] {
                    read_image(file, false, {}, {"m", ImageSize{2, 2}});
                  }),
                  "has 12 bytes, and 2 x 2 pixels would take 8"));
}

// Waves of 12 m along x and along y, in pixels of 2 by 3 m.
TEST(SquarePixels, KeepWavesAndGaps) {
  GreyImage image{90, 60, {}, std::vector<bool>(5400, false)};
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 90; ++x)
      image.values.push_back(std::sin((2 * x + 1) * std::acos(-1.0) / 6) +
                             std::sin((3 * y + 1.5) * std::acos(-1.0) / 6));
  }
  image.missing[0] = image.missing[1] = true;
  const GreyImage square = with_square_pixels(image, 2.0, 3.0);
  ASSERT_EQ(square.width, 60);
  ASSERT_EQ(square.height, 60);
  for (int y = 5; y < 55; ++y) {
    for (int x = 5; x < 55; ++x)
      EXPECT_NEAR(
          square.at(x, y),
          std::sin((3 * x + 1.5) * std::acos(-1.0) / 6) + std::sin((3 * y + 1.5) * std::acos(-1.0) / 6),
          0.06);
  }
  EXPECT_TRUE(square.missing[0] && !square.missing[2]);
  EXPECT_EQ(with_square_pixels(with_square_pixels(image, 3.0, 2.0), 1.0, 1.0).width, 90);
}

// The first picture of a raw file is a thumbnail, and the true one is another.
TEST_F(RasterFileTest, RawFilesOfCamerasAreRefused) {
  const std::vector<std::uint8_t> thumbnail(64, 7);
  write_tiff(folder / "a.dng", 8, 1, thumbnail, [](TIFF* tiff) {
    const std::uint8_t version[] = {1, 4, 0, 0};
    TIFFSetField(tiff, TIFFTAG_DNGVERSION, version);
  });
  EXPECT_TRUE(has(error_message(folder / "a.dng"), "raw file"));
  write_tiff(folder / "a.nef", 8, 1, thumbnail,
             [](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, FILETYPE_REDUCEDIMAGE); });
  EXPECT_TRUE(has(error_message(folder / "a.nef"), "raw file"));
  std::string mark("II*\0\x10\0\0\0CR\2\0", 12);
  mark.resize(72, 'x');
  EXPECT_TRUE(has(error_message(folder.write("a.cr2", mark)), "raw file"));
}

TEST_F(RasterFileTest, PagesAreSaid) {
  TIFF* tiff = TIFFOpen((folder / "pages.tif").c_str(), "w");
  for (int page = 0; page < 2; ++page) {
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 1);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    std::uint8_t value = 51;
    TIFFWriteScanline(tiff, &value, 0);
    TIFFWriteDirectory(tiff);
  }
  TIFFClose(tiff);
  const ImageFile file = read_image(folder / "pages.tif", false);
  ASSERT_EQ(file.remarks.size(), 1u);
  EXPECT_TRUE(has(file.remarks[0], "first of several pages"));
}

// EXIF counts where row 0 and column 0 of the stored picture stand when it is upright.
TEST_F(RasterFileTest, EveryOrientationIsHonoured) {
  const std::vector<std::vector<double>> upright{
      {10, 20, 30, 40, 50, 60}, {30, 20, 10, 60, 50, 40}, {60, 50, 40, 30, 20, 10}, {40, 50, 60, 10, 20, 30},
      {10, 40, 20, 50, 30, 60}, {40, 10, 50, 20, 60, 30}, {60, 30, 50, 20, 40, 10}, {30, 60, 20, 50, 10, 40}};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    write_tiff(folder / "o.tif", 3, 1, {10, 20, 30, 40, 50, 60},
               [&](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_ORIENTATION, orientation); });
    const GreyImage image = read_image(folder / "o.tif", false).planes[0];
    EXPECT_EQ(image.width, orientation > 4 ? 2 : 3);
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(image.values[i] * 255.0, upright[static_cast<std::size_t>(orientation - 1)][i], 1e-9)
          << orientation;
  }
}

TEST(MissingGround, IsContinuedSmoothly) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  GreyImage slope{9, 9, {}};
  for (int i = 0; i < 81; ++i)
    slope.values.push_back(i % 9 >= 3 && i % 9 < 6 && i / 9 >= 3 && i / 9 < 6 ? nan : i % 9);
  fill_missing(slope);
  for (int i = 0; i < 81; ++i) EXPECT_NEAR(slope.values[static_cast<std::size_t>(i)], i % 9, 0.05) << i;
  EXPECT_NEAR(missing_share(slope), 9.0 / 81.0, 1e-12);
}

TEST(MissingGround, TheLargestPartHasNoGap) {
  GreyImage image{20, 12, std::vector<double>(240, 1.0), std::vector<bool>(240, false)};
  image.missing[5] = true;  // a hole of one pixel is no gap
  for (int y = 0; y < 12; ++y) {
    for (int x = 12; x < 16; ++x) image.missing[static_cast<std::size_t>(y * 20 + x)] = true;
  }
  const GreyImage part = largest_whole_part(image);
  EXPECT_EQ(part.width, 12);
  EXPECT_EQ(part.height, 12);
  EXPECT_TRUE(part.missing.empty());
}

}  // namespace
}  // namespace astrolith
