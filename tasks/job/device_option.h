// --device: whether a program computes on the GPU.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <string>
#include <system_error>

#include "cuda/device.h"
#include "numerics/errors.h"
#include "tasks/job/job.h"

namespace astrolith {

// The device that computes.
struct ChosenDevice {
  bool gpu = false;
  std::string words;  // "computed on the CPU: no CUDA device"; empty where nobody asked

  explicit operator bool() const { return gpu; }
  // The words as the end of a line of the program; empty where there are none.
  std::string remark() const { return words.empty() ? "" : "; " + words; }
};

struct DeviceOption {
  std::string device = "auto";

  void add_to(OptionTable& app) {
    app.add_option("--device", device,
                   "what computes: cuda, the first GPU; cpu; auto, the GPU where there is one. The bytes of "
                   "the result are meant to be the same, which a twin on the host is tested for")
        .check(one_of({"auto", "cpu", "cuda"}));
  }

  // Looks at the device beside other work, since a GPU takes a quarter of a second to start. The future waits
  // for it when it is destroyed.
  std::future<void> start() const {
    if (device == "cpu") return {};
    try {
      return std::async(std::launch::async, [] { probe_device(); });
    } catch (const std::system_error&) {  // no thread is left: choose() looks at the device
      return {};
    }
  }

  // Whether a GPU may be used that has not failed.
  bool has_gpu() const { return device != "cpu" && !*has_failed_ && probe_device().usable; }

  // Chooses the GPU where there is one, unless --device says cpu. Otherwise the CPU computes, and the words
  // say why to those who gave --device or --summary. A GPU that cannot be trusted is named in a line of its
  // own. With "cuda", a GPU that is missing or cannot be trusted is an InputError. The summary states the
  // device.
  ChosenDevice choose(Job& job) const {
    if (*has_failed_) return on_cpu(job, "the GPU failed before");
    const DeviceStatus status = device == "cpu" ? DeviceStatus{} : probe_device();
    if (!status.usable && device == "cuda") {
      throw InputError("--device cuda: " + status.reason + "; leave it out for the CPU");
    }
    const bool is_there = status.compute_capability > 0;
    if (is_there && !status.usable) job.note(status.name + " is not used: " + status.reason);
    job.summary["device"] = status.usable ? status.name : "cpu";
    if (status.usable) return {true, "computed on " + status.name};
    return on_cpu(job, status.reason);
  }

  // Chooses the CPU for work that the GPU cannot do. `lacking` names the part that the GPU lacks in a few
  // words; it is empty where the GPU can do all.
  ChosenDevice choose(Job& job, const std::string& lacking) const {
    if (lacking.empty() || device == "cpu") return choose(job);
    const std::string words = "the GPU does not compute " + lacking;
    if (device == "cuda") throw InputError("--device cuda: " + words + "; leave it out for the CPU");
    const ChosenDevice chosen = choose(job);
    job.summary["device"] = "cpu";
    return chosen.gpu ? on_cpu(job, words) : chosen;
  }

  // The CPU in place of a GPU that failed in the middle of the work, from now on and for all copies of this
  // option: members have one each. The first failure is told. Where --device asked for the GPU, `error` goes
  // on.
  ChosenDevice after_failure(Job& job, const DeviceError& error) const {
    if (device == "cuda") throw;
    if (!has_failed_->exchange(true))
      job.note(std::string(error.what()) + "; the CPU does the work from its beginning");
    job.summary["device"] = "cpu";
    return on_cpu(job, error.what());
  }

 private:
  static ChosenDevice on_cpu(const Job& job, const std::string& why) {
    const OptionRow* const summary = job.options.find("--summary");
    const bool asked =
        job.options.option("--device").count() > 0 || (summary != nullptr && !summary->words.empty());
    if (!asked) return {};
    return {false, "computed on the CPU" + (why.empty() ? "" : ": " + why)};
  }

  // Whether the GPU failed in the middle of a mesh.
  std::shared_ptr<std::atomic<bool>> has_failed_ = std::make_shared<std::atomic<bool>>(false);
};

}  // namespace astrolith
