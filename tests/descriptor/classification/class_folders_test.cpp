#include "descriptor/classification/class_folders.h"

#include <gtest/gtest.h>

#include "numerics/errors.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

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
