// The frame of all programs (apps/program.h), around small pieces of work.
#include "apps/program.h"

#include <sys/resource.h>
#include <unistd.h>
#include <chrono>
#include <thread>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "tasks/job/words.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

int run_status(std::vector<std::string> arguments, const std::function<void(Program&)>& work) {
  Program program("tool", "A program for tests.");
  arguments.insert(arguments.begin(), "tool");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  return program.run(static_cast<int>(argv.size()), argv.data(), [&] { work(program); });
}

struct Outcome {
  int status;
  std::string errors;
};

Outcome run(const std::vector<std::string>& arguments, const std::function<void(Program&)>& work) {
  ::testing::internal::CaptureStderr();
  const int status = run_status(arguments, work);
  return {status, ::testing::internal::GetCapturedStderr()};
}

TEST(Program, StatusSaysWhoseFaultItWas) {
  EXPECT_EQ(run({}, [](Program&) {}).status, 0);
  EXPECT_EQ(run({}, [](Program&) { throw InputError("a.obj: bad; mend it"); }).status, 2);
  EXPECT_EQ(run({}, [](Program&) { throw WorkError("disk full"); }).status, 1);
  EXPECT_EQ(run({}, [](Program&) { throw std::bad_alloc(); }).status, 1);
  EXPECT_EQ(run({"--unknown"}, [](Program&) { FAIL(); }).status, 2);
  EXPECT_EQ(run({"--threads", "-1"}, [](Program&) { FAIL(); }).status, 2);
  EXPECT_EQ(run({"--seed", "9007199254740992"}, [](Program&) { FAIL(); }).status, 2);
}

TEST(Program, AnErrorIsOneLineOfText) {
  EXPECT_EQ(run({}, [](Program&) { throw InputError("a\nb\x1b[31m.obj: bad\r\n"); }).errors,
            "tool: a\\nb\\x1b[31m.obj: bad\\r\\n\n");
  const std::string errors = run({"--unknown"}, [](Program&) {}).errors;
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  EXPECT_NE(errors.find("--unknown"), std::string::npos);
}

TEST(Program, AMisspeltOptionIsNamedWithTheNearest) {
  const auto complaint = [](const std::vector<std::string>& words) {
    return run(words, [](Program&) { FAIL(); }).errors;
  };
  const std::string meant = "there is no such option; did you mean --";
  for (const char* wrong : {"--summry", "--sumary=a.json", "-summary", "--summarry", "--smumary", "--summ"}) {
    EXPECT_EQ(complaint({wrong, "3"}),
              "tool: " + std::string(wrong) + ": " + meant + "summary?; see tool --help\n");
  }
  EXPECT_NE(complaint({"--treads", "2"}).find(meant + "threads?"), std::string::npos);
  EXPECT_EQ(complaint({"--seed"}), "tool: --seed: a value is missing; see tool --help\n");
  EXPECT_EQ(complaint({"--seed", "1", "--seed", "2"}),
            "tool: --seed: is given twice, or with too many values; see tool --help\n");
  EXPECT_EQ(complaint({"a", "b"}),
            "tool: a: belongs to no option, and no argument is left for it; see tool --help\n");
  EXPECT_EQ(complaint({"--colour"}), "tool: --colour: there is no such option; see tool --help\n");
}

TEST(Program, AnOptionBeforeItsCommandIsNamedWithIt) {
  Program program("tool", "A program for tests.");
  bool trees = false;
  program.options.add_command("train", "learns").add_flag("--trees", trees, "trees");
  std::vector<std::string> words{"tool", "--trees"};
  std::vector<char*> argv{words[0].data(), words[1].data()};
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(program.run(2, argv.data(), [] { FAIL(); }), 2);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "tool: --trees: is an option of 'tool train'; write the command before it; see tool --help\n");
}

TEST(Program, ASummaryWithAWrongEndingIsRefusedBeforeTheWork) {
  const Outcome outcome = run({"--summary", "figures.txt"}, [](Program&) { FAIL(); });
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.errors, "tool: figures.txt: is no .json file; name it with that extension\n");
}

