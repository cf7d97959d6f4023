#include "tasks/prediction/set_prediction.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <string>
#include <system_error>

#include "numerics/errors.h"
#include "numerics/memory_use.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// One member of so many is looked at, within these bounds.
constexpr std::uint64_t kMembersForOne = 20, kFewest = 2, kMost = 8;
// Up to this resolution a member is made: predicting it would take as long.
constexpr int kSmall = 128;

// The first, the last and some between.
std::vector<std::uint64_t> sampled_members(std::uint64_t begin, std::uint64_t end) {
  const std::uint64_t all = end - begin;
  const std::uint64_t count = std::min(all, std::clamp(all / kMembersForOne, kFewest, kMost));
  std::vector<std::uint64_t> numbers{begin};
  for (std::uint64_t i = 1; i < count; ++i) numbers.push_back(begin + (all - 1) * i / (count - 1));
  return numbers;
}

// A folder that goes away with this object.
class PassingFolder {
 public:
  PassingFolder() {
    std::string name = (fs::temp_directory_path() / "synth_predict_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw InputError(name + ": cannot make this folder; let TMPDIR name one that is writable");
    path_ = name;
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  ~PassingFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }
  double bytes() const {
    double sum = 0.0;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_))
      sum += static_cast<double>(entry.file_size());
    return sum;
  }

 private:
  fs::path path_;
};

// Measures what this process does, on the clock and of all its threads together.
class WorkClock {
 public:
  // Adds the seconds so far. Other programs on the machine slow the clock, so that the lower one is nearer to
  // the clock on idle cores.
  void add_to(MemberTakes& takes) const {
    const double on_clock = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const double of_processor = static_cast<double>(std::clock() - processor_start_) / CLOCKS_PER_SEC;
    takes.seconds += std::min(on_clock, of_processor);
    takes.processor_seconds += of_processor;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::clock_t processor_start_ = std::clock();
};

MemberTakes takes_of(std::uint64_t number, const MemberWork& work) {
  MemberTakes takes;
  if (work.predict) {
    const PredictedMember predicted = work.predict(number);
    takes = predicted.takes;
    if (predicted.resolution > kSmall) {
      if (!work.make_other_files) return takes;
      // Pictures, lists and recipes hardly depend on the resolution.
      const WorkClock clock;
      const PassingFolder folder;
      work.make_other_files(number, kSmall, folder.path());
      takes.file_bytes += folder.bytes();
      clock.add_to(takes);
      return takes;
    }
  }
  const WorkClock clock;
  const PassingFolder folder;
  work.make(number, folder.path());
  takes.file_bytes = folder.bytes();
  takes.seconds = takes.processor_seconds = 0.0;
  clock.add_to(takes);
  takes.peak_bytes = std::max(takes.peak_bytes, static_cast<double>(peak_bytes()));
  return takes;
}

}  // namespace

SetPrediction predict_set(std::uint64_t begin, std::uint64_t end, const MemberWork& work) {
  SetPrediction set{{}, sampled_members(begin, end)};
  const double share = static_cast<double>(end - begin) / static_cast<double>(set.sampled.size());
  for (const std::uint64_t number : set.sampled) {
    MemberTakes one;
    try {
      one = takes_of(number, work);
    } catch (const InputError& e) {
      throw InputError(fmt::format("member {}: {}", number, e.what()));
    }
    set.all.triangles += share * one.triangles;
    set.all.file_bytes += share * one.file_bytes;
    set.all.seconds += share * one.seconds;
    set.all.processor_seconds += share * one.processor_seconds;
    set.all.peak_bytes = std::max(set.all.peak_bytes, one.peak_bytes);
  }
  return set;
}

}  // namespace astrolith
