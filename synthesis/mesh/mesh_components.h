// The components of a mesh, found while the mesh is streamed: how large they are, and the mesh without its
// small ones. Memory holds a window of two batches and a number for each component.
//
//   ComponentSizes sizes;
//   mesh_field(field, bounds, 512, sizes);
//   ComponentFilter without_crumbs(sizes.larger_than(1e-3), sink);
//   mesh_field(field, bounds, 512, without_crumbs);    // the same mesh, once more
//   without_crumbs.finish();
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh_sink.h"

namespace astrolith {

// Labels vertices by their component, as far as the mesh is known. Expects a stream as mesh_field makes it:
// triangles that follow a call of add_vertices name vertices of that call and of the call before.
class ComponentLabels {
 public:
  // The labels of the vertices of a batch. All triangles that follow the batch must be given. A component may
  // have several labels, which find_component brings together.
  std::vector<std::uint32_t> label(std::size_t num_vertices, std::span<const Triangle> triangles);

  // After the last batch: the lowest of the labels of a component, the same for all its labels.
  std::uint32_t find_component(std::uint32_t label) const;
  std::uint32_t num_labels() const { return static_cast<std::uint32_t>(parent_.size()); }

 private:
  std::uint32_t new_label();
  void unite(std::uint32_t a, std::uint32_t b);

  std::uint32_t first_ = 0, end_ = 0;  // range of vertices of the batch before
  std::vector<std::uint32_t> labels_;  // labels of these vertices
  std::vector<std::uint32_t> parent_;  // union-find over labels; the lowest label is the root
};

// The choice of the components that stay.
struct ComponentChoice {
  std::vector<char> keep;  // by label: 1 where the component stays
  std::int64_t dropped_components = 0;
};

// Measures the volume that each component encloses.
class ComponentSizes : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex> vertices) override;
  void add_triangles(std::span<const Triangle> triangles) override;

  // Chooses the components whose volume, of a body or of a cavity, is at least `least_share` of the largest
  // one's. Must be called once, at the end.
  ComponentChoice larger_than(double least_share);

 private:
  void settle();

  ComponentLabels labels_;
  std::vector<double> volumes_;  // by label; negative for cavities
  // Positions of the batch before and of the last batch.
  std::vector<Vec3f> before_, batch_;
  std::vector<std::uint32_t> labels_before_;
  std::vector<Triangle> triangles_;
  std::uint32_t first_ = 0;  // number of the first vertex of before_
  Vec3d center_;             // apex of the tetrahedra that volumes are sums of; near the mesh
  bool has_center_ = false;
};

// Passes on the components of a choice to another sink.
class ComponentFilter : public MeshSink {
 public:
  ComponentFilter(ComponentChoice choice, MeshSink& sink) : sink_(sink), choice_(std::move(choice)) {}
  void add_vertices(std::span<const MeshVertex> vertices) override;
  void add_triangles(std::span<const Triangle> triangles) override;

  // Passes on the last batch. Must be called once, at the end.
  void finish() { settle(); }

 private:
  void settle();

  MeshSink& sink_;
  ComponentLabels labels_;
  ComponentChoice choice_;
  std::vector<MeshVertex> batch_;
  std::vector<Triangle> triangles_;
  std::uint32_t batch_first_ = 0, before_first_ = 0;  // first vertices of the two batches in the whole mesh
  std::vector<std::uint32_t> numbers_before_, numbers_;  // numbers of the kept vertices in the sink
  std::uint32_t kept_ = 0;
};

}  // namespace astrolith
