// The frame of every program: the common options, progress bars on a terminal, one-line errors,
// Ctrl-C, --summary, and the exit status: 0 (done), 1 (the work failed) or 2 (the command line or an input is
// wrong). A program that a signal stops cleans up, keeps the best so far, and then dies of that signal.
//
//   int main(int argc, char** argv) {
//     Program program("synth", "Turns a recipe into a mesh.");
//     program.options.add_option("recipe", recipe, "the recipe").required().reads();
//     return program.run(argc, argv, [&] { ...; program.summary["triangles"] = n; });
//   }
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tasks/job/job.h"

namespace astrolith {

class Program : public Job {
 public:
  Program(std::string name, std::string description);
  ~Program() override;

  // Parses, limits threads, runs work, writes the summary; returns the exit status. Exceptions of work become
  // one line on stderr: InputError gives 2, everything else 1, and so does a reported failure. After Ctrl-C
  // the process ends by its signal in place of a return. The summary is written only when the work is done;
  // it holds "seconds", and "interrupted" after a Ctrl-C that left a best result so far.
  int run(int argc, char** argv, const std::function<void()>& work);

  // Draws a bar labelled with the stage while stderr is a terminal and --quiet is not given; asks the work to
  // stop once Ctrl-C has been pressed. A second Ctrl-C ends the program at once.
  Progress progress(std::string stage) const override;
  // True once Ctrl-C has been pressed.
  static bool interrupted();
  bool stopped() const override { return interrupted(); }
  void keep_best_so_far() override;
  // "Ctrl-C", or "SIGTERM" where that signal came first, which counts as Ctrl-C.
  const char* stopped_by() const override;

  // Prints one line to stderr, unless --quiet was given.
  void say(const std::string& line) const override;
  void note(const std::string& line) override {
    if (!quiet) notes_.push_back(line);
  }
  // Writes to stdout.
  void print_result(const std::string& text) override;
  // Prints one line to stderr, also with --quiet; the exit status will be 1.
  void report_failure(const std::string& line) override;

  // Writes the summary so far into a file, with the seconds and an interruption; run() does it in the end.
  void save_summary(const std::string& file);

  int threads = 0;  // 0 = all
  std::string summary_file;

 private:
  // Sets the options; the status to end with after --help, --version or a command line that is wrong.
  std::optional<int> parse(int argc, char** argv);
  void timed(const std::function<void()>& work);
  // The library's text of an error, which names options by their words, with the program's names of options.
  std::string naming_options(const std::string& message) const;

  std::string description_;
  std::vector<std::string> notes_;
  bool part_failed_ = false;
};

}  // namespace astrolith
