#include <sys/wait.h>
#include <unistd.h>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "numerics/errors.h"
#include "numerics/files/npy_file.h"
#include "numerics/files/output_file.h"
#include "numerics/files/sha256.h"
#include "numerics/files/zstd_stream.h"
#include "numerics/hash_random.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using testing::read_text;

TEST(AppendLine, MakesAndExtendsTheFile) {
  const testing::ScratchFolder folder;
  append_line(folder / "m.jsonl", "one");
  append_line(folder / "m.jsonl", "two");
  EXPECT_EQ(read_text(folder / "m.jsonl"), "one\ntwo\n");
}

TEST(AppendLine, LeavesALineThatWasCutShortAlone) {
  const testing::ScratchFolder folder;
  std::ofstream(folder / "m.jsonl") << "one\n{\"mem";
  append_line(folder / "m.jsonl", "two");
  EXPECT_EQ(read_text(folder / "m.jsonl"), "one\n{\"mem\ntwo\n");
}

TEST(AppendLine, KeepsTheLinesOfTwoProcessesWhole) {
  const testing::ScratchFolder folder;
  const std::string line(3000, 'x');
  const pid_t child = ::fork();
  for (int i = 0; i < 200; ++i) append_line(folder / "m.jsonl", line);
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  std::ifstream file(folder / "m.jsonl");
  int lines = 0;
  for (std::string read; std::getline(file, read); ++lines) EXPECT_EQ(read, line);
  EXPECT_EQ(lines, 400);
}

TEST(AppendLine, RefusesAFolder) {
  const testing::ScratchFolder folder;
  EXPECT_THROW(append_line(folder / ".", "x"), InputError);
  EXPECT_THROW(append_line(folder / "absent" / "m.jsonl", "x"), InputError);
}

TEST(NpyFile, HasTheHeaderAndTheBytes) {
  const testing::ScratchFolder folder;
  const auto file = folder / "a.npy";
  const std::vector<double> values{1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  write_npy(values, std::vector<int>{2, 3}, file);
  const std::string bytes = read_text(file);
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t start = bytes.size() - 6 * sizeof(double);
  EXPECT_EQ(start % 64, 0u);
  EXPECT_EQ(static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]), start - 10);
  EXPECT_NE(bytes.find("'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }"), std::string::npos);
  EXPECT_EQ(bytes[start - 1], '\n');
  EXPECT_EQ(std::memcmp(bytes.data() + start, values.data(), 6 * sizeof(double)), 0);
}

TEST(NpyFile, OneAxisAndWrongShapes) {
  const testing::ScratchFolder folder;
  const std::vector<double> values{1.0, 2.0};
  write_npy(values, std::vector<int>{2}, folder / "a.npy");
  EXPECT_NE(read_text(folder / "a.npy").find("'shape': (2, ), }"), std::string::npos);
  EXPECT_THROW(write_npy(values, std::vector<int>{2, 2}, folder / "b.npy"), WorkError);
  EXPECT_FALSE(std::filesystem::exists(folder / "b.npy"));
}

// The examples that NIST publishes for FIPS 180-4.
TEST(Sha256, KnownAnswers) {
  EXPECT_EQ(Sha256().hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  Sha256 abc;
  abc.update("abc", 3);
  EXPECT_EQ(abc.hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, PiecesAreTheWhole) {
  const std::string text(100000, 'a');
  Sha256 whole, pieces;
  whole.update(text.data(), text.size());
  for (std::size_t i = 0; i < text.size(); i += 777) {
    pieces.update(text.data() + i, std::min<std::size_t>(777, text.size() - i));
    pieces.hex();  // a look at the hash does not disturb it
  }
  EXPECT_EQ(pieces.hex(), whole.hex());
}

TEST(Sha256, Files) {
  const auto path = std::filesystem::temp_directory_path() / ("astrolith_sha_" + std::to_string(::getpid()));
  std::ofstream(path) << "abc";
  EXPECT_EQ(file_sha256(path), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  std::filesystem::remove(path);
  EXPECT_THROW(file_sha256(path), InputError);
  EXPECT_THROW(file_sha256(std::filesystem::temp_directory_path()), InputError);
}

// Bytes that compress a little, in several pieces of a stream.
std::string noisy(std::size_t size) {
  std::string text;
  for (std::size_t i = 0; i < size; ++i) text += static_cast<char>(hash_append(7, i) % 50);
  return text;
}

std::string packed(const testing::ScratchFolder& folder, const std::string& text) {
  OutputFile file(folder / "a.zst");
  file.write(text.data(), text.size());
  file.commit();
  return read_text(folder / "a.zst");
}

TEST(ZstdStream, ContentComesBack) {
  const testing::ScratchFolder folder;
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{131072}, std::size_t{1000000}}) {
    const std::string text = noisy(size);
    const std::string small = packed(folder, text);
    EXPECT_TRUE(is_zstd(small));
    EXPECT_EQ(unpack_zstd(small, size), text) << size;
    EXPECT_LT(small.size(), size * 8 / 10 + 100);
  }
}

// Headers are filled in at the end: seeking acts on the content, not on the compressed bytes.
TEST(ZstdStream, SeekingActsOnTheContent) {
  const testing::ScratchFolder folder;
  OutputFile file(folder / "a.zst");
  file.write("0000 tail", 9);
  file.seek(0);
  file.write("head", 4);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.zst"));
  file.commit();
  EXPECT_EQ(unpack_zstd(read_text(folder / "a.zst"), 100), "head tail");
}

// 10 MB of zeros take some hundred bytes.
TEST(ZstdStream, WhatUnpacksToMoreThanAllowedIsRefused) {
  const testing::ScratchFolder folder;
  const std::string bomb = packed(folder, std::string(10'000'000, '\0'));
  EXPECT_LT(bomb.size(), 2000u);
  EXPECT_EQ(unpack_zstd(bomb, 10'000'000).size(), 10'000'000u);
  EXPECT_THROW(unpack_zstd(bomb, 9'999'999), InputError);
}

TEST(ZstdStream, DamagedBytesAreRefused) {
  const testing::ScratchFolder folder;
  const std::string whole = packed(folder, noisy(300000));
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{4}, std::size_t{9}, whole.size() / 2, whole.size() - 1}) {
    EXPECT_THROW(unpack_zstd(std::string_view(whole).substr(0, size), 1'000'000), InputError) << size;
  }
  std::string changed = whole;
  changed[whole.size() / 2] = static_cast<char>(changed[whole.size() / 2] ^ 1);
  EXPECT_THROW(unpack_zstd(changed, 1'000'000), InputError);
  EXPECT_THROW(unpack_zstd(whole + "more", 1'000'000), InputError);
}

TEST(ZstdStream, ABeginningGivesTheBeginningOfTheContent) {
  const testing::ScratchFolder folder;
  const std::string text = noisy(1'000'000), whole = packed(folder, text);
  for (const std::size_t size : {std::size_t{1}, std::size_t{4096}, text.size(), 2 * text.size()})
    EXPECT_EQ(unpack_zstd_start(whole, size), text.substr(0, size)) << size;
  EXPECT_EQ(unpack_zstd_start(std::string_view(whole).substr(0, 1 << 18), 4096), text.substr(0, 4096));
  EXPECT_EQ(unpack_zstd_start(std::string_view(whole).substr(0, 9), 4096), "");
  EXPECT_EQ(unpack_zstd_start("no frame", 4096), "");
}

}  // namespace
}  // namespace astrolith
