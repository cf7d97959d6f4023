#include "apps/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <memory>
#include <new>

#include "apps/help_formatter.h"
#include "apps/option_names.h"
#include "apps/output_names.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/parallel_for.h"
#include "numerics/printable_text.h"
#include "numerics/version/code_version.h"

namespace astrolith {
namespace {

std::atomic<int> g_interrupts{0};
std::atomic<int> g_signal{0};  // that came first
// True while the cursor stands at the end of an unfinished progress bar.
std::atomic<bool> g_bar_open{false};

void on_interrupt(int signal_number) {
  int none = 0;
  g_signal.compare_exchange_strong(none, signal_number);
  if (g_interrupts.fetch_add(1) > 0) {
    remove_temporary_files();
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
  }
}

void end_bar() {
  if (g_bar_open.exchange(false)) std::fputc('\n', stderr);
}

// Prints one line below the unfinished progress bar, if there is one. All messages of all programs pass here:
// they may quote libraries, files and file names, with line breaks and terminal controls in them. A closed
// stderr is no reason to fail.
void print_line(const std::string& text) {
  end_bar();
  std::fputs((printable(text) + "\n").c_str(), stderr);
}

std::string bar(double fraction) {
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(kWidth * std::clamp(fraction, 0.0, 1.0));
  return std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(kWidth - filled), '.');
}

void write_summary(const std::string& file_name, const nlohmann::ordered_json& summary) {
  // File names need not be UTF-8.
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  write_file(file_name, summary.dump(2, ' ', false, replace) + "\n");
}

// Name of an option whose number is NaN or infinite, which CLI11's ranges let through; empty when there is
// none.
std::string option_not_finite(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_type_name().rfind("FLOAT", 0) != 0) continue;
    for (const std::string& text : option->results()) {
      if (!std::isfinite(std::strtod(text.c_str(), nullptr))) return option->get_lnames().front();
    }
  }
  return "";
}

// The program's long options without their dashes, and those of the command that was given.
std::vector<std::string> long_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  }
  for (const CLI::App* command : app.get_subcommands()) {
    for (const std::string& name : long_names(*command)) names.push_back(name);
  }
  return names;
}

// The complaint about the first option that does not exist, with the one that was probably meant; empty where
// all exist. CLI11 names neither, and complains first of what is missing because of the wrong name.
std::string unknown_option(const CLI::App& app) {
  for (const std::string& word : app.remaining(true)) {
    const std::size_t dashes = word.find_first_not_of('-');
    if (!word.starts_with('-') || dashes == std::string::npos) continue;
    const std::string nearest = nearest_name(word.substr(dashes, word.find('=') - dashes), long_names(app));
    return word + ": there is no such option" +
           (nearest.empty() ? std::string() : "; did you mean --" + nearest + "?");
  }
  return "";
}

// The options that name a file to write, and those, beside the positional ones, that name a file to read.
const std::vector<std::string> kOutputs{"output",     "summary",      "out",          "spectrum",
                                        "preview",    "preview-maps", "feature-list", "write-recipe",
                                        "height-map", "manifest"};
const std::vector<std::string> kInputs{"base", "target", "points"};

// Libraries name a parameter at the beginning of a message, such as "patch: no surface crosses this cube".
// The result names the program's option of that name instead, if there is one.
std::string naming_options(const std::string& message, const CLI::App& app) {
  const std::size_t end = std::min(message.find(':'), message.size());
  std::string name = message.substr(0, end);
  std::replace(name.begin(), name.end(), '_', '-');
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional() && option->check_lname(name)) return "--" + name + message.substr(end);
  }
  return message;
}

bool is_named(const CLI::Option& option, const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return option.check_lname(name); });
}

// All options that were given to the program and to its command.
std::vector<const CLI::Option*> given(const CLI::App& app) {
  std::vector<const CLI::Option*> options;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() > 0) options.push_back(option);
  }
  for (const CLI::App* subcommand : app.get_subcommands()) {
    for (const CLI::Option* option : given(*subcommand)) options.push_back(option);
  }
  return options;
}

// Throws InputError for an output without a name.
void require_names(const CLI::App& app) {
  for (const CLI::Option* option : given(app)) {
    if (is_named(*option, kOutputs) && option->results().front().empty())
      throw InputError(option->get_lnames().front() + ": is given without a name; give one, or leave it out");
  }
}

// Throws InputError when an output is an input, or another output.
void require_distinct_files(const CLI::App& app) {
  const std::vector<const CLI::Option*> options = given(app);
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (!is_named(*options[i], kOutputs)) continue;
    const std::string output = options[i]->results().front();
    for (std::size_t j = 0; j < options.size(); ++j) {
      const bool reads = options[j]->get_positional() || is_named(*options[j], kInputs);
      for (const std::string& other : options[j]->results()) {
        if (reads) require_other_file(output, other);
        if (j > i && is_named(*options[j], kOutputs)) require_two_files(output, other);
      }
    }
  }
}

}  // namespace

void print_result(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return;
  throw WorkError(errno == EPIPE ? "stdout: nobody reads it any more"
                                 : "stdout: writing failed; is the disk full?");
}

