#include "numerics/files/output_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <chrono>
#include <functional>
#include <thread>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace {

// What fsync() was called for, in the order of the calls: 'd' for a folder, 'n' for a file without a name,
// 'f' for a file with one.
std::string g_synced;

}  // namespace

// Takes the place of the C library's function in this program.
extern "C" int fsync(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return -1;
  g_synced += S_ISDIR(status.st_mode) ? 'd' : status.st_nlink == 0 ? 'n' : 'f';
  return ::fdatasync(descriptor);
}

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
  EXPECT_EQ(testing::read_text(folder / "a.txt"), "hello");
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

// Runs `work` in a child process, which is killed after `delay` where it has not ended by then.
void run_killed(const std::function<void()>& work, std::chrono::microseconds delay) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::_exit(0);
  }
  std::this_thread::sleep_for(delay);
  ::kill(child, SIGKILL);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  return names;
}

bool knows_nameless_files(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (descriptor >= 0) ::close(descriptor);
  return descriptor >= 0;
}

// A child writes files one after another until it is killed.
const std::string kContent(200'000, 'x');
void write_file(const fs::path& target, OutputFile::Start start = OutputFile::Start::kNameless) {
  OutputFile file(target, start);
  file.write(kContent.data(), kContent.size());
  file.commit();
}

TEST_F(OutputFileTest, AKilledProgramLeavesWholeFilesOnly) {
  if (!knows_nameless_files(folder)) GTEST_SKIP() << "no nameless files in " << folder;
  for (int moment = 0; moment < 30; ++moment) {
    const fs::path own = folder / std::to_string(moment);
    fs::create_directories(own);
    const auto work = [&] {
      for (int i = 0; i < 100'000; ++i) write_file(own / ("file" + std::to_string(i)));
    };
    run_killed(work, std::chrono::microseconds(500 + 311 * moment));
    for (const std::string& name : names_in(own)) {
      EXPECT_EQ(name.rfind("file", 0), 0u) << name << " was left";
      EXPECT_EQ(fs::file_size(own / name), kContent.size()) << name;
    }
    fs::remove_all(own);
  }
}

TEST_F(OutputFileTest, AKilledProgramLeavesNoPartWhereItReplacesAFile) {
  if (!knows_nameless_files(folder)) GTEST_SKIP() << "no nameless files in " << folder;
  const std::string before(100, 'o');
  for (int moment = 0; moment < 30; ++moment) {
    const fs::path target = folder / "file";
    fs::remove(target);
    std::ofstream(target) << before;
    run_killed(
        [&] {
          for (;;) write_file(target);
        },
        std::chrono::microseconds(500 + 311 * moment));
    const std::string after = testing::read_text(target);
    EXPECT_TRUE(after == before || after == kContent);
    for (const std::string& name : names_in(folder)) {
      EXPECT_TRUE(name == "file" || fs::file_size(folder / name) == kContent.size()) << name << " was left";
    }
  }
}

TEST_F(OutputFileTest, ReplacesAFileWholeOrNotAtAll) {
  for (const OutputFile::Start start : {OutputFile::Start::kNameless, OutputFile::Start::kNamed}) {
    const fs::path target = folder / "file", other_name = folder / "other";
    write_file(target, start);
    fs::create_hard_link(target, other_name);
    {
      OutputFile file(target, start);
      file.write("new", 3);
      EXPECT_EQ(testing::read_text(target), kContent);
      file.commit();
    }
    EXPECT_EQ(testing::read_text(target), "new");
    EXPECT_EQ(testing::read_text(other_name), kContent);
    EXPECT_EQ(names_in(folder).size(), 2u);
    { OutputFile(target, start).write("never", 5); }
    EXPECT_EQ(testing::read_text(target), "new");
    EXPECT_EQ(names_in(folder).size(), 2u);
    fs::remove(other_name);
    fs::remove(target);
  }
}

TEST_F(OutputFileTest, TheDiskHasTheContentBeforeTheNameAndThenTheName) {
  if (!knows_nameless_files(folder)) GTEST_SKIP() << "no nameless files in " << folder;
  for (int times = 0; times < 2; ++times) {  // a new file, and one that replaces it
    g_synced.clear();
    write_file(folder / "file");
    EXPECT_EQ(g_synced, "nd");
  }
  g_synced.clear();
  write_file(folder / "named", OutputFile::Start::kNamed);
  EXPECT_EQ(g_synced, "fd");
  g_synced.clear();
  {
    const UnsyncedOutputs unsynced;
    write_file(folder / "file");
  }
  EXPECT_EQ(g_synced, "");
  write_file(folder / "file");
  EXPECT_EQ(g_synced, "nd");
  EXPECT_NO_THROW(sync_file_system(folder / "file"));
  EXPECT_NO_THROW(sync_file_system(folder / "none"));
}

TEST_F(OutputFileTest, HasThePermissionsOfAnyNewFile) {
  const mode_t before = ::umask(027);
  write_file(folder / "nameless");
  write_file(folder / "named", OutputFile::Start::kNamed);
  ::umask(before);
  for (const char* name : {"nameless", "named"}) {
    EXPECT_EQ(fs::status(folder / name).permissions(), fs::perms(0640)) << name;
  }
}

TEST_F(OutputFileTest, ALinkIsWrittenThrough) {
  fs::create_directories(folder / "elsewhere");
  fs::create_symlink("elsewhere/file", folder / "link");
  fs::create_symlink("link", folder / "link_to_link");
  for (const std::string content : {"first", "second"}) {
    astrolith::write_file(folder / "link_to_link", content);
    EXPECT_TRUE(fs::is_symlink(folder / "link") && fs::is_symlink(folder / "link_to_link"));
    EXPECT_EQ(testing::read_text(folder / "elsewhere" / "file"), content);
  }
  fs::create_symlink("ring", folder / "ring");
  EXPECT_THROW(OutputFile(folder / "ring"), InputError);
}

TEST_F(OutputFileTest, AppendsThePartOfAnotherFile) {
  const std::string text(200000, 'x');
  const FileHandle other = open_nameless_file(folder / "joined");
  ASSERT_EQ(std::fwrite(text.data(), 1, text.size(), other.get()), text.size());
  ASSERT_EQ(std::fflush(other.get()), 0);
  OutputFile file(folder / "joined");
  file.write("before", 6);
  file.append_file(::fileno(other.get()), text.size() - 1);
  file.write("after", 5);
  EXPECT_THROW(file.append_file(::fileno(other.get()), text.size() + 1), WorkError);
  file.seek(0);
  file.write("BEFORE", 6);
  file.commit();
  EXPECT_EQ(testing::read_text(folder / "joined").substr(0, text.size() + 10),
            "BEFORE" + text.substr(1) + "after");
}

TEST_F(OutputFileTest, AFileKeepsItsMode) {
  for (const OutputFile::Start start : {OutputFile::Start::kNameless, OutputFile::Start::kNamed}) {
    write_file(folder / "mode", start);
    fs::permissions(folder / "mode", fs::perms(0640));
    write_file(folder / "mode", start);
    EXPECT_EQ(fs::status(folder / "mode").permissions(), fs::perms(0640));
  }
}

TEST_F(OutputFileTest, AReadOnlyFileIsNotReplaced) {
  astrolith::write_file(folder / "kept", "kept");
  fs::permissions(folder / "kept", fs::perms(0444));
  EXPECT_THROW(OutputFile(folder / "kept"), InputError);
  EXPECT_EQ(testing::read_text(folder / "kept"), "kept");
}

TEST_F(OutputFileTest, TheNameMayBeAsLongAsTheSystemAllows) {
  for (int times = 0; times < 2; ++times) write_file(folder / std::string(255, 'n'));
  EXPECT_EQ(names_in(folder).size(), 1u);
  EXPECT_THROW(OutputFile(folder / std::string(256, 'n')), InputError);
}

// /dev/stdout is such a link: replacing it would take every program's output away.
TEST_F(OutputFileTest, ALinkToAnOpenFileOfAProcessIsNotReplaced) {
  const int descriptor = ::open((folder / "open").c_str(), O_WRONLY | O_CREAT, 0600);
  ASSERT_GE(descriptor, 0);
  fs::create_symlink("/proc/self/fd/" + std::to_string(descriptor), folder / "link");
  EXPECT_THROW(OutputFile(folder / "link"), InputError);
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  ::close(descriptor);
}

TEST_F(OutputFileTest, ADuplicateDescriptorWritesTheSameFile) {
  OutputFile file(folder / "file");
  file.write("one ", 4);
  const int descriptor = file.duplicate_descriptor();
  ASSERT_EQ(::write(descriptor, "two", 3), 3);
  ::close(descriptor);
  file.commit();
  EXPECT_EQ(testing::read_text(folder / "file"), "one two");
}

}  // namespace
}  // namespace astrolith
