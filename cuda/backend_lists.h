// Lists of unknown lengths on a backend, stored one after another in one array. Each list is made twice:
// first its items are counted, then they are written.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "cuda/backend.h"

namespace astrolith {

// A list within an array: elements first .. first + count - 1.
struct ListRange {
  std::uint32_t first = 0, count = 0;
};

// Takes the items of a list. Without an array it only counts them.
template <typename T>
struct ListWriter {
  T* items;
  std::uint32_t count = 0;

  ASTROLITH_HD void operator()(const T& item) {
    if (items != nullptr) items[count] = item;
    ++count;
  }
};

// The share of a list's candidates that one thread looks at. The shares of a list follow one another, so that
// its items have the same order however many threads make it.
struct ListShare {
  std::uint32_t number = 0, of = 1;

  // The candidate, of so many, with which the share begins; the next share begins where this one ends.
  ASTROLITH_HD std::uint64_t begin(std::uint64_t candidates) const { return candidates * number / of; }
  ASTROLITH_HD std::uint64_t end(std::uint64_t candidates) const { return candidates * (number + 1) / of; }
};

// Each thread makes one share of a list: write(i, share, writer) passes the items of that share of list
// number i to the writer, and must pass the same items both times.
template <typename T, typename Write>
struct CountItems {
  Write write;
  std::uint32_t shares;
  std::uint32_t* counts;
  std::uint64_t* total;
  ASTROLITH_HD void operator()(std::size_t i) const {
    ListWriter<T> writer{nullptr};
    write(i / shares, ListShare{static_cast<std::uint32_t>(i % shares), shares}, writer);
    counts[i] = writer.count;
    if (writer.count != 0) add_atomically(total, std::uint64_t{writer.count});
  }
};
template <typename T, typename Write>
struct WriteItems {
  Write write;
  std::uint32_t shares;
  const std::uint32_t* first;
  T* items;
  ASTROLITH_HD void operator()(std::size_t i) const {
    ListWriter<T> writer{items + first[i]};
    write(i / shares, ListShare{static_cast<std::uint32_t>(i % shares), shares}, writer);
  }
};

// Each thread finds where one list begins, which is where its first share does.
struct PickLists {
  const std::uint32_t* shares_begin;
  std::uint32_t shares;
  std::uint32_t* lists_begin;
  ASTROLITH_HD void operator()(std::size_t i) const { lists_begin[i] = shares_begin[i * shares]; }
};

// List l has items[first[l]] to items[first[l + 1] - 1].
template <class Backend, typename T>
struct BackendLists {
  typename Backend::template Array<T> items;
  typename Backend::template Array<std::uint32_t> first;  // (lists + 1)
};

template <typename T, class Backend>
typename Backend::template Array<T> zeros_on(Backend& backend, std::size_t count) {
  auto array = backend.template allocate<T>(count);
  backend.fill_zero(array);
  return array;
}

// Threads that keep every part of a GPU at work.
inline constexpr std::size_t kFullLaunch = std::size_t{1} << 20;
inline constexpr std::uint32_t kMostShares = 32;

// The number of threads for each of some lists: more than one where the lists alone leave a GPU idle.
inline std::uint32_t share_count(std::size_t lists) {
  const std::size_t wanted = kFullLaunch / std::max<std::size_t>(lists, 1);
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(wanted, 1, kMostShares));
}

// Makes `lists` lists, each by `shares` threads. Throws OutOfDeviceMemory where they do not fit, or have 2^32
// items or more together.
template <typename T, class Backend, typename Write>
BackendLists<Backend, T> write_lists(Backend& backend, const char* what, std::size_t lists,
                                     const Write& write, std::uint32_t shares = 1) {
  BackendLists<Backend, T> result;
  auto first = zeros_on<std::uint32_t>(backend, lists * shares + 1);
  auto total = zeros_on<std::uint64_t>(backend, 1);
  backend.launch(what, lists * shares, CountItems<T, Write>{write, shares, first.data(), total.data()});
  const std::uint64_t count = backend.read(total, 0);
  if (count > std::numeric_limits<std::uint32_t>::max()) {
    throw OutOfDeviceMemory("GPU: lists of more than 2^32 items");
  }
  backend.running_sum(first);
  result.items = backend.template allocate<T>(static_cast<std::size_t>(count));
  backend.launch(what, lists * shares,
                 WriteItems<T, Write>{write, shares, first.data(), result.items.data()});
  if (shares == 1) {
    result.first = std::move(first);
    return result;
  }
  result.first = backend.template allocate<std::uint32_t>(lists + 1);
  backend.launch("finding lists", lists + 1, PickLists{first.data(), shares, result.first.data()});
  return result;
}

}  // namespace astrolith
