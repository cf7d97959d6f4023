// Options in one table (tasks/job/option_table.h): values, their rules, and the files that options name.
#include "tasks/job/option_table.h"

#include <gtest/gtest.h>

#include "numerics/errors.h"
#include "tests/support/comma_locale.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;
using testing::refusal_text;
using testing::ScratchFolder;

TEST(OptionTable, ValuesAreReadAsTheirTypesSay) {
  OptionTable options;
  int count = 7;
  double size = 2.5;
  Triple axis{0, 0, 1};
  std::vector<Triple> views;
  std::vector<std::string> words;
  bool quick = false;
  options.add_option("-n,--count", count, "how many").check(in_range(1, 100));
  options.add_option("--size", size, "how large").check(above_zero());
  options.add_option("--axis", axis, "of rotation");
  options.add_option("--view", views, "from where");
  options.add_option("names", words, "names");
  options.add_flag("--quick", quick, "at once");
  OptionTable::set(*options.find("--count"), {"12"});
  OptionTable::set(*options.find("size"), {"1e3"});
  OptionTable::set(*options.find("axis"), {"1", "-2", "0.5"});
  OptionTable::set(*options.find("view"), {"1", "2", "3", "4", "5", "6"});
  OptionTable::set(*options.find("names"), {"a", "b"});
  OptionTable::set(*options.find("quick"), {"true"});
  EXPECT_EQ(count, 12);
  EXPECT_EQ(size, 1000.0);
  EXPECT_EQ(axis, Triple(1, -2, 0.5));
  EXPECT_EQ(views, (std::vector<Triple>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(words, (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(quick);
  EXPECT_EQ(options.find("--count")->value_words(), "N in [1 - 100] (default 7)");
  EXPECT_EQ(options.find("--size")->value_words(), "N > 0 (default 2.5)");
  EXPECT_EQ(options.find("quick")->value_words(), "");
  using Given = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(options.given(), (Given{{"axis", "1 -2 0.5"},
                                    {"count", "12"},
                                    {"quick", "true"},
                                    {"size", "1e3"},
                                    {"view", "1 2 3 4 5 6"}}));
}

TEST(OptionTable, NumbersHaveAPointInEveryLocale) {
  const testing::CommaLocale comma;
  if (!comma.is_set()) GTEST_SKIP() << "no locale with a comma can be made";
  OptionTable options;
  double size = 0.0;
  options.add_option("--size", size, "how large").check(in_range(0.1, 2.0));
  OptionTable::set(*options.find("size"), {"0.5"});
  EXPECT_EQ(size, 0.5);
  OptionTable::set(*options.find("size"), {"+1.5e0"});
  EXPECT_EQ(size, 1.5);
  for (const char* word : {"0,5", "", "+", "0.5x", " 0.5", "+-1", "nan"})
    EXPECT_NE(refusal_text([&] { OptionTable::set(*options.find("size"), {word}); }), "no error") << word;
  EXPECT_NE(refusal_text([&] { OptionTable::set(*options.find("size"), {"1e999"}); }).find("double"),
            std::string::npos);
}

TEST(OptionTable, WrongValuesAreRefusedAndChangeNothing) {
  OptionTable options;
  int count = 7;
  double size = 2.5;
  std::string kind = "a";
  std::vector<double> box;
  options.add_option("--count", count, "").check(in_range(1, 100));
  options.add_option("--size", size, "").check(in_range(0.5, 4.0));
  options.add_option("--kind", kind, "").check(one_of({"a", "b"}));
  options.add_option("--box", box, "").expected(4);
  const auto refused = [&](const char* name, const std::vector<std::string>& words) {
    return refusal_text([&] { OptionTable::set(*options.find(name), words); });
  };
  EXPECT_EQ(refused("count", {"0"}), "--count: must be a number between 1 and 100, is 0");
  EXPECT_EQ(refused("count", {"1.5"}), "--count: must be a whole number, is \"1.5\"");
  EXPECT_EQ(refused("count", {"99999999999"}), "--count: must be a number between 1 and 100, is 99999999999");
  EXPECT_EQ(refused("size", {"nan"}), "--size: must be a finite number");
  EXPECT_EQ(refused("size", {"1x"}), "--size: must be a number, is \"1x\"");
  EXPECT_EQ(refused("size", {""}), "--size: must be a number, is \"\"");
  EXPECT_EQ(refused("kind", {"c"}), "--kind: must be one of a, b, is \"c\"");
  EXPECT_EQ(refused("box", {"1", "2", "3"}), "--box: takes 4 values, not 3");
  EXPECT_EQ(count, 7);
  EXPECT_EQ(size, 2.5);
  EXPECT_TRUE(options.given().empty());
}

TEST(OptionTable, OptionsMayNeedAndExcludeOthers) {
  OptionTable options;
  bool a = false, b = false, c = false;
  const Option first = options.add_flag("--first", a, "");
  options.add_flag("--second", b, "").needs(first);
  options.add_flag("--third", c, "").excludes(first);
  OptionTable::set(*options.find("second"), {"true"});
  EXPECT_EQ(refusal_text([&] { options.check_combination(); }), "--second requires --first");
  OptionTable::set(*options.find("first"), {"true"});
  EXPECT_EQ(refusal_text([&] { options.check_combination(); }), "no error");
  OptionTable::set(*options.find("third"), {"true"});
  EXPECT_EQ(refusal_text([&] { options.check_combination(); }), "--third excludes --first");
}

// A table with an input, two outputs, and an output whose name leads to another file.
struct Files {
  std::string input, output, list, map;
  OptionTable options;

  Files() {
    options.add_option("input", input, "").reads();
    options.add_option("--output", output, "").writes();
    options.add_option("--list", list, "").writes();
    options.add_option("--map", map, "").writes([](const auto& words) {
      return std::vector{fs::path(words.front()), fs::path(words.front()).replace_extension(".json")};
    });
  }
  std::string refused(const std::vector<std::pair<const char*, fs::path>>& names) {
    for (const auto& row : options.rows()) row->words.clear();
    for (const auto& [name, file] : names) OptionTable::set(*options.find(name), {file.string()});
    return refusal_text([&] { options.check_files(); });
  }
};

TEST(OptionTable, NoOutputIsAnInputOrAnotherOutput) {
  const ScratchFolder folder;
  const fs::path a = folder / "a.json", b = folder / "b.json";
  folder.write("a.json", "a");
  Files files;
  EXPECT_EQ(files.refused({{"input", a}, {"output", b}, {"list", (folder / "c.csv")}}), "no error");
  EXPECT_NE(files.refused({{"input", a}, {"output", a}}), "no error");
  EXPECT_NE(files.refused({{"output", b}, {"list", b}}), "no error");
  EXPECT_NE(files.refused({{"output", b}, {"list", (folder / "./x/../b.json")}}), "no error");
  EXPECT_NE(files.refused({{"input", a}, {"map", (folder / "a.tif")}}), "no error");
  EXPECT_NE(files.refused({{"map", (folder / "b.tif")}, {"output", b}}), "no error");
  EXPECT_NE(files.refused({{"output", ""}}), "no error");
  fs::create_hard_link(a, (folder / "same.json"));
  EXPECT_NE(files.refused({{"input", a}, {"output", (folder / "same.json")}}), "no error");
}

TEST(OptionTable, NamesOfMembersStandForManyFiles) {
  const ScratchFolder folder;
  const fs::path input = folder / "body_0000007.json";
  folder.write("body_0000007.json", "a");
  Files files;
  EXPECT_NE(files.refused({{"input", input}, {"output", (folder / "body_{member}.json")}}), "no error");
  EXPECT_NE(files.refused({{"list", (folder / "b3.ply")}, {"output", (folder / "b{n}.ply")}}), "no error");
  EXPECT_EQ(files.refused({{"input", input}, {"output", (folder / "rock_{member}.json")}}), "no error");
  EXPECT_EQ(files.refused({{"list", folder / "{member}.relief.png"}, {"output", folder / "{member}.png"}}),
            "no error");
}

TEST(OptionTable, AFileThatTurnsUpLaterIsKept) {
  const ScratchFolder folder;
  folder.write("image.png", "a");
  Files files;
  OptionTable::set(*files.options.find("output"), {(folder / "image.png").string()});
  EXPECT_NE(refusal_text([&] { files.options.require_not_written((folder / "image.png")); }), "no error");
  EXPECT_EQ(refusal_text([&] { files.options.require_not_written((folder / "other.png")); }), "no error");
}

}  // namespace
}  // namespace astrolith
