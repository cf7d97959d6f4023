#include "apps/program.h"

#include <fmt/format.h>
#include <sys/time.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "numerics/edit_distance.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/parallel_for.h"
#include "numerics/printable_text.h"
#include "numerics/process_limits.h"
#include "tasks/job/output_names.h"
#include "tasks/job/words.h"

namespace astrolith {
namespace {

// Help as people and help2man read it: "-t, --threads N in [0 - 1024] (default 0)" rather than CLI11's type
// and validator names. Two spaces or a new line stand before each description.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    std::string name = CLI::Formatter::make_option_name(option, is_positional);
    if (const std::size_t comma = name.find(','); comma != std::string::npos) name.insert(comma + 1, " ");
    return name;
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_option_text().empty() ? "" : " " + option->get_option_text();
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    const std::size_t first_column =
        2 + (make_option_name(option, option->get_positional()) + make_option_opts(option)).size();
    const std::string description = CLI::Formatter::make_option_desc(option);
    return first_column + 1 == get_column_width() ? " " + description : description;
  }
};

std::atomic<int> g_interrupts{0};
std::atomic<int> g_signal{0};  // that came first
// True while the cursor stands at the end of an unfinished progress bar.
std::atomic<bool> g_bar_open{false};

std::atomic<bool> g_keeps_best{false};

// Called by signal handlers. Files without a name vanish with the process.
void end_at_once(int signal_number) {
  remove_temporary_files();
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);
}

void on_alarm(int) { end_at_once(g_signal); }

// Steps of libraries cannot be stopped: work that leaves nothing gets half a second to say so. The system
// takes its time to free much memory.
void on_interrupt(int signal_number) {
  int none = 0;
  g_signal.compare_exchange_strong(none, signal_number);
  if (g_interrupts.fetch_add(1) > 0) return end_at_once(signal_number);
  constexpr itimerval kGrace{{}, {0, 500000}};
  if (!g_keeps_best) ::setitimer(ITIMER_REAL, &kGrace, nullptr);
}

// Ignored, it stays so: a shell starts its background jobs that way.
void heed(int signal_number) {
  if (std::signal(signal_number, on_interrupt) == SIG_IGN) std::signal(signal_number, SIG_IGN);
}

// Dies of the signal that stopped the work, so that whoever started the program knows: a shell's loop ends.
[[noreturn]] void end_by_signal() {
  std::fflush(nullptr);
  std::signal(g_signal, SIG_DFL);
  std::raise(g_signal);
  std::abort();  // not reached
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

// The table's long options without their dashes, and those of its commands.
std::vector<std::string> long_names(const OptionTable& options) {
  std::vector<std::string> names{"help", "version"};
  for (const auto& row : options.rows()) {
    if (!row->positional()) names.push_back(row->name());
  }
  for (const OptionTable::Command& command : options.commands()) {
    for (const std::string& name : long_names(*command.options)) names.push_back(name);
  }
  return names;
}

// The complaint about the first option that does not exist, with the one that was probably meant; empty where
// all exist. CLI11 names neither, and complains first of what is missing because of the wrong name.
std::string unknown_option(const CLI::App& parser, const OptionTable& options) {
  for (const std::string& word : parser.remaining(true)) {
    const std::size_t dashes = word.find_first_not_of('-');
    if (!word.starts_with('-') || dashes == std::string::npos) continue;
    const std::string name = word.substr(dashes, word.find('=') - dashes);
    for (const OptionTable::Command& command : options.commands()) {
      if (command.options->find("--" + name) == nullptr) continue;
      const std::string its = word + ": is an option of '" + parser.get_name() + " " + command.name + "'";
      return its + (parser.get_subcommands().empty() ? "; write the command before it" : " alone");
    }
    const std::string nearest = nearest_name(name, long_names(options));
    return word + ": there is no such option" +
           (nearest.empty() ? std::string() : "; did you mean --" + nearest + "?");
  }
  return "";
}

// What is wrong with a command line whose options all exist. CLI11 says "At Most 1 required but received 2".
std::string plain_words(const CLI::ParseError& error, const CLI::App& parser) {
  const std::string text = error.what();
  const auto says = [&](const char* words) { return text.find(words) != text.npos; };
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    const std::string name = text.substr(0, text.find(':'));
    if (says(": At Most ")) return name + ": is given twice, or with too many values";
    if (says(": At least ") || text.ends_with("missing")) return name + ": a value is missing";
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !parser.remaining(true).empty())
    return parser.remaining(true).front() + ": belongs to no option, and no argument is left for it";
  return text;
}

// Throws std::bad_alloc where nearly all memory is taken. Libraries that read and transform images abort when
// they get none for their small tables, without a word.
void require_some_memory() {
  constexpr std::size_t kEnough = 16 << 20;
  void* const volatile room = ::operator new(kEnough);  // a volatile pair is not optimized away
  ::operator delete(room);
}

// Hands a row of the table to CLI11, which cuts the command line into words.
void declare(OptionRow& row, CLI::App& parser) {
  CLI::Option* option = nullptr;
  if (row.is_flag()) {
    option = parser.add_flag_callback(
        row.names, [&row] { OptionTable::set(row, {"true"}); }, row.meaning);
  } else {
    const auto store = [&row](const CLI::results_t& words) { return OptionTable::set(row, words), true; };
    option = parser.add_option(row.names, store, row.meaning);
    option->type_size(row.words_per_value());
    if (row.count > 0) {
      option->expected(row.count);
    } else if (row.takes_several()) {
      option->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args(!row.repeated);
    }
    option->option_text(row.value_words());
  }
  option->required(row.required);
}

