#include "estimation/shape/sphere_packing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include "geometry/mesh_measure.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// Prototypes brought up to date together. Fixed, not the number of threads: it decides the order of events.
constexpr std::size_t kBatch = 32;

struct Prototype {
  Vec3d position;
  double clearance = 0.0;  // distance to the nearest obstacle when it last climbed
  std::size_t known = 0;   // spheres that were placed then
  std::int64_t index = 0;  // tells prototypes of equal clearance apart
};

struct SmallerClearance {
  bool operator()(const Prototype& a, const Prototype& b) const {
    return a.clearance < b.clearance || (a.clearance == b.clearance && a.index > b.index);
  }
};

// Nearest obstacle seen from a point inside the body.
struct Obstacle {
  double distance;  // negative inside a placed sphere
  Vec3d away;       // unit direction that leads away from it
};

class Packer {
 public:
  Packer(const TriangleMesh& body, const SurfaceTree& tree, const PackingOptions& options)
      : tree_(tree), options_(options), box_(body.bounds()), volume_(volume(body)) {}

  Packing run(const Progress& progress) {
    Packing packing;
    const double smallest = options_.smallest_radius * box_.diagonal();
    sow();
    int barren = 0;
    while (spheres_.size() < static_cast<std::size_t>(options_.max_spheres)) {
      if (!report(progress, static_cast<double>(spheres_.size()) / options_.max_spheres,
                  std::to_string(spheres_.size()) + " spheres")) {
        packing.interrupted = true;
        break;
      }
      if (place_largest(smallest)) {
        barren = 0;
      } else if (++barren > 3) {
        break;
      } else {
        sow();
      }
    }
    packing.spheres = std::move(spheres_);
    std::stable_sort(packing.spheres.begin(), packing.spheres.end(),
                     [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
    for (const Sphere& s : packing.spheres)
      packing.filling_rate += 4.0 / 3.0 * std::numbers::pi * std::pow(s.radius, 3);
    packing.filling_rate /= volume_;
    return packing;
  }

 private:
  Obstacle nearest_obstacle(const Vec3d& p) const {
    const auto surface = tree_.closest(p);
    Obstacle nearest{surface.distance, normalized(p - surface.point)};
    for (const Sphere& s : spheres_) {
      const Vec3d d = p - s.center;
      const double reach = nearest.distance + s.radius;
      // Square roots only for the few that are nearer than the nearest so far.
      if (reach <= 0.0 || squared_norm(d) >= reach * reach) continue;
      nearest = {norm(d) - s.radius, normalized(d)};
    }
    return nearest;
  }

  // Algorithm 3. The step may not leave the sphere of clearance around p, which holds no obstacle.
  void climb(Prototype& prototype) const {
    Vec3d p = prototype.position;
    Obstacle nearest = nearest_obstacle(p);
    prototype.clearance = nearest.distance;
    const double decay = std::pow(1e-3, 1.0 / options_.climb_steps);
    double eps = 0.5;
    for (int step = 0; step < options_.climb_steps && nearest.distance > 0.0; ++step, eps *= decay) {
      p += nearest.away * (eps * nearest.distance);
      nearest = nearest_obstacle(p);
      if (nearest.distance > prototype.clearance) {
        prototype.position = p;
        prototype.clearance = nearest.distance;
      }
    }
  }

  // A new place in the free part of the body, from the prototype's own random stream, and the climb from
  // there. Clearance 0 when none was found.
  void start(Prototype& prototype) const {
    constexpr int kAttempts = 64;
    CounterRandom random(options_.seed, static_cast<std::uint64_t>(prototype.index) << 24 | spheres_.size());
    prototype.clearance = 0.0;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      prototype.position = random_point(random);
      if (covered(prototype.position) || !inside(prototype.position)) continue;
      climb(prototype);
      return;
    }
  }

  bool covered(const Vec3d& p) const {
    return std::any_of(spheres_.begin(), spheres_.end(),
                       [&](const Sphere& s) { return squared_norm(p - s.center) <= s.radius * s.radius; });
  }

  bool inside(const Vec3d& p) const { return tree_.signed_distance(p) > 0.0; }

  // New prototypes, uniform in the free part of the body.
  void sow() {
    const std::int64_t count = std::int64_t{options_.max_spheres} * options_.prototypes_per_sphere;
    std::vector<Prototype> sown(static_cast<std::size_t>(count));
    parallel_for(
        0, count,
        [&](std::int64_t i) {
          Prototype& prototype = sown[static_cast<std::size_t>(i)];
          prototype.index = sown_ + i;
          prototype.known = spheres_.size();
          start(prototype);
        },
        16);
    sown_ += count;
    for (const Prototype& prototype : sown) queue_.push(prototype);
  }

  Vec3d random_point(CounterRandom& random) const {
    const Vec3d e = box_.extent();
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    return box_.min + Vec3d{x * e.x, y * e.y, z * e.z};
  }

  // False when no prototype of at least the smallest radius is left.
  bool place_largest(double smallest) {
    while (!queue_.empty()) {
      if (queue_.top().clearance < smallest) return false;
      if (queue_.top().known == spheres_.size()) {
        Prototype winner = queue_.top();
        queue_.pop();
        // Only winners are worth a second climb, which settles them in their node.
        climb(winner);
        spheres_.push_back({winner.position, winner.clearance});
        return true;
      }
      update_head();
    }
    return false;
  }

  void update_head() {
    std::vector<Prototype> head;
    while (!queue_.empty() && head.size() < kBatch && queue_.top().known != spheres_.size()) {
      head.push_back(queue_.top());
      queue_.pop();
    }
    parallel_for(0, static_cast<std::int64_t>(head.size()), [&](std::int64_t i) {
      Prototype& prototype = head[static_cast<std::size_t>(i)];
      // Most prototypes share a few nodes: those whose node was taken start anew elsewhere.
      if (covered(prototype.position)) {
        start(prototype);
      } else if (overtaken(prototype)) {
        climb(prototype);
      }
      prototype.known = spheres_.size();
    });
    for (const Prototype& prototype : head) queue_.push(prototype);
  }

  // Does a sphere placed since overlap the prototype's own?
  bool overtaken(const Prototype& prototype) const {
    return std::any_of(spheres_.begin() + static_cast<std::ptrdiff_t>(prototype.known), spheres_.end(),
                       [&](const Sphere& s) {
                         const double reach = s.radius + prototype.clearance;
                         return squared_norm(prototype.position - s.center) < reach * reach;
                       });
  }

  const SurfaceTree& tree_;
  const PackingOptions& options_;
  Box box_;
  double volume_;
  std::vector<Sphere> spheres_;
  std::int64_t sown_ = 0;
  std::priority_queue<Prototype, std::vector<Prototype>, SmallerClearance> queue_;
};

}  // namespace

Packing pack_spheres(const TriangleMesh& body, const SurfaceTree& tree, const PackingOptions& options,
                     const Progress& progress) {
  return Packer(body, tree, options).run(progress);
}

}  // namespace astrolith
