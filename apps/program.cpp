#include "apps/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <new>

#include "apps/version.h"
#include "numerics/errors.h"
#include "numerics/output_file.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

std::atomic<int> g_interrupts{0};

void on_interrupt(int signal_number) {
  if (g_interrupts.fetch_add(1) > 0) {
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
  }
}

// Messages of libraries may hold line breaks; the promise is one line.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string bar(double fraction) {
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(kWidth * std::clamp(fraction, 0.0, 1.0));
  return std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(kWidth - filled), '.');
}

void write_summary(const std::string& file_name, const nlohmann::ordered_json& summary) {
  OutputFile file(file_name);
  const std::string text = summary.dump(2) + "\n";
  file.write(text.data(), text.size());
  file.commit();
}

}  // namespace

Program::Program(std::string name, std::string description)
    : app(std::move(description), name), name_(std::move(name)) {
  app.option_defaults()->always_capture_default();
  app.set_version_flag("--version", tool());
  app.add_option("--seed", seed,
                 "seed of everything random; same input, options and seed give the same bytes")
      ->check(CLI::Range(std::uint64_t{0}, (std::uint64_t{1} << 53) - 1));
  app.add_option("--threads", threads, "threads to use; 0 = all")->check(CLI::Range(0, 1024));
  app.add_flag("--quiet", quiet, "no progress and no messages, errors only");
  app.add_option("--summary", summary_file, "write the figures of the run to this JSON file")
      ->option_text("FILE");
}

int Program::run(int argc, char** argv, const std::function<void()>& work) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    fmt::print(stderr, "{}: {}; see {} --help\n", name_, one_line(e.what()), name_);
    return 2;
  }
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  const ThreadLimit limit(threads);
  const auto start = std::chrono::steady_clock::now();
  try {
    work();
    if (!summary_file.empty()) {
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      if (!summary.contains("seconds")) summary["seconds"] = seconds.count();
      write_summary(summary_file, summary);
    }
    return 0;
  } catch (const InputError& e) {
    fmt::print(stderr, "{}: {}\n", name_, one_line(e.what()));
    return 2;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "{}: out of memory; try a smaller resolution or fewer samples\n", name_);
    return 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: {}\n", name_, one_line(e.what()));
    return 1;
  }
}

Progress Program::progress(std::string stage) const {
  struct State {
    double shown_at = -1.0;
    std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();
  };
  const bool draw = !quiet && ::isatty(STDERR_FILENO) != 0;
  return [draw, stage = std::move(stage), state = std::make_shared<State>()](double fraction,
                                                                             std::string_view words) {
    if (draw) {
      const std::chrono::duration<double> now = std::chrono::steady_clock::now() - state->started;
      if (fraction >= 1.0 || now.count() - state->shown_at > 0.1) {
        state->shown_at = now.count();
        fmt::print(stderr, "\r{:<10} [{}] {:3.0f} % {:5.1f} s  {}\x1b[K{}", stage, bar(fraction),
                   100.0 * fraction, now.count(), words, fraction >= 1.0 ? "\n" : "");
        std::fflush(stderr);
      }
    }
    return !interrupted();
  };
}

bool Program::interrupted() { return g_interrupts.load() > 0; }

void Program::say(const std::string& line) const {
  if (!quiet) fmt::print(stderr, "{}\n", line);
}

std::string Program::tool() const { return name_ + " " + ASTROLITH_VERSION; }

std::vector<std::pair<std::string, std::string>> Program::given_options() const {
  static const std::vector<std::string> kNoEffect{"output", "threads",  "quiet", "summary",
                                                  "report", "spectrum", "help",  "version"};
  std::vector<std::pair<std::string, std::string>> given;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0 || option->get_positional()) continue;
    std::string key = option->get_lnames().empty() ? option->get_name() : option->get_lnames().front();
    if (std::find(kNoEffect.begin(), kNoEffect.end(), key) != kNoEffect.end()) continue;
    given.emplace_back(std::move(key), CLI::detail::join(option->results(), " "));
  }
  std::sort(given.begin(), given.end());
  return given;
}

}  // namespace astrolith
