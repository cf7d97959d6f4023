// Small input files with known content, good and bad.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "numerics/hash_random.h"

namespace astrolith::testing {

inline const std::string kTetrahedronVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
inline const std::string kTetrahedron = kTetrahedronVertices + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
inline const std::string kInsideOut = kTetrahedronVertices + "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
// A triangle without area.
inline const std::string kFlatObj = "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n";

// An ellipsoid of half axes a, b, c as rings of quadrilaterals between two poles: closed, 2 x rings x sides
// triangles.
inline std::string ellipsoid_obj(double a, double b, double c, int rings, int sides) {
  std::string text = "v 0 0 " + std::to_string(c) + "\n";
  for (int i = 1; i <= rings; ++i) {
    const double theta = std::numbers::pi * i / (rings + 1);
    for (int j = 0; j < sides; ++j) {
      const double phi = 2 * std::numbers::pi * j / sides;
      text += "v " + std::to_string(a * std::sin(theta) * std::cos(phi)) + " " +
              std::to_string(b * std::sin(theta) * std::sin(phi)) + " " +
              std::to_string(c * std::cos(theta)) + "\n";
    }
  }
  text += "v 0 0 " + std::to_string(-c) + "\n";
  const auto vertex = [&](int ring, int side) { return std::to_string(2 + ring * sides + side % sides); };
  const std::string south = std::to_string(2 + rings * sides);
  for (int j = 0; j < sides; ++j) {
    text += "f 1 " + vertex(0, j) + " " + vertex(0, j + 1) + "\n";
    for (int i = 0; i + 1 < rings; ++i) {
      text += "f " + vertex(i, j) + " " + vertex(i + 1, j) + " " + vertex(i + 1, j + 1) + " " +
              vertex(i, j + 1) + "\n";
    }
    text += "f " + vertex(rings - 1, j) + " " + south + " " + vertex(rings - 1, j + 1) + "\n";
  }
  return text;
}

// A binary PLY whose header promises a tetrahedron and whose data end in the third vertex.
inline std::string truncated_ply() {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
      "float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  return text + std::string(30, '\1');
}

// An 8-bit grey PNG file's bytes.
inline std::string png(int width, int height, const std::vector<std::uint8_t>& grey) {
  png_image image;
  std::memset(&image, 0, sizeof image);
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_GRAY;
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string content(bytes, '\0');
  EXPECT_NE(png_image_write_to_memory(&image, content.data(), &bytes, 0, grey.data(), 0, nullptr), 0);
  content.resize(bytes);
  return content;
}

// A PNG that holds nothing but a header that states this size.
inline std::string png_header(std::uint32_t width, std::uint32_t height) {
  const auto big_endian = [](std::uint32_t v) {
    return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
                       static_cast<char>(v)};
  };
  const std::string chunk = "IHDR" + big_endian(width) + big_endian(height) + std::string("\x08\0\0\0\0", 5);
  std::uint32_t sum = ~0u;  // the CRC of the format
  for (const char c : chunk) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ ((sum & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return std::string("\x89PNG\r\n\x1a\n\0\0\0\r", 12) + chunk + big_endian(~sum) +
         std::string("\0\0\0\x20IDAT", 8) + std::string(16, '\0');
}

// Smooth noise: the mean of 4 x 4 independent pixels around each.
inline std::string noise_png(int side) {
  std::vector<std::uint8_t> grey(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      float sum = 0;
      for (int k = 0; k < 16; ++k) {
        sum += unit_float(hash_cell(5u, (x + k % 4) % side, (y + k / 4) % side, 0));
      }
      grey[static_cast<std::size_t>(y * side + x)] = static_cast<std::uint8_t>(sum * 255 / 16);
    }
  }
  return png(side, side, grey);
}

}  // namespace astrolith::testing
