#include "synthesis/relief/relief_smoothing.h"

#include <cmath>
#include <optional>
#include <span>

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

std::vector<Vec3d> places_in_space(const std::vector<ReliefPlace>& places, double spacing) {
  std::vector<Vec3d> at;
  at.reserve(places.size());
  for (const ReliefPlace& p : places) at.push_back(spacing * along_axes(p, double{p.w}, p.u, p.v));
  return at;
}

// Places in the order of their cells, and fields at them. Floats have the digits that a mean of many needs.
struct SortedPlaces {
  std::vector<float> x, y, z, nx, ny, nz, weight;
  std::array<std::vector<float>, kMostFields> fields;

  SortedPlaces(std::size_t count, std::size_t num_fields) : num_fields_(num_fields) { resize(count); }

  std::size_t size() const { return x.size(); }
  std::size_t num_fields() const { return num_fields_; }
  Vec3d at(std::size_t k) const { return {double{x[k]}, double{y[k]}, double{z[k]}}; }
  Vec3d normal(std::size_t k) const { return {double{nx[k]}, double{ny[k]}, double{nz[k]}}; }

  void resize(std::size_t count) {
    for (std::vector<float>* column : {&x, &y, &z, &nx, &ny, &nz, &weight}) column->resize(count);
    for (std::size_t f = 0; f < num_fields_; ++f) fields[f].resize(count);
  }
  void set(std::size_t k, const Vec3f& at, const Vec3f& normal, float w) {
    x[k] = at.x, y[k] = at.y, z[k] = at.z;
    nx[k] = normal.x, ny[k] = normal.y, nz[k] = normal.z;
    weight[k] = w;
  }
  SortedPlaces in_order(const std::vector<std::uint32_t>& order) const {
    SortedPlaces sorted(order.size(), num_fields_);
    for (std::size_t k = 0; k < order.size(); ++k) {
      sorted.set(k, to_float(at(order[k])), to_float(normal(order[k])), weight[order[k]]);
      for (std::size_t f = 0; f < num_fields_; ++f) sorted.fields[f][k] = fields[f][order[k]];
    }
    return sorted;
  }

 private:
  std::size_t num_fields_;
};

