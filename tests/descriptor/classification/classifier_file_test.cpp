#include "descriptor/classification/classifier_file.h"
#include "descriptor/classification/feature_table.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "tests/descriptor/classification/clusters.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

ShapeClassifier small_classifier(int components) {
  FeatureOptions features = default_features(FeatureKind::d2);
  features.bins = 8;
  return train_classifier(testing::clusters(3, 10, 8, 0.3, 1), features, {components, {7, 25, 1}});
}

TEST(ClassifierFile, KeepsEveryVote) {
  const testing::ScratchFolder folder;
  for (const int components : {0, 2}) {
    const ShapeClassifier written = small_classifier(components);
    write_classifier(written, "test 1", folder / "model.yml");
    const ShapeClassifier read = read_classifier(folder / "model.yml");
    EXPECT_EQ(read.classes, written.classes);
    EXPECT_EQ(read.features.kind, FeatureKind::d2);
    EXPECT_EQ(read.features.bins, 8);
    EXPECT_EQ(read.features.points, written.features.points);
    for (const auto& row : testing::clusters(3, 50, 8, 1.0, 2).rows)
      EXPECT_EQ(read.votes(row), written.votes(row));
    write_classifier(read, "test 1", folder / "again.yml");
    EXPECT_EQ(testing::read_text(folder / "again.yml"), testing::read_text(folder / "model.yml"));
  }
}

const std::string kGood =
    R"({"format":"astrolith classifier","version":1,"features":{"kind":"d2","bins":8,"eigenvalues":20,"points":100,)"
    R"("seed":1},"classes":["a","b"],"forest":[[[0,1.5,2],[0],[7,0.5,4],[1],[0]]]})";

std::string with(const std::string& from, const std::string& to) {
  std::string text = kGood;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ClassifierFile, ReadsATreeByHand) {
  const testing::ScratchFolder folder;
  const ShapeClassifier c = read_classifier(folder.write("good.yml", kGood));
  const auto call = [&](float first, float last) {
    return winner(c.votes(std::vector<float>{first, 0, 0, 0, 0, 0, 0, last}));
  };
  EXPECT_EQ(call(1.5f, 9), 0);
  EXPECT_EQ(call(1.6f, 0.5f), 1);
  EXPECT_EQ(call(1.6f, 0.6f), 0);
}

TEST(ClassifierFile, RefusesWhatIsWrongByItsPlace) {
  const testing::ScratchFolder folder;
  const struct {
    std::string text, place;
  } cases[] = {
      {"", "is empty"},
      {"%YAML:1.0\n---\n", "give a file that classify train wrote"},
      {"[]", "is no classifier"},
      {"{\"format\": 3}", "is no classifier"},
      {with("\"version\":1", "\"version\":2"), "version"},
      {with("\"d2\"", "\"d3\""), "d3"},
      {with("\"bins\":8", "\"bins\":8.5"), "bins"},
      {with("\"bins\":8", "\"bins\":1e99"), "bins"},
      {with("\"points\":100", "\"points\":18446744073709551615"), "points"},
      {with("\"seed\":1", "\"seed\":-1"), "seed"},
      {with("[\"a\",\"b\"]", "[\"a\"]"), "classes"},
      {with("[\"a\",\"b\"]", "[\"a\",\"a\"]"), "classes[1]"},
      {with("[\"a\",\"b\"]", "7"), "classes"},
      {with("[[[0,1.5,2],[0],[7,0.5,4],[1],[0]]]", "[]"), "forest"},
      {with("[[[0,1.5,2],[0],[7,0.5,4],[1],[0]]]", "[[]]"), "forest[0]"},
      {with("[0,1.5,2]", "[8,1.5,2]"), "forest[0][0][0]"},  // no such feature
      {with("[0,1.5,2]", "[0,1.5,1]"), "forest[0][2]"},     // the right side of the root is at 2, not 1
      {with("[0,1.5,2]", "[0,1.5,0]"), "forest[0][2]"},     // a circle
      {with("[0,1.5,2]", "[0,1e99,2]"), "forest[0][0][1]"},
      {with("[0,1.5,2]", "[0,1.5]"), "forest[0][0]"},
      {with(",[1],[0]]", ",[1]]"), "ends before"},
      {with(",[1],[0]]", ",[1],[0],[0]]"), "forest[0][5]"},
      {with(",[1],[0]]", ",[2],[0]]"), "forest[0][3][0]"},  // no such class
      {with("\"forest\"", "\"components\":{\"mean\":[1],\"axes\":[]},\"forest\""), "components: mean"},
      {with("\"forest\"", "\"woods\""), "forest is missing"},
  };
  for (const auto& c : cases) {
    const std::string file = folder.write("bad.yml", c.text).string();
    try {
      read_classifier(file);
      ADD_FAILURE() << "accepted: " << c.text;
    } catch (const InputError& e) {
      const std::string what = e.what();
      EXPECT_EQ(what.rfind(file, 0), 0u) << what;
      EXPECT_NE(what.find(c.place), std::string::npos) << what;
    }
  }
}

