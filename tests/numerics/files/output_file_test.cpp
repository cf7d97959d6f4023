#include "numerics/files/output_file.h"

#include <sys/stat.h>

#include <fstream>
#include <iterator>

namespace astrolith {
namespace {

namespace fs = std::filesystem;

class OutputFileTest : public ::testing::Test {
 protected:
  OutputFileTest() { fs::create_directories(folder); }
  ~OutputFileTest() override { fs::remove_all(folder); }
  fs::path folder = fs::temp_directory_path() / ("astrolith_output_" + std::to_string(::getpid()));
};

TEST_F(OutputFileTest, AppearsWholeAtCommit) {
  OutputFile file(folder / "a.txt");
  file.write("hello", 5);
  EXPECT_FALSE(fs::exists(folder / "a.txt"));
  file.commit();
  std::ifstream in(folder / "a.txt");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "hello");
}

TEST_F(OutputFileTest, LeavesNothingWithoutCommit) {
  { OutputFile(folder / "b.txt").write("x", 1); }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(OutputFileTest, AMissingFolderIsTheUsersError) {
  EXPECT_THROW(OutputFile(folder / "none" / "c.txt"), InputError);
  EXPECT_THROW(OutputFile{folder}, InputError);
  EXPECT_THROW(OutputFile(folder / std::string(5000, 'x')), InputError);
}

TEST_F(OutputFileTest, DevicesAndPipesAreNotReplaced) {
  EXPECT_THROW(OutputFile("/dev/null"), InputError);
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(OutputFile(folder / "pipe"), InputError);
}

}  // namespace
}  // namespace astrolith
