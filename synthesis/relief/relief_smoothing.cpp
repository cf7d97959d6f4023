#include "synthesis/relief/relief_smoothing.h"

#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>

#include "numerics/host_device.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr int kMostFields = 3;

Vec3d along_axes(const ReliefPlace& place, double along, double u, double v) {
  double of[3];
  of[place.axis] = along;
  of[(place.axis + 1) % 3] = u;
  of[(place.axis + 2) % 3] = v;
  return {of[0], of[1], of[2]};
}

// Places in the order of their cells, and fields at them. Floats have the digits that a mean of many needs.
struct SortedPlaces {
  std::vector<float> x, y, z, nx, ny, nz, weight;
  std::array<std::vector<float>, kMostFields> fields;

  SortedPlaces(std::size_t count, std::size_t num_fields) {
    for (std::vector<float>* column : {&x, &y, &z, &nx, &ny, &nz, &weight}) column->resize(count);
    for (std::size_t f = 0; f < num_fields; ++f) fields[f].resize(count);
  }
  void set(std::size_t k, const Vec3f& at, const Vec3f& normal, float w) {
    x[k] = at.x, y[k] = at.y, z[k] = at.z;
    nx[k] = normal.x, ny[k] = normal.y, nz[k] = normal.z;
    weight[k] = w;
  }
};

SortedPlaces sort_places(const ReliefPoints& points, std::span<const std::vector<double>> values) {
  const std::vector<std::uint32_t>& order = points.order();
  SortedPlaces sorted(order.size(), values.size());
  parallel_for(
      0, static_cast<std::int64_t>(order.size()),
      [&](std::int64_t number) {
        const auto k = static_cast<std::size_t>(number);
        const std::uint32_t i = order[k];
        sorted.set(k, to_float(points.at(i)), to_float(points.normal(i)),
                   static_cast<float>(points.weight(i)));
        for (std::size_t f = 0; f < values.size(); ++f)
          sorted.fields[f][k] = static_cast<float>(values[f][i]);
      },
      4096);
  return sorted;
}

// The places of each cell that look along the same axis to the same side, as one. A mean much wider than a
// cell hardly changes: weights and normals count linearly in it, and only the squared distance is that of the
// middle.
struct PooledPlaces {
  SortedPlaces pools;
  // The number of a cell's first pool, at the place of the cell in the order of places, and at the end.
  std::vector<std::uint32_t> first;

  PooledPlaces(const ReliefPoints& points, std::span<const std::vector<double>> values)
      : pools(0, values.size()), first(points.order().size() + 1, 0) {
    for (std::size_t c = 0; c < points.cells(); ++c) {
      first[points.first_in_cell(c)] = static_cast<std::uint32_t>(pools.x.size());
      add_cell(points, values, points.first_in_cell(c), points.first_in_cell(c + 1));
    }
    first.back() = static_cast<std::uint32_t>(pools.x.size());
  }

 private:
  static std::size_t side_of(const Vec3d& n) {
    const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
    const std::size_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const double along = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
    return 2 * axis + (along < 0.0 ? 1 : 0);
  }

  void add_cell(const ReliefPoints& points, std::span<const std::vector<double>> values, std::uint32_t from,
                std::uint32_t end) {
    struct Sums {
      double weight = 0.0;
      Vec3d at, normal;
      std::array<double, kMostFields> fields{};
    };
    std::array<Sums, 6> sides;
    for (std::uint32_t k = from; k < end; ++k) {
      const std::uint32_t i = points.order()[k];
      const double weight = points.weight(i);
      Sums& side = sides[side_of(points.normal(i))];
      side.weight += weight;
      side.at += weight * points.at(i);
      side.normal += weight * points.normal(i);
      for (std::size_t f = 0; f < values.size(); ++f) side.fields[f] += weight * values[f][i];
    }
    for (const Sums& side : sides) {
      if (!(side.weight > 0.0)) continue;
      const double by = 1.0 / side.weight;
      const std::size_t k = pools.x.size();
      for (std::vector<float>* column :
           {&pools.x, &pools.y, &pools.z, &pools.nx, &pools.ny, &pools.nz, &pools.weight})
        column->resize(k + 1);
      pools.set(k, to_float(by * side.at), to_float(by * side.normal), static_cast<float>(side.weight));
      for (std::size_t f = 0; f < values.size(); ++f)
        pools.fields[f].push_back(static_cast<float>(by * side.fields[f]));
    }
  }
};

