// Arrays of plain values of many types in one piece of memory. Whoever needs them on a GPU copies that piece.
//
//   ArrayStore store;
//   const ArrayRange<Wave> waves = store.add(list);   // a range is plain, and no pointer
//   const Wave* first = store.view()[waves];          // until the store grows again
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "numerics/host_device.h"

namespace astrolith {

// Where an array of `count` values lies in a store.
template <typename T>
struct ArrayRange {
  std::uint32_t first = 0;  // in units of kArrayAlignment bytes from the store's begin
  std::uint32_t count = 0;
};

inline constexpr std::size_t kArrayAlignment = 16;

// The memory of a store, on the host or on a device.
struct ArrayView {
  const unsigned char* bytes = nullptr;
  std::size_t size = 0;

  template <typename T>
  ASTROLITH_HD const T* operator[](const ArrayRange<T>& range) const {
    return reinterpret_cast<const T*>(bytes + kArrayAlignment * std::size_t{range.first});
  }
  template <typename T>
  std::span<const T> span(const ArrayRange<T>& range) const {
    return {(*this)[range], range.count};
  }
};

class ArrayStore {
 public:
  // Copies the values. Views that were taken before are no longer valid.
  template <typename T>
  ArrayRange<T> add(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kArrayAlignment);
    const std::size_t first = (bytes_.size() + kArrayAlignment - 1) / kArrayAlignment;
    bytes_.resize(kArrayAlignment * first + values.size_bytes());
    if (!values.empty())
      std::memcpy(bytes_.data() + kArrayAlignment * first, values.data(), values.size_bytes());
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(values.size())};
  }
  template <typename T>
  ArrayRange<T> add(const std::vector<T>& values) {
    return add(std::span<const T>(values));
  }

  ArrayView view() const { return {bytes_.data(), bytes_.size()}; }

 private:
  std::vector<unsigned char> bytes_;
};

}  // namespace astrolith
