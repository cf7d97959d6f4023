// The backend of tests: it runs the algorithms of a GPU on the CPU, thread by thread. Arrays are vectors, and
// a launch is a loop. A test can limit its memory and choose the order of threads. Each array is an
// allocation of its own, and a group's memory has exactly the size that the group states. The address
// sanitizer therefore finds every access beyond an array.
#pragma once

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "cuda/backend.h"

namespace astrolith {

// The order of threads: by their numbers, or by steps of a fixed stride through them.
struct HostOrder {
  std::size_t seed = 0;  // 0: by their numbers

  // Calls step(i) for every i in 0 .. n - 1.
  template <typename Step>
  void each(std::size_t n, const Step& step) const {
    std::size_t stride = seed == 0 ? 1 : 1 + seed * 2654435761u % std::max<std::size_t>(n, 1);
    while (std::gcd(stride, n) > 1) ++stride;
    for (std::size_t i = 0, at = seed % std::max<std::size_t>(n, 1); i < n; ++i, at = (at + stride) % n)
      step(at);
  }
};

// A group on the host. Its threads run one after another.
class HostGroup {
 public:
  HostGroup(std::size_t index, unsigned threads, void* shared, HostOrder order)
      : index_(index), threads_(threads), shared_(shared), order_(order) {}
  ASTROLITH_HD std::size_t index() const { return index_; }
  ASTROLITH_HD unsigned threads() const { return threads_; }
  // The shared memory. Its content is arbitrary at first.
  ASTROLITH_HD void* shared() const { return shared_; }
  template <typename Step>
  void each_thread(const Step& step) const {
    order_.each(threads_, [&](std::size_t thread) { step(static_cast<unsigned>(thread)); });
  }

 private:
  std::size_t index_;
  unsigned threads_;
  void* shared_;
  HostOrder order_;
};

class HostBackend {
 public:
  // `memory` limits the bytes of all arrays together.
  explicit HostBackend(std::size_t memory = std::numeric_limits<std::size_t>::max(), HostOrder order = {})
      : left_(std::make_shared<std::size_t>(memory)), order_(order) {}

  template <typename T>
  class Array {
   public:
    Array() = default;
    Array(Array&& other) noexcept { swap(other); }
    Array& operator=(Array&& other) noexcept {
      swap(other);
      return *this;
    }
    ~Array() {
      if (left_) *left_ += values_.size() * sizeof(T);
    }
    T* data() { return values_.data(); }
    const T* data() const { return values_.data(); }
    std::size_t size() const { return values_.size(); }

   private:
    friend class HostBackend;
    Array(std::vector<T> values, std::shared_ptr<std::size_t> left)
        : values_(std::move(values)), left_(std::move(left)) {}
    void swap(Array& other) {
      std::swap(values_, other.values_);
      std::swap(left_, other.left_);
    }
    std::vector<T> values_;
    std::shared_ptr<std::size_t> left_;
  };

  template <typename T>
  using HostArray = std::vector<T>;

  // The content of an array is arbitrary at first. Here it is a pattern that makes a wrong use visible.
  template <typename T>
  Array<T> allocate(std::size_t count) {
    if (count * sizeof(T) > *left_) throw OutOfDeviceMemory("GPU: out of memory");
    *left_ -= count * sizeof(T);
    std::vector<T> values(count);
    if (count != 0) std::memset(static_cast<void*>(values.data()), 0x77, count * sizeof(T));
    return {std::move(values), left_};
  }
  template <typename T>
  Array<T> upload(std::span<const T> values) {
    Array<T> array = allocate<T>(values.size());
    std::copy(values.begin(), values.end(), array.data());
    return array;
  }
  template <typename T>
  void fill_zero(Array<T>& array) {
    std::fill_n(array.data(), array.size(), T{});
  }
  // Copies the first values.size() elements of the array.
  template <typename T>
  void download(const Array<T>& array, std::span<T> values) {
    std::copy_n(array.data(), values.size(), values.begin());
  }

  template <typename T>
  T read(const Array<T>& array, std::size_t index) {
    return array.data()[index];
  }

  template <typename Body>
  void launch(const char*, std::size_t threads, const Body& body) {
    order_.each(threads, body);
  }
  template <typename Body>
  void launch_groups(const char*, std::size_t groups, unsigned threads, const Body& body) {
    static_assert(Body::kGroupBytes <= kSharedBytes);
    std::vector<char> shared(Body::kGroupBytes);
    order_.each(groups, [&](std::size_t i) {
      std::fill(shared.begin(), shared.end(), char{0x77});
      body(HostGroup(i, threads, shared.data(), order_));
    });
  }
  void wait() {}
  // Replaces values[i] by the sum of the values before it.
  void running_sum(Array<std::uint32_t>& values) {
    std::exclusive_scan(values.data(), values.data() + values.size(), values.data(), std::uint32_t{0});
  }

 private:
  std::shared_ptr<std::size_t> left_;
  HostOrder order_;
};

}  // namespace astrolith
