#include "apps/synth/synth_series.h"

#include <string>
#include <string_view>

#include "numerics/errors.h"

namespace astrolith {
namespace {

constexpr std::string_view kSeedMark = "{n}";

}  // namespace

bool has_seed_mark(const std::filesystem::path& name) {
  return name.string().find(kSeedMark) != std::string::npos;
}

std::filesystem::path with_seed(const std::filesystem::path& name, std::uint64_t number) {
  std::string text = name.string();
  const std::string digits = std::to_string(number);
  for (std::size_t at = 0; (at = text.find(kSeedMark, at)) != std::string::npos; at += digits.size()) {
    text.replace(at, kSeedMark.size(), digits);
  }
  return text;
}

void check_series_names(const std::vector<std::filesystem::path>& names) {
  for (const std::filesystem::path& name : names) {
    if (name.empty() || has_seed_mark(name)) continue;
    throw InputError("--count: every body writes a file of its own; put {n} into the name " + name.string() +
                     ", as in rock_{n}" + name.extension().string());
  }
}

void check_single_names(const std::vector<std::filesystem::path>& names) {
  for (const std::filesystem::path& name : names) {
    if (!has_seed_mark(name)) continue;
    throw InputError(name.string() +
                     ": {n} stands for the seed of each body of --count N; add --count, or leave {n} out");
  }
}

}  // namespace astrolith