Program::Program(std::string name, std::string description)
    : parser_(std::make_unique<CLI::App>(std::move(description), name)),
      app(*parser_),
      name_(std::move(name)) {
  parser_->formatter(std::make_shared<HelpFormatter>());
  parser_->option_defaults()->always_capture_default();
  parser_->set_version_flag("--version", tool());
  app.add_option("--seed", seed,
                 "seed of everything random; same input, options and seed give the same bytes")
      .check(in_range(std::int64_t{0}, (std::int64_t{1} << 53) - 1));
  app.add_option("--threads", threads, "threads to use; 0 = all").check(in_range(0, 1024));
  app.add_flag("--quiet", quiet, "no progress and no messages, errors only");
  app.add_option("--summary", summary_file, "write the figures of the run to this JSON file")
      .placeholder("FILE");
}

Program::~Program() = default;

int Program::run(int argc, char** argv, const std::function<void()>& work) {
  try {
    parser_->parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return parser_->exit(e);  // --help, --version
    const std::string unknown = unknown_option(*parser_);
    print_line(fmt::format("{}: {}; see {} --help", name_, unknown.empty() ? e.what() : unknown, name_));
    return 2;
  }
  if (const std::string wrong = option_not_finite(*parser_); !wrong.empty()) {
    print_line(fmt::format("{}: --{}: must be a finite number; see {} --help", name_, wrong, name_));
    return 2;
  }
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  std::signal(SIGPIPE, SIG_IGN);  // a message that nobody reads, as before `| head`, ends no work
  std::signal(SIGXFSZ, SIG_IGN);  // a file larger than allowed is an error of writing like any other
  const ThreadLimit limit(threads);
  try {
    timed(work);
    end_bar();
    if (part_failed_) return 1;
    return interrupted() ? 3 : 0;
  } catch (const InputError& e) {
    print_line(fmt::format("{}: {}", name_, naming_options(e.what(), *parser_)));
    return 2;
  } catch (const std::bad_alloc&) {
    print_line(fmt::format("{}: out of memory; try a smaller resolution or fewer samples", name_));
    return 1;
  } catch (const std::exception& e) {
    print_line(fmt::format("{}: {}", name_, e.what()));
    return 1;
  }
}

double Program::processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double Program::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Program::timed(const std::function<void()>& work) {
  require_names(*parser_);
  require_distinct_files(*parser_);
  // A summary that cannot be written should not be found out after an hour's work.
  if (!summary_file.empty()) {
    require_extension(summary_file, {".json"});
    if (!makes_folders || !makes_folders()) require_writable(summary_file);
  }
  start_ = std::chrono::steady_clock::now();
  work();
  for (const std::string& line : notes_) say(line);
  if (!summary_file.empty()) save_summary(summary_file);
}

void Program::save_summary(const std::string& file) {
  if (!summary.contains("seconds")) summary["seconds"] = seconds();
  if (interrupted()) summary["interrupted"] = true;
  write_summary(file, summary);
}

Progress Program::progress(std::string stage) const {
  struct State {
    double shown_at = -1.0;
    double farthest = 0.0;  // work that turns out longer than thought does not run backwards
    std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();
  };
  const bool draw = !quiet && ::isatty(STDERR_FILENO) != 0;
  return [draw, stage = std::move(stage), state = std::make_shared<State>()](double fraction,
                                                                             std::string_view words) {
    const std::chrono::duration<double> now = std::chrono::steady_clock::now() - state->started;
    fraction = state->farthest = std::max(state->farthest, fraction);
    if (draw && (fraction >= 1.0 || now.count() - state->shown_at > 0.1)) {
      state->shown_at = now.count();
      const std::string line =
          fmt::format("\r{:<10} [{}] {:3.0f} % {:5.1f} s  {}\x1b[K{}", stage, bar(fraction), 100.0 * fraction,
                      now.count(), printable(words), fraction >= 1.0 ? "\n" : "");
      std::fputs(line.c_str(), stderr);
      g_bar_open = fraction < 1.0;
    }
    return !interrupted();
  };
}

bool Program::interrupted() { return g_interrupts.load() > 0; }

const char* Program::stopped_by() { return g_signal.load() == SIGTERM ? "SIGTERM" : "Ctrl-C"; }

void Program::say(const std::string& line) const {
  if (!quiet) print_line(line);
}

void Program::report_failure(const std::string& line) {
  part_failed_ = true;
  print_line(fmt::format("{}: {}", name_, line));
}

std::string Program::tool() const { return name_ + " " + kCodeVersion.text(); }

std::vector<std::pair<std::string, std::string>> Program::given_options() const {
  static const std::vector<std::string> kNoEffect{"output",  "threads",     "quiet",      "summary",
                                                  "report",  "spectrum",    "checkpoint", "help",
                                                  "version", "write-recipe"};
  std::vector<std::pair<std::string, std::string>> given;
  for (const CLI::Option* option : parser_->get_options()) {
    if (option->count() == 0 || option->get_positional()) continue;
    std::string key = option->get_lnames().empty() ? option->get_name() : option->get_lnames().front();
    if (std::find(kNoEffect.begin(), kNoEffect.end(), key) != kNoEffect.end()) continue;
    given.emplace_back(std::move(key), CLI::detail::join(option->results(), " "));
  }
  std::sort(given.begin(), given.end());
  return given;
}

}  // namespace astrolith