TEST(CountedWords, HaveTheirPluralsAndUnits) {
  EXPECT_EQ(counted(1, "Gabor layer"), "1 Gabor layer");
  EXPECT_EQ(counted(3, "Gabor layer"), "3 Gabor layers");
  EXPECT_EQ(byte_words(16e3), "16 kB");
  EXPECT_EQ(byte_words(4.24e6), "4.2 MB");
  EXPECT_EQ(byte_words(46.2e6), "46 MB");
  EXPECT_EQ(byte_words(1.26e9), "1.3 GB");
  EXPECT_EQ(size_words({0.5612, 0.3, 0.2456}, "km"), "0.561 x 0.3 x 0.246 km");
}

// U+202E turns the text after it around, U+2028 breaks the line, and U+009B begins a command to a terminal.
TEST(Program, WhatMessagesQuoteCannotHide) {
  const std::string raw = "\u202e\u2028\u009b\xff.json", shown = "\\u202e\\u2028\\u009b\\xff.json";
  EXPECT_EQ(run({}, [&](Program&) { throw InputError(raw); }).errors, "tool: " + shown + "\n");
  EXPECT_EQ(run({}, [&](Program&) { throw WorkError(raw); }).errors, "tool: " + shown + "\n");
  EXPECT_EQ(run({}, [&](Program& p) { p.say(raw); }).errors, shown + "\n");
  EXPECT_EQ(run({}, [&](Program& p) { p.note(raw); }).errors, shown + "\n");
  EXPECT_EQ(run({}, [&](Program& p) { p.report_failure(raw); }).errors, "tool: " + shown + "\n");
  const std::string wrong = run({"--" + raw}, [](Program&) { FAIL(); }).errors;
  EXPECT_NE(wrong.find(shown), std::string::npos) << wrong;
}

TEST(Program, APartThatFailedIsNamedAndTheRestGoesOn) {
  bool went_on = false;
  const Outcome outcome = run({"--quiet"}, [&](Program& program) {
    program.report_failure("a.obj: is empty;\nleft out");
    went_on = true;
  });
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(went_on);
  EXPECT_EQ(outcome.errors, "tool: a.obj: is empty;\\nleft out\n");
}

TEST(Program, RangesAreStatedInWords) {
  double number = 1.0;
  for (const char* wrong : {"0", "-1", "nan", "much"}) {
    Program program("tool", "A program for tests.");
    program.options.add_option("--size", number, "a size").check(above_zero());
    std::vector<std::string> arguments{"tool", "--size", wrong};
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(program.run(3, argv.data(), [] { FAIL(); }), 2);
    EXPECT_LT(::testing::internal::GetCapturedStderr().size(), 100u);
  }
}

TEST(Program, NothingIsDrawnInAPipe) {
  EXPECT_EQ(run({}, [](Program& p) { p.progress("fit")(0.5, "half"); }).errors, "");
  EXPECT_EQ(run({}, [](Program& p) { p.say("done"); }).errors, "done\n");
  EXPECT_EQ(run({"--quiet"}, [](Program& p) { p.say("done"); }).errors, "");
}

TEST(Program, SummaryIsWrittenWhenTheWorkIsDone) {
  const testing::ScratchFolder folder;
  const std::string file = folder / "s.json";
  const auto fill = [](Program& p) { p.summary["name"] = "caf\xe9.png"; };  // Latin-1, not UTF-8
  EXPECT_EQ(run({"--summary", file}, fill).status, 0);
  const auto summary = nlohmann::json::parse(std::ifstream(file));
  EXPECT_EQ(summary.at("name"), "caf\xef\xbf\xbd.png");
  EXPECT_GE(summary.at("seconds").get<double>(), 0.0);
  EXPECT_FALSE(summary.contains("interrupted"));

  const std::string none = folder / "none.json";
  EXPECT_EQ(run({"--summary", none}, [](Program&) { throw WorkError("no"); }).status, 1);
  EXPECT_FALSE(std::filesystem::exists(none));
}

TEST(Program, AnUnwritableSummaryIsFoundOutBeforeTheWork) {
  bool worked = false;
  const auto outcome = run({"--summary", "/nonexistent/s.json"}, [&](Program&) { worked = true; });
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("/nonexistent/s.json"), std::string::npos);
  EXPECT_FALSE(worked);
}

TEST(Program, GivenOptionsAreThoseThatChangeTheResult) {
  run({"--seed", "7", "--threads", "2", "--quiet"}, [](Program& p) {
    const auto given = p.options.given();
    ASSERT_EQ(given.size(), 1u);
    EXPECT_EQ(given[0], std::make_pair(std::string("seed"), std::string("7")));
  });
}

