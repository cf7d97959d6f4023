// Many sparse, noisy resamplings of some bodies, described in every way.
#pragma once

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "descriptor/classification/noisy_resampling.h"
#include "descriptor/classification/principal_components.h"
#include "descriptor/classification/shape_features.h"
#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/progress.h"

namespace astrolith {

inline constexpr FeatureKind kKinds[] = {FeatureKind::ahd, FeatureKind::wahl, FeatureKind::d2,
                                         FeatureKind::shapedna};

struct Bodies {
  std::vector<std::string> names;
  std::vector<TriangleMesh> meshes;
};

// Features of every resampling at one level of noise, one table a kind.
struct Level {
  double noise = 0;
  std::vector<int> labels;        // (#resamplings) the body
  std::vector<double> fractions;  // (#resamplings) points over vertices
  std::vector<FeatureRows> rows;  // (#kinds) x (#resamplings x #features)
};

// The body that a file is named after: "itokawa" for data/itokawa_gaskell_49k.ply.
inline std::string body_name(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  return stem.substr(0, stem.find('_'));
}

inline Bodies read_bodies(const std::vector<std::filesystem::path>& files) {
  Bodies bodies;
  for (const std::filesystem::path& file : files) {
    const std::string name = body_name(file);
    for (const std::string& other : bodies.names) {
      if (name == other)
        throw InputError(file.string() + ": is a second model of " + name + "; give one of each");
    }
    bodies.names.push_back(name);
    bodies.meshes.push_back(read_mesh(file));
  }
  return bodies;
}

// The r-th resampling of each body has the same points at every level; only how far they are moved differs.
inline Level resample(const Bodies& bodies, int resamplings, double noise, std::uint64_t seed,
                      const Progress& progress) {
  const std::size_t each = static_cast<std::size_t>(resamplings), all = each * bodies.meshes.size();
  Level level{noise, std::vector<int>(all), std::vector<double>(all),
              std::vector<FeatureRows>(std::size(kKinds), FeatureRows(all))};
  ResamplingOptions options;
  options.noise = noise;
  std::mutex reporting;
  std::size_t done = 0;
  bool stopped = false;
  parallel_for(0, static_cast<std::int64_t>(all), [&](std::int64_t index) {
    const auto i = static_cast<std::size_t>(index), body = i / each;
    const NoisyResampling cloud = noisy_resampling(bodies.meshes[body], options, (seed << 32) + i);
    level.labels[i] = static_cast<int>(body);
    level.fractions[i] = cloud.fraction;
    for (std::size_t k = 0; k < std::size(kKinds); ++k) {
      level.rows[k][i] = point_features(cloud.points, cloud.normals, default_features(kKinds[k]));
    }
    const std::lock_guard lock(reporting);
    stopped = stopped ||
              !report(progress, static_cast<double>(++done) / static_cast<double>(all), bodies.names[body]);
    if (stopped) throw WorkError("stopped; run it again");
  });
  return level;
}

// Resamplings of other models of the bodies; labels name the bodies.
inline Level resample_others(const Bodies& others, const Bodies& bodies, int resamplings, double noise,
                             std::uint64_t seed, const Progress& progress) {
  Level level = resample(others, resamplings, noise, seed, progress);
  for (int& label : level.labels) {
    const std::string& name = others.names[static_cast<std::size_t>(label)];
    label =
        static_cast<int>(std::find(bodies.names.begin(), bodies.names.end(), name) - bodies.names.begin());
  }
  return level;
}

// Reads other models of the bodies. Throws InputError for a model of a body that is not among them.
inline Bodies read_others(const std::vector<std::filesystem::path>& files, const Bodies& bodies) {
  Bodies others = read_bodies(files);
  for (std::size_t i = 0; i < others.names.size(); ++i) {
    if (std::find(bodies.names.begin(), bodies.names.end(), others.names[i]) != bodies.names.end()) continue;
    throw InputError(files[i].string() + ": no model of " + others.names[i] +
                     " was given to learn from; leave it out");
  }
  return others;
}

}  // namespace astrolith