// The words of a command line, the last first, as CLI11 takes them. An option that stands without a value
// gets the one that it means.
std::vector<std::string> option_words(const OptionTable& options, int argc, char** argv) {
  std::vector<std::string> words;
  for (int i = argc - 1; i > 0; --i) {
    std::string word = argv[i];
    const OptionRow* const row = word.starts_with("--") ? options.find(word) : nullptr;
    if (row != nullptr && !row->implied.empty() && (words.empty() || !row->takes(words.back())))
      word += "=" + row->implied;
    words.push_back(std::move(word));
  }
  return words;
}

void declare(OptionTable& options, CLI::App& parser) {
  for (const auto& row : options.rows()) declare(*row, parser);
  for (const OptionTable::Command& command : options.commands()) {
    CLI::App* const sub = parser.add_subcommand(command.name, command.meaning)->fallthrough();
    sub->callback([&command] { command.options->set_given(); });
    declare(*command.options, *sub);
  }
  if (options.needs_command()) parser.require_subcommand(1);
}

}  // namespace

void Program::print_result(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return;
  throw WorkError(errno == EPIPE ? "stdout: nobody reads it any more"
                                 : "stdout: writing failed; is the disk full?");
}

Program::Program(std::string name, std::string description)
    : Job(std::move(name)), description_(std::move(description)) {
  options.add_option("--threads", threads, "threads to use; 0 = all")
      .check(in_range(0, 1024))
      .without_effect();
  options.add_flag("--quiet", quiet, "no progress and no messages, errors only").without_effect();
  options.add_option("--summary", summary_file, "write the figures of the run to this JSON file").writes();
}

Program::~Program() = default;

std::optional<int> Program::parse(int argc, char** argv) {
  CLI::App parser(description_, name_);
  parser.formatter(std::make_shared<HelpFormatter>());
  parser.set_version_flag("--version", tool());
  declare(options, parser);
  const auto refuse = [&](const std::string& why) {
    print_line(fmt::format("{}: {}; see {} --help", name_, why, name_));
    return 2;
  };
  try {
    std::vector<std::string> words = option_words(options, argc, argv);
    parser.parse(words);
    options.check_combination();
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return parser.exit(e);  // --help, --version
    const std::string unknown = unknown_option(parser, options);
    return refuse(unknown.empty() ? plain_words(e, parser) : unknown);
  } catch (const InputError& e) {
    return refuse(e.what());
  }
  return std::nullopt;
}

int Program::run(int argc, char** argv, const std::function<void()>& work) {
  const auto ended = [](int status) {
    if (interrupted()) end_by_signal();
    return status;
  };
  try {
    if (const std::optional<int> status = parse(argc, argv)) return *status;
    heed(SIGINT);
    heed(SIGTERM);
    std::signal(SIGALRM, on_alarm);
    std::signal(SIGPIPE, SIG_IGN);  // a message that nobody reads, as before `| head`, ends no work
    std::signal(SIGXFSZ, SIG_IGN);  // a file larger than allowed is an error of writing like any other
    require_some_memory();
    const ThreadLimit limit(threads > 0 ? threads : usable_processors());
    timed(work);
    end_bar();
    return ended(part_failed_ ? 1 : 0);
  } catch (const InputError& e) {
    print_line(fmt::format("{}: {}", name_, naming_options(e.what())));
    return ended(2);
  } catch (const std::bad_alloc&) {
    print_line(fmt::format("{}: out of memory; try a smaller resolution or fewer samples", name_));
    return ended(1);
  } catch (const std::exception& e) {
    print_line(fmt::format("{}: {}", name_, e.what()));
    return ended(1);
  }
}

void Program::timed(const std::function<void()>& work) {
  options.check_files();
  // A summary that cannot be written should not be found out after an hour's work.
  if (!summary_file.empty()) {
    require_extension(summary_file, {".json"});
    // Work that makes folders makes that of the summary, too, and then checks that it can be written.
    if (!options.makes_folders()) require_writable(summary_file);
  }
  start_ = std::chrono::steady_clock::now();
  work();
  for (const std::string& line : notes_) say(line);
  if (!summary_file.empty()) save_summary(summary_file);
}

void Program::save_summary(const std::string& file) {
  if (!summary.contains("seconds")) summary["seconds"] = seconds();
  if (interrupted()) summary["interrupted"] = true;
  write_file(file, json_text(summary));
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

void Program::keep_best_so_far() { g_keeps_best = true; }

bool Program::interrupted() { return g_interrupts.load() > 0; }

const char* Program::stopped_by() const { return g_signal.load() == SIGTERM ? "SIGTERM" : "Ctrl-C"; }

void Program::say(const std::string& line) const {
  if (!quiet) print_line(line);
}

void Program::report_failure(const std::string& line) {
  part_failed_ = true;
  print_line(fmt::format("{}: {}", name_, line));
}

// Libraries name a parameter at the beginning of a message, such as "patch: no surface crosses this cube".
std::string Program::naming_options(const std::string& message) const {
  const std::size_t end = std::min(message.find(':'), message.size());
  std::string name = message.substr(0, end);
  std::replace(name.begin(), name.end(), '_', '-');
  const OptionRow* const row = options.find(name);
  if (name.empty() || row == nullptr || row->positional() || row->name() != name) return message;
  return "--" + name + message.substr(end);
}

}  // namespace astrolith