// The work runs in a child process, since a signal marks the process for good.
TEST(ProgramDeathTest, CtrlCKeepsTheBestSoFar) {
  const testing::ScratchFolder folder;
  const std::string file = folder / "s.json";
  const auto work = [](Program& p) {
    const Progress progress = p.progress("fit");
    if (!progress(0.1, "")) std::exit(10);
    std::raise(SIGINT);
    if (progress(0.2, "")) std::exit(11);
  };
  EXPECT_EXIT(run_status({"--summary", file}, work), ::testing::KilledBySignal(SIGINT), "");
  EXPECT_TRUE(nlohmann::json::parse(std::ifstream(file)).at("interrupted").get<bool>());
}

TEST(ProgramDeathTest, ASignalIsCalledByItsName) {
  for (const auto& [number, name] : {std::pair{SIGINT, "Ctrl-C"}, {SIGTERM, "SIGTERM"}}) {
    const auto work = [&, signal_number = number](Program& p) {
      std::raise(signal_number);
      std::fprintf(stderr, "stopped by %s\n", p.stopped_by());
    };
    EXPECT_EXIT(run_status({}, work), ::testing::KilledBySignal(number), std::string("stopped by ") + name);
  }
}

TEST(ProgramDeathTest, WorkThatAStopBreaksOffDiesOfTheSignal) {
  const auto work = [](Program&) {
    std::raise(SIGTERM);
    throw WorkError("stopped before anything was made");
  };
  EXPECT_EXIT(run_status({}, work), ::testing::KilledBySignal(SIGTERM), "stopped before anything was made");
}

TEST(ProgramDeathTest, WorkThatHeedsNoStopEndsAfterASecondUnlessItKeepsAResult) {
  const auto deaf = [](Program&) {
    std::raise(SIGTERM);
    std::this_thread::sleep_for(std::chrono::seconds(20));
  };
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EXIT(run_status({}, deaf), ::testing::KilledBySignal(SIGTERM), "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  const auto keeping = [](Program& p) {
    p.keep_best_so_far();
    std::raise(SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    std::fputs("kept\n", stderr);
  };
  EXPECT_EXIT(run_status({}, keeping), ::testing::KilledBySignal(SIGTERM), "kept");
}

// As in the background of a script.
TEST(ProgramDeathTest, AnIgnoredCtrlCStaysIgnored) {
  const auto ignoring = [] {
    std::signal(SIGINT, SIG_IGN);
    std::exit(run_status({}, [](Program& p) {
      std::raise(SIGINT);
      if (p.stopped()) std::exit(10);
    }));
  };
  EXPECT_EXIT(ignoring(), ::testing::ExitedWithCode(0), "");
}

TEST(ProgramDeathTest, ASecondCtrlCEndsAtOnce) {
  const auto work = [](Program&) {
    std::raise(SIGINT);
    std::raise(SIGINT);
  };
  EXPECT_EXIT(run_status({}, work), ::testing::KilledBySignal(SIGINT), "");
}

TEST(ProgramDeathTest, ASecondCtrlCLeavesNoTemporaryFile) {
  const testing::ScratchFolder folder;
  const auto work = [&](Program&) {
    const OutputFile unfinished(folder / "mesh.ply");
    std::raise(SIGINT);
    std::raise(SIGINT);
  };
  EXPECT_EXIT(run_status({}, work), ::testing::KilledBySignal(SIGINT), "");
  EXPECT_TRUE(folder.files().empty());
}

TEST(ProgramDeathTest, AFullQuotaIsAnErrorOfWriting) {
  const testing::ScratchFolder folder;
  const auto work = [&](Program&) {
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    OutputFile file(folder / "mesh.ply");
    const std::string bytes(5000, 'x');
    file.write(bytes.data(), bytes.size());
    file.commit();
  };
  EXPECT_EXIT(std::exit(run_status({}, work)), ::testing::ExitedWithCode(1), "writing failed");
  EXPECT_TRUE(folder.files().empty());
}

TEST(ProgramDeathTest, AClosedStderrIsNoReasonToCrash) {
  const auto work = [](Program&) {
    ::close(STDERR_FILENO);
    throw InputError("a.obj: bad; mend it");
  };
  EXPECT_EXIT(std::exit(run_status({}, work)), ::testing::ExitedWithCode(2), "");
}

}  // namespace
}  // namespace astrolith