// A damaged file is either refused or read as a classifier that can be used.
TEST(ClassifierFile, SurvivesDamage) {
  const testing::ScratchFolder folder;
  write_classifier(small_classifier(2), "test 1", folder / "model.yml");
  const std::string whole = testing::read_text(folder / "model.yml");
  CounterRandom random(3);
  for (int trial = 0; trial < 400; ++trial) {
    std::string text = whole;
    for (int k = 0; k < 3; ++k) text[random.below(text.size())] = "0123456789-[],{}\"e. "[random.below(20)];
    if (trial % 10 == 0) text.resize(random.below(text.size()));
    try {
      const ShapeClassifier c = read_classifier(folder.write("bad.yml", text));
      c.votes(std::vector<float>(feature_count(c.features), 1.0f));
    } catch (const InputError&) {
    }
  }
}

namespace fs = std::filesystem;

struct Folders {
  testing::ScratchFolder scratch;

  fs::path make(const std::string& folder, const std::vector<std::string>& files) const {
    fs::create_directories(scratch / folder);
    for (const std::string& file : files) scratch.write(folder + "/" + file, "x");
    return scratch / folder;
  }
};

TEST(ClassFolders, EachFolderIsAClass) {
  const Folders f;
  const std::vector<fs::path> given{f.make("rock", {"2.obj", "1.PLY", "notes.md", ".hidden.obj"}),
                                    f.make("bird", {"x.off"})};
  const LabelledFiles found = find_classes(given);
  EXPECT_EQ(found.classes, (std::vector<std::string>{"bird", "rock"}));
  EXPECT_EQ(found.labels, (std::vector<int>{0, 1, 1}));
  ASSERT_EQ(found.files.size(), 3u);
  EXPECT_EQ(found.files[0].filename(), "x.off");
  EXPECT_EQ(found.files[1].filename(), "1.PLY");
}

TEST(ClassFolders, AFolderOfFoldersHoldsOneClassEach) {
  const Folders f;
  f.make("all/rock", {"1.obj"});
  f.make("all/bird", {"1.obj", "2.obj"});
  f.scratch.write("all/README.md", "x");
  for (const fs::path& given : {f.scratch / "all", f.scratch / "all/"}) {
    const LabelledFiles found = find_classes(std::vector{given});
    EXPECT_EQ(found.classes, (std::vector<std::string>{"bird", "rock"}));
    EXPECT_EQ(found.labels, (std::vector<int>{0, 0, 1}));
  }
  EXPECT_EQ(find_classes(std::vector{f.scratch / "all/bird/"}).classes, (std::vector<std::string>{"bird"}));
}

TEST(ClassFolders, FoldersOfOneNameAreOneClass) {
  const Folders f;
  const std::vector<fs::path> given{f.make("old/rock", {"1.obj"}), f.make("new/rock", {"2.obj"})};
  EXPECT_EQ(find_classes(given).labels, (std::vector<int>{0, 0}));
}

TEST(ClassFolders, RefusesByName) {
  const Folders f;
  EXPECT_THROW(find_classes(std::vector{f.scratch / "absent"}), InputError);
  EXPECT_THROW(find_classes(std::vector{f.make("empty", {"notes.md"})}), InputError);
  f.make("mixed/inner", {"1.obj"});
  EXPECT_THROW(find_classes(std::vector{f.make("mixed", {"1.obj"})}), InputError);
  EXPECT_THROW(find_classes(std::vector{f.scratch.write("file.obj", "x")}), InputError);
}

}  // namespace
}  // namespace astrolith
