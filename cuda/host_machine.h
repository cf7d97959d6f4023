// The twin of a GPU on the CPU: arrays are vectors, a launch is a loop. It computes what the GPU does, thread
// by thread, for tests; and it runs out of memory where it is told to.
#pragma once

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "cuda/machine.h"

namespace astrolith {

// The threads of a group one after the other.
class HostGroup {
 public:
  HostGroup(std::size_t index, unsigned threads, void* shared)
      : index_(index), threads_(threads), shared_(shared) {}
  ASTROLITH_HD std::size_t index() const { return index_; }
  ASTROLITH_HD unsigned threads() const { return threads_; }
  // Of kSharedBytes; holds anything at first.
  ASTROLITH_HD void* shared() const { return shared_; }
  template <typename Step>
  ASTROLITH_HD void each_thread(const Step& step) const {
    for (unsigned thread = 0; thread < threads_; ++thread) step(thread);
  }

 private:
  std::size_t index_;
  unsigned threads_;
  void* shared_;
};

class HostMachine {
 public:
  // Bytes of its arrays together.
  explicit HostMachine(std::size_t memory = std::numeric_limits<std::size_t>::max())
      : left_(std::make_shared<std::size_t>(memory)) {}

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
    friend class HostMachine;
    Array(std::vector<T> values, std::shared_ptr<std::size_t> left)
        : values_(std::move(values)), left_(std::move(left)) {}
    void swap(Array& other) {
      std::swap(values_, other.values_);
      std::swap(left_, other.left_);
    }
    std::vector<T> values_;
    std::shared_ptr<std::size_t> left_;
  };

  // Holds anything at first: here what shows that it was used.
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
  // The first values.size() of the array.
  template <typename T>
  void download(const Array<T>& array, std::span<T> values) {
    std::copy_n(array.data(), values.size(), values.begin());
  }

  template <typename Body>
  void launch(const char*, std::size_t threads, const Body& body) {
    for (std::size_t i = 0; i < threads; ++i) body(i);
  }
  template <typename Body>
  void launch_groups(const char*, std::size_t groups, unsigned threads, const Body& body) {
    std::vector<std::uint64_t> shared(kSharedBytes / sizeof(std::uint64_t));
    for (std::size_t i = 0; i < groups; ++i) {
      std::fill(shared.begin(), shared.end(), std::uint64_t{0x7777777777777777u});
      body(HostGroup(i, threads, shared.data()));
    }
  }
  void wait() {}
  // values[i] becomes the sum of those before it.
  void running_sum(Array<std::uint32_t>& values) {
    std::exclusive_scan(values.data(), values.data() + values.size(), values.data(), std::uint32_t{0});
  }

 private:
  std::shared_ptr<std::size_t> left_;
};

}  // namespace astrolith
