#include "numerics/files/sha256.h"

#include <unistd.h>

#include <fstream>

#include "numerics/errors.h"

namespace astrolith {
namespace {

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
  EXPECT_EQ(sha256_of_file(path), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  std::filesystem::remove(path);
  EXPECT_THROW(sha256_of_file(path), InputError);
  EXPECT_THROW(sha256_of_file(std::filesystem::temp_directory_path()), InputError);
}

}  // namespace
}  // namespace astrolith
