#include <algorithm>
#include <cmath>

#include "estimation/optimize/searches_internal.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

// The constriction of type 1'' of Clerc and Kennedy 2002 with phi = c1 + c2 = 4.1:
// chi = 2 / |2 - phi - sqrt(phi^2 - 4 phi)|.
constexpr double kConstriction = 0.7298437881283576;
constexpr double kAttraction = 2.05;  // c1 = c2

struct Particle {
  std::vector<double> x, velocity;
  double value = 0;
  std::vector<double> best_x;
  double best_value = 0;
};

// Random numbers of one particle in one generation. They do not depend on the order of evaluation.
CounterRandom make_random(const OptimizeOptions& options, std::int64_t generation, std::size_t particle) {
  return CounterRandom(options.seed, static_cast<std::uint64_t>(generation) << 32 | particle);
}

// A particle at a uniform position, whose velocity leads half way to another uniform position (Bratton and
// Kennedy 2007).
Particle scatter(const Bounds& bounds, CounterRandom random) {
  Particle p;
  for (std::size_t d = 0; d < bounds.lower.size(); ++d) {
    p.x.push_back(random.uniform(bounds.lower[d], bounds.upper[d]));
    p.velocity.push_back(0.5 * (random.uniform(bounds.lower[d], bounds.upper[d]) - p.x[d]));
  }
  return p;
}

// v <- chi (v + c1 r1 (own best - x) + c2 r2 (swarm's best - x)), x <- x + v. A particle that meets a wall
// stays there and loses its velocity across it.
void move(Particle& p, const std::vector<double>& swarm_best, const Bounds& bounds, CounterRandom random) {
  for (std::size_t d = 0; d < p.x.size(); ++d) {
    const double own = kAttraction * random.uniform() * (p.best_x[d] - p.x[d]);
    const double common = kAttraction * random.uniform() * (swarm_best[d] - p.x[d]);
    p.velocity[d] = kConstriction * (p.velocity[d] + own + common);
    const double wanted = p.x[d] + p.velocity[d];
    p.x[d] = std::clamp(wanted, bounds.lower[d], bounds.upper[d]);
    if (p.x[d] != wanted) p.velocity[d] = 0;
  }
}

std::vector<Particle> first_swarm(const Bounds& bounds, const OptimizeOptions& options) {
  std::vector<Particle> swarm;
  for (std::size_t i = 0; i < static_cast<std::size_t>(options.population); ++i) {
    swarm.push_back(scatter(bounds, make_random(options, 0, i)));
  }
  if (!options.start.empty()) swarm[0].x = options.start;
  return swarm;
}

void evaluate(const BatchObjective& objective, std::vector<Particle>& swarm) {
  std::vector<std::vector<double>> points;
  for (const Particle& p : swarm) points.push_back(p.x);
  const std::vector<double> values = objective(points);
  for (std::size_t i = 0; i < swarm.size(); ++i) swarm[i].value = finite_or_infinity(values[i]);
}

}  // namespace

OptimizeResult particle_swarm(const BatchObjective& objective, const Bounds& bounds,
                              const OptimizeOptions& options, const Progress& progress) {
  std::vector<Particle> swarm = first_swarm(bounds, options);
  BestSoFar best(options, progress);
  for (std::int64_t generation = 0;; ++generation) {
    evaluate(objective, swarm);
    for (Particle& p : swarm) {
      best.record(p.x, p.value);
      if (!p.best_x.empty() && !(p.value < p.best_value)) continue;
      p.best_x = p.x;
      p.best_value = p.value;
    }
    if (!best.generation_done()) return best.result();
    for (std::size_t i = 0; i < swarm.size(); ++i) {
      move(swarm[i], best.result().x, bounds, make_random(options, generation + 1, i));
    }
  }
}

}  // namespace astrolith
