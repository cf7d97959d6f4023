// Several bodies of one command: each has a seed of its own, and files whose names have it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace astrolith {

inline constexpr int kMostInSeries = 10000;

// Whether "{n}" stands in the name.
bool has_seed_mark(const std::filesystem::path& name);

// The name with `number` in place of each "{n}".
std::filesystem::path with_seed(const std::filesystem::path& name, std::uint64_t number);

// Throws InputError where one of the names would be the same for all bodies. Empty names stand for no file.
void check_series_names(const std::vector<std::filesystem::path>& names);

// Throws InputError where one of the names of a single body has the mark of a series.
void check_single_names(const std::vector<std::filesystem::path>& names);

}  // namespace astrolith
