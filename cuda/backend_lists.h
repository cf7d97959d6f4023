// Lists of unknown lengths on a backend, stored one after another in one array. Each list is made twice:
// first its items are counted, then they are written.
#pragma once

#include <cstdint>
#include <limits>

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

// Each thread makes one list: write(i, writer) passes the items of list number i to the writer, and must pass
// the same items both times.
template <typename T, typename Write>
struct CountItems {
  Write write;
  std::uint32_t* counts;
  std::uint64_t* total;
  ASTROLITH_HD void operator()(std::size_t i) const {
    ListWriter<T> writer{nullptr};
    write(i, writer);
    counts[i] = writer.count;
    if (writer.count != 0) add_atomically(total, std::uint64_t{writer.count});
  }
};
template <typename T, typename Write>
struct WriteItems {
  Write write;
  const std::uint32_t* first;
  T* items;
  ASTROLITH_HD void operator()(std::size_t i) const {
    ListWriter<T> writer{items + first[i]};
    write(i, writer);
  }
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

// Makes `lists` lists. Throws OutOfDeviceMemory where they do not fit, or have 2^32 items or more together.
template <typename T, class Backend, typename Write>
BackendLists<Backend, T> write_lists(Backend& backend, const char* what, std::size_t lists,
                                     const Write& write) {
  BackendLists<Backend, T> result;
  result.first = zeros_on<std::uint32_t>(backend, lists + 1);
  auto total = zeros_on<std::uint64_t>(backend, 1);
  backend.launch(what, lists, CountItems<T, Write>{write, result.first.data(), total.data()});
  const std::uint64_t count = backend.read(total, 0);
  if (count > std::numeric_limits<std::uint32_t>::max()) {
    throw OutOfDeviceMemory("GPU: lists of more than 2^32 items");
  }
  backend.running_sum(result.first);
  result.items = backend.template allocate<T>(static_cast<std::size_t>(count));
  backend.launch(what, lists, WriteItems<T, Write>{write, result.first.data(), result.items.data()});
  return result;
}

}  // namespace astrolith