// Places whose means are taken together, and the sums around them.
struct LaneSums {
  static constexpr int kLanes = 16;
  float x[kLanes], y[kLanes], z[kLanes], nx[kLanes], ny[kLanes], nz[kLanes];
  float total[kLanes] = {}, sums[kMostFields][kLanes] = {};
};

// Adds the places `first` to `end` - 1 to the sums. A place beyond the radius, or that faces the other side,
// adds exactly nothing.
ASTROLITH_SIMD_CLONES void add_places(const SortedPlaces& p, std::uint32_t first, std::uint32_t end,
                                      bool three_fields, float squared_radius, float inverse,
                                      LaneSums& lanes) {
  LaneSums l = lanes;  // so that the compiler keeps it in registers
  const float* fields[kMostFields];
  for (std::size_t f = 0; f < kMostFields; ++f) fields[f] = p.fields[three_fields ? f : 0].data();
  for (std::uint32_t k = first; k < end; ++k) {
    const float x = p.x[k], y = p.y[k], z = p.z[k], nx = p.nx[k], ny = p.ny[k], nz = p.nz[k],
                place_weight = p.weight[k], value0 = fields[0][k], value1 = fields[1][k],
                value2 = fields[2][k];
#pragma omp simd
    for (int i = 0; i < LaneSums::kLanes; ++i) {
      const float dx = x - l.x[i], dy = y - l.y[i], dz = z - l.z[i];
      const float squared = dx * dx + dy * dy + dz * dz;
      const float facing = nx * l.nx[i] + ny * l.ny[i] + nz * l.nz[i];
      const float near = 1.0f - squared * inverse, square = near * near;
      const float any = square * square * facing * place_weight;
      const float within = squared < squared_radius ? any : 0.0f, weight = facing > 0.0f ? within : 0.0f;
      l.total[i] += weight;
      l.sums[0][i] += weight * value0;
      l.sums[1][i] += weight * value1;
      l.sums[2][i] += weight * value2;
    }
  }
  lanes = l;
}

// Means of the fields around the places of every `stride`th cell, at their numbers; the others are 0.
ThreeFields smoothed(const ReliefPoints& points, std::span<const std::vector<double>> fields, double sigma,
                     std::size_t stride) {
  const double radius = std::sqrt(8.0) * sigma;
  const auto squared_radius = static_cast<float>(radius * radius), inverse = 1.0f / squared_radius;
  constexpr double kWide = 1.75;  // cells: from this deviation on, pools do
  const SortedPlaces sorted = sort_places(points, fields);
  std::optional<PooledPlaces> pooled;
  if (sigma >= kWide * points.cell_side()) pooled.emplace(points, fields);
  const std::vector<std::uint32_t>& order = points.order();
  ThreeFields means;
  for (std::size_t f = 0; f < fields.size(); ++f) means[f].resize(points.size());
  const auto add_run = [&](std::uint32_t first, std::uint32_t count) {
    LaneSums lanes;
    Box box;
    for (std::uint32_t i = 0; i < LaneSums::kLanes; ++i) {
      const std::uint32_t k = first + std::min(i, count - 1);
      lanes.x[i] = sorted.x[k], lanes.y[i] = sorted.y[k], lanes.z[i] = sorted.z[k];
      lanes.nx[i] = sorted.nx[k], lanes.ny[i] = sorted.ny[k], lanes.nz[i] = sorted.nz[k];
      box.extend(points.at(order[k]));
    }
    points.for_each_row(box, radius, [&](std::uint32_t from, std::uint32_t end) {
      const bool three = fields.size() == kMostFields;
      if (pooled) {
        add_places(pooled->pools, pooled->first[from], pooled->first[end], three, squared_radius, inverse,
                   lanes);
      } else {
        add_places(sorted, from, end, three, squared_radius, inverse, lanes);
      }
    });
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t place = order[first + i];
      for (std::size_t f = 0; f < fields.size(); ++f) {
        means[f][place] =
            lanes.total[i] > 0.0f ? double{lanes.sums[f][i]} / double{lanes.total[i]} : fields[f][place];
      }
    }
  };
  parallel_for(
      0, static_cast<std::int64_t>((points.cells() + stride - 1) / stride),
      [&](std::int64_t number) {
        const std::size_t c = static_cast<std::size_t>(number) * stride;
        const std::uint32_t end = points.first_in_cell(c + 1);
        for (std::uint32_t first = points.first_in_cell(c); first < end; first += LaneSums::kLanes)
          add_run(first, std::min<std::uint32_t>(LaneSums::kLanes, end - first));
      },
      8);
  return means;
}

}  // namespace

