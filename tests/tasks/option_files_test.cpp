// No output of any program is an input or another output: all pairs of options that name files.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>

#include "numerics/errors.h"
#include "tasks/description/description_jobs.h"
#include "tasks/gravity/gravity_job.h"
#include "tasks/synth/check_tiles.h"
#include "tasks/synth/synth.h"
#include "tests/support/scratch_folder.h"
#ifdef ASTROLITH_WITH_ESTIMATION
#include "tasks/estimation/fit_gabor.h"
#include "tasks/estimation/fit_shape.h"
#endif

namespace astrolith {
namespace {

namespace fs = std::filesystem;

class QuietJob : public Job {
 public:
  // With the option that all programs have.
  explicit QuietJob(const std::string& name) : Job(name) {
    options.add_option("--summary", summary_file, "").writes();
  }
  Progress progress(std::string) const override { return {}; }
  bool stopped() const override { return false; }
  const char* stopped_by() const override { return ""; }
  void say(const std::string&) const override {}
  void note(const std::string&) override {}
  void print_result(const std::string&) override {}
  void report_failure(const std::string&) override {}

  std::string summary_file;
};

// Declares a job's options; the result holds where their values are stored.
using Declaration = std::function<std::shared_ptr<void>(Job&)>;

Declaration of(JobWork (*declare)(Job&)) {
  return [declare](Job& job) { return std::make_shared<JobWork>(declare(job)); };
}
template <class Arguments>
Declaration of(void (*declare)(Job&, Arguments&)) {
  return [declare](Job& job) {
    const auto arguments = std::make_shared<Arguments>();
    declare(job, *arguments);
    return arguments;
  };
}

const std::map<std::string, Declaration>& declarations() {
  static const std::map<std::string, Declaration> all{
      {"compare", of(declare_compare)},       {"describe", of(declare_describe)},
      {"gravity", of(declare_gravity)},       {"check_tiles", of(declare_check_tiles)},
      {"render", of(declare_render)},         {"synth", of(declare_synth)},
#ifdef ASTROLITH_WITH_ESTIMATION
      {"classify", of(declare_classify)},     {"fit_gabor", of(declare_photo_fit)},
      {"fit_shape", of(declare_fit_options)},
#endif
  };
  return all;
}

std::vector<OptionRow*> list_rows(const OptionTable& options) {
  std::vector<OptionRow*> rows;
  for (const auto& row : options.rows()) rows.push_back(row.get());
  for (const OptionTable::Command& command : options.commands()) {
    for (OptionRow* row : list_rows(*command.options)) rows.push_back(row);
  }
  return rows;
}

class OptionFiles : public ::testing::TestWithParam<std::string> {};

TEST_P(OptionFiles, EveryOptionThatNamesAFileSaysWhatForItIs) {
  QuietJob job(GetParam());
  const std::shared_ptr<void> kept = declarations().at(GetParam())(job);
  for (const OptionRow* row : list_rows(job.options)) {
    const std::string words = row->value_words();
    const bool names_file = words.find(".json") != std::string::npos ||
                            words.find("FILE") != std::string::npos ||
                            words.find("MESH") != std::string::npos;
    EXPECT_TRUE(!names_file || row->reads || row->writes) << row->names << " " << words;
  }
}

TEST_P(OptionFiles, NoPairOfOptionsMayShareAFileThatIsWritten) {
  QuietJob job(GetParam());
  const std::shared_ptr<void> kept = declarations().at(GetParam())(job);
  const std::vector<OptionRow*> rows = list_rows(job.options);
  const auto refused = [&] {
    try {
      job.options.check_files();
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  // Whether the option can name the file; it then does. --density-of takes FILE=DENSITY.
  const auto name_it = [](OptionRow& row, const fs::path& file) {
    for (const std::string& words : {file.string(), file.string() + "=1"}) {
      const std::vector<fs::path> named = (row.reads ? row.reads : row.writes)({words});
      if (std::find(named.begin(), named.end(), file) == named.end()) continue;
      row.words = {words};
      return true;
    }
    return false;  // a folder, whose files have fixed names
  };
  int pairs = 0;
  for (OptionRow* output : rows) {
    if (!output->writes) continue;
    const testing::ScratchFolder folder;
    for (const std::string name : {folder / "out.json", folder / "out.tif"}) {
      for (const fs::path& file : output->writes({name})) {
        for (OptionRow* other : rows) {
          if (other == output || (!other->reads && !other->writes)) continue;
          fs::remove_all(name);
          fs::create_directories(file.parent_path());
          std::ofstream(file) << "{}";
          for (OptionRow* row : rows) row->words.clear();
          output->words = {name};
          if (!name_it(*other, file)) continue;
          ++pairs;
          EXPECT_TRUE(refused()) << output->names << " and " << other->names << ": " << file;
        }
      }
    }
  }
  EXPECT_GT(pairs, 0);
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& [name, declaration] : declarations()) all.push_back(name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(AllPrograms, OptionFiles, ::testing::ValuesIn(names()),
                         [](const auto& program) { return program.param; });

}  // namespace
}  // namespace astrolith