SortedPlaces sort_places(const ReliefPoints& points, std::span<const std::vector<double>> values) {
  const std::vector<std::uint32_t>& order = points.rows().order();
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

// Places that count as one: those in a part of a cell which look along the same axis to the same side. A mean
// much wider than the part hardly changes: weights and normals count linearly in it, and only the squared
// distance is that of the middle.
class Pools {
 public:
  // `places` are sorted by the cells, each of which is cut into parts^3 parts.
  Pools(const SortedPlaces& places, const CellRows& rows, int parts) : pools_(0, places.num_fields()) {
    std::vector<Sums> sums(static_cast<std::size_t>(6 * parts * parts * parts));
    for (std::size_t c = 0; c < rows.cells(); ++c) {
      first_.push_back(static_cast<std::uint32_t>(pools_.size()));
      for (std::uint32_t k = rows.first_in_cell(c); k < rows.first_in_cell(c + 1); ++k)
        sums[6 * rows.part_of(places.at(k), parts) + side_of(places.normal(k))].add(places, k);
      for (Sums& pool : sums) {
        if (pool.weight > 0.0) add(pool);
        pool = {};
      }
    }
    first_.push_back(static_cast<std::uint32_t>(pools_.size()));
  }

  const SortedPlaces& places() const { return pools_; }
  std::uint32_t first_in_cell(std::size_t c) const { return first_[c]; }

 private:
  struct Sums {
    double weight = 0.0;
    Vec3d at, normal;
    std::array<double, kMostFields> fields{};

    void add(const SortedPlaces& places, std::size_t k) {
      const double w = double{places.weight[k]};
      weight += w;
      at += w * places.at(k);
      normal += w * places.normal(k);
      for (std::size_t f = 0; f < places.num_fields(); ++f) fields[f] += w * double{places.fields[f][k]};
    }
  };

  static std::size_t side_of(const Vec3d& n) {
    const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
    const std::size_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const double along = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
    return 2 * axis + (along < 0.0 ? 1 : 0);
  }

  void add(const Sums& pool) {
    const double by = 1.0 / pool.weight;
    const std::size_t k = pools_.size();
    pools_.resize(k + 1);
    pools_.set(k, to_float(by * pool.at), to_float(by * pool.normal), static_cast<float>(pool.weight));
    for (std::size_t f = 0; f < pools_.num_fields(); ++f)
      pools_.fields[f][k] = static_cast<float>(by * pool.fields[f]);
  }

  SortedPlaces pools_;
  std::vector<std::uint32_t> first_;  // (cells + 1) the first pool of each cell
};

struct PlaceRange {
  std::uint32_t first, end;
};

// What a mean is taken of: the places, or pools of them as large as its width allows, with their cells.
class MeanSources {
 public:
  MeanSources(const ReliefPoints& points, const SortedPlaces& places, double sigma)
      : rows_(&points.rows()), places_(&places) {
    constexpr double kWide = 1.5;  // sides of a part: the least deviation of a mean of pools
    const double cells = sigma / (kWide * points.rows().side());
    if (cells < 0.5) return;
    pools_.emplace(places, *rows_, cells < 1.0 ? 2 : 1);
    places_ = &pools_->places();
    if (cells >= 2.0) widen();
  }

  const SortedPlaces& places() const { return *places_; }

  // Ranges of places() that hold all within `radius` of the points of a box.
  std::vector<PlaceRange> ranges_near(const Box& box, double radius) const {
    std::vector<PlaceRange> ranges;
    rows_->for_each_row(box, radius, [&](std::size_t first, std::size_t end) {
      ranges.push_back({first_in_cell(first), first_in_cell(end)});
    });
    return ranges;
  }

 private:
  std::uint32_t first_in_cell(std::size_t c) const {
    return pools_ ? pools_->first_in_cell(c) : rows_->first_in_cell(c);
  }

  // Pools the pools in cells of twice the side.
  void widen() {
    std::vector<Vec3d> at;
    for (std::size_t k = 0; k < places_->size(); ++k) at.push_back(places_->at(k));
    wide_rows_.emplace(at, 2.0 * rows_->side());
    const SortedPlaces sorted = places_->in_order(wide_rows_->order());
    rows_ = &*wide_rows_;
    pools_.emplace(sorted, *rows_, 1);
    places_ = &pools_->places();
  }

  const CellRows* rows_;
  const SortedPlaces* places_;
  std::optional<CellRows> wide_rows_;
  std::optional<Pools> pools_;
};

// Places whose means are taken together, and the sums around them.
struct LaneSums {
  static constexpr int kLanes = 16;
  float x[kLanes], y[kLanes], z[kLanes], nx[kLanes], ny[kLanes], nz[kLanes];
  float total[kLanes] = {}, sums[kMostFields][kLanes] = {};
};

// Adds the places of these ranges to the sums. A place beyond the radius, or that faces the other side, adds
// exactly nothing.
ASTROLITH_SIMD_CLONES void add_places(const SortedPlaces& p, std::span<const PlaceRange> ranges,
                                      float squared_radius, float inverse, LaneSums& lanes) {
  LaneSums l = lanes;  // so that the compiler keeps it in registers
  const float* fields[kMostFields];
  for (std::size_t f = 0; f < kMostFields; ++f) fields[f] = p.fields[f < p.num_fields() ? f : 0].data();
  for (const PlaceRange& range : ranges) {
    for (std::uint32_t k = range.first; k < range.end; ++k) {
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
  }
  lanes = l;
}

// Means of the fields around the places of every `stride`th cell, at their numbers; the others are 0.
ThreeFields smoothed(const ReliefPoints& points, std::span<const std::vector<double>> fields, double sigma,
                     std::size_t stride) {
  const double radius = std::sqrt(8.0) * sigma;
  const auto squared_radius = static_cast<float>(radius * radius), inverse = 1.0f / squared_radius;
  const SortedPlaces sorted = sort_places(points, fields);
  const MeanSources sources(points, sorted, sigma);
  const CellRows& rows = points.rows();
  const std::vector<std::uint32_t>& order = rows.order();
  ThreeFields means;
  for (std::size_t f = 0; f < fields.size(); ++f) means[f].resize(points.size());
  const auto add_run = [&](std::uint32_t first, std::uint32_t count, std::span<const PlaceRange> ranges) {
    LaneSums lanes;
    for (std::uint32_t i = 0; i < LaneSums::kLanes; ++i) {
      const std::uint32_t k = first + std::min(i, count - 1);
      lanes.x[i] = sorted.x[k], lanes.y[i] = sorted.y[k], lanes.z[i] = sorted.z[k];
      lanes.nx[i] = sorted.nx[k], lanes.ny[i] = sorted.ny[k], lanes.nz[i] = sorted.nz[k];
    }
    add_places(sources.places(), ranges, squared_radius, inverse, lanes);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t place = order[first + i];
      for (std::size_t f = 0; f < fields.size(); ++f) {
        means[f][place] =
            lanes.total[i] > 0.0f ? double{lanes.sums[f][i]} / double{lanes.total[i]} : fields[f][place];
      }
    }
  };
  parallel_for(
      0, static_cast<std::int64_t>((rows.cells() + stride - 1) / stride),
      [&](std::int64_t number) {
        const std::size_t c = static_cast<std::size_t>(number) * stride;
        const std::uint32_t begin = rows.first_in_cell(c), end = rows.first_in_cell(c + 1);
        Box box;
        for (std::uint32_t k = begin; k < end; ++k) box.extend(sorted.at(k));
        const std::vector<PlaceRange> ranges = sources.ranges_near(box, radius);
        for (std::uint32_t first = begin; first < end; first += LaneSums::kLanes)
          add_run(first, std::min<std::uint32_t>(LaneSums::kLanes, end - first), ranges);
      },
      8);
  return means;
}

}  // namespace

ReliefPoints::ReliefPoints(const std::vector<ReliefPlace>& places, double spacing)
    : at_(places_in_space(places, spacing)), rows_(at_, 4.0 * spacing) {
  normals_.reserve(places.size()), weights_.reserve(places.size());
  for (const ReliefPlace& p : places) {
    normals_.push_back(along_axes(p, double{p.normal.x}, double{p.normal.y}, double{p.normal.z}));
    weights_.push_back(p.weight / 65535.0);
  }
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
  const CellRows& rows = points.rows();
  const std::size_t stride = std::max<std::size_t>(1, rows.cells() / kEnoughCells);
  const ThreeFields means = smoothed(points, fields, sigma, stride);
  SampledMeans sampled;
  for (std::size_t c = 0; c < rows.cells(); c += stride) {
    const auto first = rows.order().begin() + rows.first_in_cell(c),
               end = rows.order().begin() + rows.first_in_cell(c + 1);
    sampled.places.insert(sampled.places.end(), first, end);
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    for (const std::uint32_t place : sampled.places) sampled.means[f].push_back(means[f][place]);
  }
  return sampled;
}

}  // namespace astrolith
