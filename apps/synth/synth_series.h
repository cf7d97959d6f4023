// Several bodies of one command: each has a seed of its own, and files whose names have it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>

namespace astrolith {

inline constexpr int kMostInSeries = 10000;

// The name with `number` in place of each "{n}".
std::filesystem::path with_seed(const std::filesystem::path& name, std::uint64_t number);

// Throws InputError where one of the names would be the same for all bodies. Empty names stand for no file.
void check_series_names(std::initializer_list<std::filesystem::path> names);

}  // namespace astrolith
