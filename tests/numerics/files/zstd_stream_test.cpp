#include "numerics/files/zstd_stream.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
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
  return content_of(folder / "a.zst");
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
  EXPECT_EQ(unpack_zstd(content_of(folder / "a.zst"), 100), "head tail");
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
