// The order in which std::nth_element leaves elements differs from library to library, and with it the order
// of sums over them. This one is the same everywhere.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <utility>

namespace astrolith {
namespace split_at_rank_detail {

// Puts the median of three elements at `result`.
template <class Iterator, class Less>
void take_median(Iterator result, Iterator a, Iterator b, Iterator c, Less& less) {
  if (less(*a, *b)) {
    std::iter_swap(result, less(*b, *c) ? b : less(*a, *c) ? c : a);
  } else {
    std::iter_swap(result, less(*a, *c) ? a : less(*b, *c) ? c : b);
  }
}

// Elements below the pivot, which is *first, come before the result; those above it come from there on.
template <class Iterator, class Less>
Iterator partition_by_first(Iterator first, Iterator last, Less& less) {
  const Iterator pivot = first;
  Iterator low = std::next(first), high = last;
  while (true) {
    while (less(*low, *pivot)) ++low;
    --high;
    while (less(*pivot, *high)) --high;
    if (!(low < high)) return low;
    std::iter_swap(low, high);
    ++low;
  }
}

template <class Iterator, class Less>
void sort_few(Iterator first, Iterator last, Less& less) {
  for (Iterator next = first; next != last; ++next) {
    auto moved = std::move(*next);
    Iterator hole = next;
    for (; hole != first && less(moved, *std::prev(hole)); --hole) *hole = std::move(*std::prev(hole));
    *hole = std::move(moved);
  }
}

}  // namespace split_at_rank_detail

// Puts the element at `nth` that a sort would put there, smaller or equal ones before it and larger or equal
// ones behind it: quickselect by the median of three, as libstdc++ has it, whose order it leaves. Elements on
// which quickselect would take long are sorted, and equal ones keep their order.
template <class Iterator, class Less>
void split_at_rank(Iterator first, Iterator nth, Iterator last, Less less) {
  using namespace split_at_rank_detail;
  if (first == last || nth == last) return;
  int steps = 2 * static_cast<int>(std::bit_width(static_cast<std::uint64_t>(last - first)) - 1);
  while (last - first > 3) {
    if (steps-- == 0) return std::stable_sort(first, last, less);
    take_median(first, std::next(first), first + (last - first) / 2, std::prev(last), less);
    const Iterator cut = partition_by_first(first, last, less);
    (cut <= nth ? first : last) = cut;
  }
  sort_few(first, last, less);
}

}  // namespace astrolith
