#include "synthesis/mesh/mesh_components.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace astrolith {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

Vec3d in_double(const Vec3f& p) { return {p.x, p.y, p.z}; }

// Union-find with path halving over the vertices of one batch, with a label for each root.
class BatchSets {
 public:
  explicit BatchSets(std::size_t size) : parent_(size), label_(size, kNone) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t find(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void unite(std::uint32_t a, std::uint32_t b) { parent_[std::max(a, b)] = std::min(a, b); }
  std::uint32_t& label(std::uint32_t root) { return label_[root]; }

 private:
  std::vector<std::uint32_t> parent_, label_;
};

}  // namespace

std::uint32_t ComponentLabels::new_label() {
  parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
  return parent_.back();
}

std::uint32_t ComponentLabels::find_component(std::uint32_t label) const {
  while (parent_[label] != label) label = parent_[label];
  return label;
}

void ComponentLabels::unite(std::uint32_t a, std::uint32_t b) {
  a = find_component(a);
  b = find_component(b);
  if (a != b) parent_[std::max(a, b)] = std::min(a, b);
}

std::vector<std::uint32_t> ComponentLabels::label(std::size_t num_vertices,
                                                  std::span<const Triangle> triangles) {
  BatchSets sets(num_vertices);
  const auto join = [&](std::uint32_t u, std::uint32_t v) {
    if (u > v) std::swap(u, v);
    if (v < end_) return unite(labels_[u - first_], labels_[v - first_]);
    const std::uint32_t root = sets.find(v - end_);
    const bool both_new = u >= end_;
    const std::uint32_t other_root = both_new ? sets.find(u - end_) : root;
    const std::uint32_t other = both_new ? sets.label(other_root) : labels_[u - first_];
    const std::uint32_t mine = sets.label(root);
    if (mine != kNone && other != kNone) unite(mine, other);
    const std::uint32_t known = mine != kNone ? mine : other;
    if (both_new && root != other_root) sets.unite(root, other_root);
    sets.label(sets.find(root)) = known;
  };
  for (const Triangle& t : triangles) {
    join(t[0], t[1]);
    join(t[1], t[2]);
  }
  std::vector<std::uint32_t> labels(num_vertices);
  for (std::uint32_t v = 0; v < num_vertices; ++v) {
    std::uint32_t& label = sets.label(sets.find(v));
    if (label == kNone) label = new_label();
    labels[v] = label;
  }
  first_ = end_;
  end_ += static_cast<std::uint32_t>(num_vertices);
  labels_ = labels;
  return labels;
}

void ComponentSizes::add_vertices(std::span<const MeshVertex> vertices) {
  settle();
  for (const MeshVertex& v : vertices) batch_.push_back(v.position);
  if (!has_center_ && !batch_.empty()) {
    center_ = in_double(batch_.front());
    has_center_ = true;
  }
}

void ComponentSizes::add_triangles(std::span<const Triangle> triangles) {
  triangles_.insert(triangles_.end(), triangles.begin(), triangles.end());
}

void ComponentSizes::settle() {
  const auto batch_first = first_ + static_cast<std::uint32_t>(before_.size());
  const std::vector<std::uint32_t> labels = labels_.label(batch_.size(), triangles_);
  volumes_.resize(labels_.num_labels(), 0.0);
  const auto position = [&](std::uint32_t v) {
    return in_double(v < batch_first ? before_[v - first_] : batch_[v - batch_first]) - center_;
  };
  for (const Triangle& t : triangles_) {
    const std::uint32_t label =
        t[0] < batch_first ? labels_before_[t[0] - first_] : labels[t[0] - batch_first];
    volumes_[label] += dot(position(t[0]), cross(position(t[1]), position(t[2]))) / 6.0;
  }
  first_ = batch_first;
  labels_before_ = labels;
  before_ = std::move(batch_);
  batch_.clear();
  triangles_.clear();
}

ComponentChoice ComponentSizes::larger_than(double least_share) {
  settle();
  std::vector<double> volumes(volumes_.size(), 0.0);
  for (std::uint32_t label = 0; label < volumes.size(); ++label) {
    volumes[labels_.find_component(label)] += volumes_[label];
  }
  double largest = 0.0;
  for (const double volume : volumes) largest = std::max(largest, std::fabs(volume));
  ComponentChoice choice;
  for (std::uint32_t label = 0; label < volumes.size(); ++label) {
    const std::uint32_t component = labels_.find_component(label);
    const bool keep = std::fabs(volumes[component]) >= least_share * largest;
    choice.keep.push_back(keep ? 1 : 0);
    if (!keep && component == label) ++choice.dropped_components;
  }
  return choice;
}

void ComponentFilter::add_vertices(std::span<const MeshVertex> vertices) {
  settle();
  batch_.assign(vertices.begin(), vertices.end());
}

void ComponentFilter::add_triangles(std::span<const Triangle> triangles) {
  triangles_.insert(triangles_.end(), triangles.begin(), triangles.end());
}

void ComponentFilter::settle() {
  const std::vector<std::uint32_t> labels = labels_.label(batch_.size(), triangles_);
  numbers_.assign(batch_.size(), kNone);
  std::vector<MeshVertex> kept;
  for (std::size_t v = 0; v < batch_.size(); ++v) {
    if (choice_.keep[labels[v]] == 0) continue;
    numbers_[v] = kept_++;
    kept.push_back(batch_[v]);
  }
  const auto number = [&](std::uint32_t v) {
    return v < batch_first_ ? numbers_before_[v - before_first_] : numbers_[v - batch_first_];
  };
  std::vector<Triangle> triangles;
  for (const Triangle& t : triangles_) {
    const Triangle renumbered{number(t[0]), number(t[1]), number(t[2])};
    if (renumbered[0] != kNone) triangles.push_back(renumbered);
  }
  sink_.add_vertices(kept);
  sink_.add_triangles(triangles);
  before_first_ = batch_first_;
  batch_first_ += static_cast<std::uint32_t>(batch_.size());
  numbers_before_.swap(numbers_);
  batch_.clear();
  triangles_.clear();
}

}  // namespace astrolith