ReliefPoints::ReliefPoints(const std::vector<ReliefPlace>& places, double spacing) : cell_(4.0 * spacing) {
  at_.reserve(places.size()), normals_.reserve(places.size()), weights_.reserve(places.size());
  Box box;
  for (const ReliefPlace& p : places) {
    at_.push_back(spacing * along_axes(p, double{p.w}, p.u, p.v));
    normals_.push_back(along_axes(p, double{p.normal.x}, double{p.normal.y}, double{p.normal.z}));
    weights_.push_back(p.weight / 65535.0);
    box.extend(at_.back());
  }
  cells_.push_back({0, 0});
  if (places.empty()) return;
  corner_ = {box.min.x, box.min.y, box.min.z};
  const Vec3d extent = box.extent();
  count_ = {1 + static_cast<std::int64_t>(extent.x / cell_), 1 + static_cast<std::int64_t>(extent.y / cell_),
            1 + static_cast<std::int64_t>(extent.z / cell_)};
  struct Keyed {
    std::int64_t row, x;
    std::uint32_t place;
  };
  std::vector<Keyed> keys(places.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Vec3d& p = at_[i];
    keys[i] = {cell(p.y, 1) + count_[1] * cell(p.z, 2), cell(p.x, 0), static_cast<std::uint32_t>(i)};
  }
  std::sort(keys.begin(), keys.end(), [](const Keyed& a, const Keyed& b) {
    return std::tie(a.row, a.x, a.place) < std::tie(b.row, b.x, b.place);
  });
  cells_.clear();
  order_.resize(keys.size());
  rows_.assign(static_cast<std::size_t>(count_[1] * count_[2]) + 1, 0);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    order_[k] = keys[k].place;
    if (k > 0 && keys[k].row == keys[k - 1].row && keys[k].x == keys[k - 1].x) continue;
    cells_.push_back({keys[k].x, static_cast<std::uint32_t>(k)});
    ++rows_[static_cast<std::size_t>(keys[k].row) + 1];
  }
  std::partial_sum(rows_.begin(), rows_.end(), rows_.begin());
  cells_.push_back({0, static_cast<std::uint32_t>(keys.size())});
}

std::vector<double> smoothed_heights(const ReliefPoints& points, const std::vector<double>& heights,
                                     double sigma) {
  return std::move(smoothed(points, {&heights, 1}, sigma, 1)[0]);
}

ThreeFields smoothed_fields(const ReliefPoints& points, const ThreeFields& fields, double sigma) {
  return smoothed(points, fields, sigma, 1);
}

SampledMeans sampled_means(const ReliefPoints& points, const ThreeFields& fields, double sigma) {
  constexpr std::size_t kEnoughCells = 4096;
  const std::size_t stride = std::max<std::size_t>(1, points.cells() / kEnoughCells);
  const ThreeFields means = smoothed(points, fields, sigma, stride);
  SampledMeans sampled;
  for (std::size_t c = 0; c < points.cells(); c += stride) {
    const auto first = points.order().begin() + points.first_in_cell(c),
               end = points.order().begin() + points.first_in_cell(c + 1);
    sampled.places.insert(sampled.places.end(), first, end);
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    for (const std::uint32_t place : sampled.places) sampled.means[f].push_back(means[f][place]);
  }
  return sampled;
}

}  // namespace astrolith
