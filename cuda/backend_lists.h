// Lists of unknown lengths on a backend, one after the other in one array: each is written twice, the first
// time only to count.
#pragma once

#include <cstdint>
#include <limits>

#include "cuda/backend.h"

namespace astrolith {

// A list in an array that holds many: elements first .. first + count - 1.
struct ListRange {
  std::uint32_t first = 0, count = 0;
};

// Where the items of a list go; without an array they are only counted.
template <typename T>
struct ListWriter {
  T* items;
  std::uint32_t count = 0;

  ASTROLITH_HD void operator()(const T& item) {
    if (items != nullptr) items[count] = item;
    ++count;
  }
};

// A thread a list: write(i, writer) gives list number i its items, the same both times.
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

// Throws OutOfDeviceMemory as well where an item's number would need more than 32 bits.
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
