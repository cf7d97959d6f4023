// The pieces of a mesh, found while it streams past: which there are and how large, and a mesh without the
// small ones. Memory is a window of two batches and a number for each piece.
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

// Labels vertices by the piece they belong to, as far as the mesh is known. Expects what mesh_field promises:
// triangles that follow a call of add_vertices name vertices of that call and the one before.
class ComponentLabels {
 public:
  // Labels of a batch's vertices, once all triangles that follow it are known. A piece may have several
  // labels, which component_of brings together.
  std::vector<std::uint32_t> label(std::size_t num_vertices, std::span<const Triangle> triangles);

  // After the last batch: the same number for all labels of a piece, the lowest of them.
  std::uint32_t component_of(std::uint32_t label) const;
  std::uint32_t num_labels() const { return static_cast<std::uint32_t>(parent_.size()); }

 private:
  std::uint32_t new_label();
  void unite(std::uint32_t a, std::uint32_t b);

  std::uint32_t first_ = 0, end_ = 0;  // vertices of the batch before
  std::vector<std::uint32_t> labels_;  // theirs
  std::vector<std::uint32_t> parent_;  // of labels; a piece's lowest is its own
};

// Which labels' pieces are to stay.
struct ComponentChoice {
  std::vector<char> keep;               // by label
  std::int64_t dropped_components = 0;  // the others
};

// The volume that each piece encloses.
class ComponentSizes : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex> vertices) override;
  void add_triangles(std::span<const Triangle> triangles) override;

  // The pieces whose volume, of a body or of a cavity, is at least a share of the largest one's. Call once,
  // at the end.
  ComponentChoice larger_than(double least_share);

 private:
  void settle();

  ComponentLabels labels_;
  std::vector<double> volumes_;  // by label; negative of cavities
  // The last batch, and the one before it.
  std::vector<Vec3f> before_, batch_;
  std::vector<std::uint32_t> labels_before_;
  std::vector<Triangle> triangles_;
  std::uint32_t first_ = 0;  // vertex of `before_`
  Vec3d center_;             // of tetrahedra: near the mesh, which may lie far from the origin
  bool has_center_ = false;
};

// Passes on the pieces of a choice.
class ComponentFilter : public MeshSink {
 public:
  ComponentFilter(ComponentChoice choice, MeshSink& sink) : sink_(sink), choice_(std::move(choice)) {}
  void add_vertices(std::span<const MeshVertex> vertices) override;
  void add_triangles(std::span<const Triangle> triangles) override;

  // Passes on what is left; call once, at the end.
  void finish() { settle(); }

 private:
  void settle();

  MeshSink& sink_;
  ComponentLabels labels_;
  ComponentChoice choice_;
  std::vector<MeshVertex> batch_;
  std::vector<Triangle> triangles_;
  std::uint32_t batch_first_ = 0, before_first_ = 0;     // vertices of the whole mesh
  std::vector<std::uint32_t> numbers_before_, numbers_;  // of the kept vertices, as the sink counts them
  std::uint32_t kept_ = 0;
};

}  // namespace astrolith
