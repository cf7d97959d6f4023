// --device: whether a program computes on the GPU.
#pragma once

#include <string>

#include "apps/program.h"
#include "cuda/device.h"
#include "numerics/errors.h"

namespace astrolith {

// What computes, once it is known.
struct ChosenDevice {
  bool gpu = false;
  std::string words;  // "computed on the CPU: no CUDA device": for the line that closes the work

  explicit operator bool() const { return gpu; }
};

struct DeviceOption {
  std::string device = "auto";

  void add_to(CommandLine& app) {
    app.add_option("--device", device,
                   "what computes: cuda, the first GPU; cpu; auto, the GPU where there is one. The result is "
                   "the same, byte for byte")
        .check(one_of({"auto", "cpu", "cuda"}));
  }

  // Looks at the GPU unless told not to. Where there is none, the CPU computes and the words say why; one
  // that cannot be trusted is worth a line of its own, and with "cuda" either is an InputError. States in
  // the summary what computes.
  ChosenDevice choose(Program& program) const {
    const DeviceStatus status = device == "cpu" ? DeviceStatus{} : probe_device();
    if (!status.usable && device == "cuda") {
      throw InputError("--device cuda: " + status.reason + "; leave it out for the CPU");
    }
    const bool is_there = status.compute_capability > 0;
    if (is_there && !status.usable) program.note(status.name + " is not used: " + status.reason);
    program.summary["device"] = status.usable ? status.name : "cpu";
    if (status.usable) return {true, "computed on " + status.name};
    return on_cpu(status.reason);
  }

  // The same for work of which the GPU lacks a part, in a few words; nothing where `lacking` is empty.
  ChosenDevice choose(Program& program, const std::string& lacking) const {
    if (lacking.empty() || device == "cpu") return choose(program);
    const std::string words = "the GPU does not compute " + lacking;
    if (device == "cuda") throw InputError("--device cuda: " + words + "; leave it out for the CPU");
    const ChosenDevice chosen = choose(program);
    program.summary["device"] = "cpu";
    return chosen.gpu ? on_cpu(words) : chosen;
  }

 private:
  static ChosenDevice on_cpu(const std::string& why) {
    return {false, "computed on the CPU" + (why.empty() ? "" : ": " + why)};
  }
};

}  // namespace astrolith
