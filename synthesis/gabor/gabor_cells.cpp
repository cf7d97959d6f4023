#include "synthesis/gabor/gabor_cells.h"

#include <cmath>

#include "numerics/hash_random.h"

namespace astrolith {

void GaborCellCenters::find(std::span<const GaborCell> cells, const SurfaceBand& band,
                            const BodyGround& ground) {
  resize(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Vec3f p = gabor_cell_center(band, cells[i][0], cells[i][1], cells[i][2]);
    x[i] = p.x;
    y[i] = p.y;
    z[i] = p.z;
  }
  evaluate(ground, *this);
}

namespace {

// The cells of a brick that lie near the surface, as arrays.
struct NearCells {
  NearCells(const SurfaceBand& band, const GaborCellCenters& centers, const BrickCells& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (is_far_gabor_cell(band, -centers.distance[i])) continue;
      const GaborCell& c = cells[i];
      x[count] = c[0];
      y[count] = c[1];
      z[count] = c[2];
      hash[count] = gabor_cell_hash(band, c[0], c[1], c[2]);
      height[count] = -centers.distance[i];
      frame[count] = tangent_frame(centers.gradient(i));
      nx[count] = frame[count].n.x;
      ny[count] = frame[count].n.y;
      nz[count] = frame[count].n.z;
      ++count;
    }
  }

  std::size_t count = 0;
  std::array<int, kBrickVolume> x, y, z;
  std::array<std::uint32_t, kBrickVolume> hash;
  std::array<float, kBrickVolume> height, nx, ny, nz;
  std::array<TangentFrame, kBrickVolume> frame;
};

// The positions of the impulses of one number j in all cells, their heights above the surface, and the bits
// that choose their lobes and phases.
struct ImpulsePlaces {
  std::array<float, kBrickVolume> x, y, z, above;
  std::array<std::uint32_t, kBrickVolume> bits;
};

ASTROLITH_SIMD_CLONES void draw_places(const GaborDraw& draw, std::uint32_t j, std::size_t n,
                                       const int* __restrict cx, const int* __restrict cy,
                                       const int* __restrict cz, const std::uint32_t* __restrict cell_hash,
                                       const float* __restrict height, const float* __restrict nx,
                                       const float* __restrict ny, const float* __restrict nz,
                                       float* __restrict x, float* __restrict y, float* __restrict z,
                                       float* __restrict above, std::uint32_t* __restrict bits) {
  GaborDraw band;  // what places depend on, in registers
  band.cell = draw.cell;
  band.first_corner = draw.first_corner;
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t hash = hash_append(cell_hash[i], j);
    const Vec3f center = gabor_cell_center(band, cx[i], cy[i], cz[i]);
    const Vec3f p = point_in_gabor_cell(band, hash, cx[i], cy[i], cz[i]);
    x[i] = p.x;
    y[i] = p.y;
    z[i] = p.z;
    above[i] = height_in_gabor_cell(height[i], nx[i], ny[i], nz[i], center, p);
    bits[i] = hash_append(hash, 0);
  }
}

}  // namespace

std::vector<GaborImpulse> draw_cells(const SurfaceBand& band, const BodyGround& ground,
                                     const BrickCells& cells) {
  GaborCellCenters centers;
  centers.find(cells, band, ground);
  const NearCells near(band, centers, cells);
  std::vector<GaborImpulse> impulses;
  if (near.count == 0) return impulses;
  std::vector<ImpulsePlaces> places(static_cast<std::size_t>(band.impulses_per_cell));
  for (std::size_t j = 0; j < places.size(); ++j) {
    ImpulsePlaces& p = places[j];
    draw_places(band, static_cast<std::uint32_t>(j), near.count, near.x.data(), near.y.data(), near.z.data(),
                near.hash.data(), near.height.data(), near.nx.data(), near.ny.data(), near.nz.data(),
                p.x.data(), p.y.data(), p.z.data(), p.above.data(), p.bits.data());
  }
  impulses.reserve(near.count * places.size());
  const GaborLobeShare* lobes = ground.arrays[band.lobes];
  for (std::size_t i = 0; i < near.count; ++i) {
    for (const ImpulsePlaces& p : places) {
      if (math::abs(p.above[i]) > band.farthest) continue;
      impulses.push_back(gabor_impulse(band.a, {p.x[i], p.y[i], p.z[i]}, near.frame[i],
                                       pick_lobe(lobes, band.lobes.count, p.bits[i]),
                                       bits_to_phase(p.bits[i])));
    }
  }
  return impulses;
}

}  // namespace astrolith
