#include "cuda/pair_groups.h"

namespace astrolith {

std::vector<PairGroup> pair_groups(std::span<const std::int64_t> code_first) {
  std::vector<PairGroup> groups;
  const std::size_t codes = code_first.size() - 1;
  for (std::size_t l = 0; l < codes; ++l) {
    for (std::int64_t row = code_first[l]; row < code_first[l + 1]; row += kGroupRows) {
      const std::int64_t end_row = std::min<std::int64_t>(row + kGroupRows, code_first[l + 1]);
      for (std::size_t other = 0; other <= l; ++other) {
        const std::int64_t end = std::min(code_first[other + 1], end_row - 1);
        for (std::int64_t column = code_first[other]; column < end; column += kGroupColumns) {
          groups.push_back({static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(end_row),
                            static_cast<std::uint32_t>(column),
                            static_cast<std::uint32_t>(std::min(column + kGroupColumns, end)),
                            static_cast<std::int32_t>(l), static_cast<std::int32_t>(other)});
        }
      }
    }
  }
  return groups;
}

SurfletSets::SurfletSets(std::span<const SurfletArrays> sets) {
  std::uint32_t first = 0;
  for (const SurfletArrays& set : sets) {
    for (PairGroup pairs : pair_groups(set.code_first)) {
      for (std::uint32_t* row : {&pairs.first_row, &pairs.end_row, &pairs.first_column, &pairs.end_column}) {
        *row += first;
      }
      pairs.row_code += static_cast<std::int32_t>(num_codes);
      pairs.column_code += static_cast<std::int32_t>(num_codes);
      groups.push_back(pairs);
    }
    first += static_cast<std::uint32_t>(set.size());
    num_codes += set.code_first.size() - 1;
  }
  stride = first;
  for (std::size_t d = 0; d < 9; ++d) {
    for (const SurfletArrays& set : sets) {
      surflets.insert(surflets.end(), set.c[d].begin(), set.c[d].begin() + set.size());
    }
  }
}

}  // namespace astrolith
