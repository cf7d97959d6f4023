#include "tasks/estimation/fit_realism.h"

#include "numerics/errors.h"

namespace astrolith {
namespace {

LengthWords lengths_of(const FitRealism& realism, const TargetBody& target, const std::string& unit) {
  LengthWords lengths = words_for_lengths(unit, 3.0 * realism.verdict.edge * target.diagonal);
  lengths.scale *= target.diagonal;
  return lengths;
}

}  // namespace

JudgedFit judge_fit(const TargetBody& target, const Recipe& recipe, int seeds, std::uint64_t seed,
                    const Progress& progress) {
  try {
    return {check_realism(target, recipe, seeds, seed, progress), ""};
  } catch (const InputError& e) {
    return {std::nullopt, e.what()};
  } catch (const WorkError&) {
    return {};
  }
}

nlohmann::ordered_json fit_realism_json(const FitRealism& realism, const TargetBody& target,
                                        const std::string& unit) {
  RealismVerdict verdict = realism.verdict;
  verdict.edge *= target.diagonal;
  nlohmann::ordered_json json = realism_json(verdict, words_for_lengths(unit, 3.0 * verdict.edge));
  nlohmann::ordered_json seeds = nlohmann::ordered_json::array();
  for (const RealismVerdict& of_seed : realism.verdict_of_seed) {
    seeds.push_back({{"p", of_seed.p}, {"largest_distance", of_seed.largest_distance}});
  }
  json["noise_seeds"] = seeds;
  return json;
}

ReportedRealism reported(const FitRealism& realism, const TargetBody& target, const std::string& unit) {
  return {realism.verdict, realism.target, realism.mesh, realism.fit, lengths_of(realism, target, unit)};
}

}  // namespace astrolith
