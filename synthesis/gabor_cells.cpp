#include "synthesis/gabor_cells.h"

#include <cmath>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

struct Frame {
  Vec3f u, v, n;
};

// East, south and outward for a body whose field grows along `inward`; where the normal is within a degree of
// the z axis, x takes the place of east. Any unit vectors do where there is no gradient.
Frame tangent_frame(const Vec3f& inward) {
  const float length = math::sqrt(dot(inward, inward));
  const Vec3f n = length > 1e-18f ? inward * (-1.0f / length) : Vec3f{0.0f, 0.0f, 1.0f};
  const bool polar = n.x * n.x + n.y * n.y < 3e-4f;
  const Vec3f east = polar ? Vec3f{1.0f - n.x * n.x, -n.x * n.y, -n.x * n.z} : Vec3f{-n.y, n.x, 0.0f};
  const Vec3f u = east * (1.0f / math::sqrt(dot(east, east)));
  return {u, cross(u, n), n};
}

Vec3f cell_center(const GaborCell& c, float cell) {
  return {(static_cast<float>(c[0]) + 0.5f) * cell, (static_cast<float>(c[1]) + 0.5f) * cell,
          (static_cast<float>(c[2]) + 0.5f) * cell};
}

// Ten bits of a hash place an impulse along each axis, to a thousandth of a cell.
Vec3f point_in_cell(std::uint32_t hash, const GaborCell& c, float cell) {
  const auto at = [&](std::size_t axis, int shift) {
    const std::uint32_t bits = (hash >> shift) & 1023u;
    return (static_cast<float>(c[axis]) + (static_cast<float>(bits) + 0.5f) * 0x1p-10f) * cell;
  };
  return {at(0, 2), at(1, 12), at(2, 22)};
}

GaborImpulse make_impulse(const SurfaceBand& band, const Vec3f& p, const Frame& f, std::uint32_t hash) {
  // Sixteen bits choose the lobe, sixteen the phase.
  const std::uint32_t bits = hash_append(hash, 0);
  const GaborBand::Lobe& lobe = band.band.draw(static_cast<float>(bits >> 16) * 0x1p-16f);
  const float a = band.a;
  return {p.x,
          p.y,
          p.z,
          a * f.u.x,
          a * f.u.y,
          a * f.u.z,
          a * f.v.x,
          a * f.v.y,
          a * f.v.z,
          a * f.n.x,
          a * f.n.y,
          a * f.n.z,
          lobe.frequency_x,
          lobe.frequency_y,
          static_cast<float>(bits & 0xffffu) * 0x1p-16f};
}

// The impulses of one cell, whose centre is `height` outside the surface.
void draw_cell(const SurfaceBand& band, const GaborCell& c, float height, const Vec3f& inward,
               std::vector<GaborImpulse>& impulses) {
  if (std::fabs(height) > band.farthest + band.cell) return;
  const Frame frame = tangent_frame(inward);
  const Vec3f center = cell_center(c, band.cell);
  const std::uint32_t cell_hash = hash_cell(band.seed, c[0], c[1], c[2]);
  for (int j = 0; j < band.impulses_per_cell; ++j) {
    const std::uint32_t hash = hash_append(cell_hash, static_cast<std::uint32_t>(j));
    const Vec3f p = point_in_cell(hash, c, band.cell);
    const float above = height + dot(frame.n, p - center);
    if (!(std::fabs(above) > band.farthest)) impulses.push_back(make_impulse(band, p, frame, hash));
  }
}

// Centres of cells and the body's field there.
struct Centers {
  std::vector<float> x, y, z, distance, gx, gy, gz;

  Centers(std::span<const GaborCell> cells, float side, const PreparedBody& body) {
    Box box;
    for (const GaborCell& c : cells) {
      const Vec3f p = cell_center(c, side);
      box.extend({p.x, p.y, p.z});
      x.push_back(p.x);
      y.push_back(p.y);
      z.push_back(p.z);
    }
    for (std::vector<float>* v : {&distance, &gx, &gy, &gz}) v->resize(x.size());
    evaluate_body(body_reaching(body, box), static_cast<int>(x.size()), x.data(), y.data(), z.data(),
                  distance.data(), gx.data(), gy.data(), gz.data());
  }
};

}  // namespace

std::vector<GaborImpulse> draw_cells(const SurfaceBand& band, const PreparedBody& body,
                                     std::span<const GaborCell> cells) {
  const Centers centers(cells, band.cell, body);
  std::vector<GaborImpulse> impulses;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    draw_cell(band, cells[i], -centers.distance[i], {centers.gx[i], centers.gy[i], centers.gz[i]}, impulses);
  }
  return impulses;
}

}  // namespace astrolith
