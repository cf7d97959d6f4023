// One value of several plain types, as std::variant holds it, that can be copied to a GPU and visited there.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <type_traits>

#include "numerics/host_device.h"

namespace astrolith {

template <class... Types>
class PlainVariant {
 public:
  // Holds a default value of the first type.
  PlainVariant() : PlainVariant(std::tuple_element_t<0, std::tuple<Types...>>{}) {}
  template <class T>
  explicit PlainVariant(const T& value) : number_(type_index<T>()) {
    std::memcpy(bytes_, &value, sizeof(T));
  }

  // visit(value), with the type that is held.
  template <class Visit>
  ASTROLITH_HD decltype(auto) visit(const Visit& visit) const {
    return visit_from<0>(visit);
  }

  // Null where another type is held.
  template <class T>
  ASTROLITH_HD const T* get_if() const {
    return number_ == type_index<T>() ? reinterpret_cast<const T*>(bytes_) : nullptr;
  }

 private:
  static_assert((std::is_trivially_copyable_v<Types> && ...));

  template <class T>
  static constexpr std::uint32_t type_index() {
    std::uint32_t number = 0;
    const bool found = ((std::is_same_v<T, Types> || (++number, false)) || ...);
    static_cast<void>(found);
    return number;
  }

  template <std::size_t number, class Visit>
  ASTROLITH_HD decltype(auto) visit_from(const Visit& visit) const {
    using T = std::tuple_element_t<number, std::tuple<Types...>>;
    const T& value = *reinterpret_cast<const T*>(bytes_);
    if constexpr (number + 1 == sizeof...(Types)) {
      return visit(value);
    } else {
      return number_ == number ? visit(value) : visit_from<number + 1>(visit);
    }
  }

  std::uint32_t number_;
  alignas(Types...) unsigned char bytes_[std::max({sizeof(Types)...})];
};

}  // namespace astrolith
