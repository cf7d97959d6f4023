#include "recipe/base64.h"

#include <gtest/gtest.h>

#include <string>

namespace astrolith {
namespace {

TEST(Base64, HasTheTextsOfItsStandard) {
  const std::string bytes = "foobar";
  const std::string texts[] = {"", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
  for (std::size_t count = 0; count <= bytes.size(); ++count) {
    EXPECT_EQ(base64_text(bytes.substr(0, count)), texts[count]);
    EXPECT_EQ(base64_bytes(texts[count]), bytes.substr(0, count));
  }
}

TEST(Base64, BringsAllBytesBack) {
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes += static_cast<char>(i);
  EXPECT_EQ(base64_bytes(base64_text(bytes)), bytes);
}

TEST(Base64, TakesNoTextThatItDoesNotMake) {
  for (const std::string text : {"Zg", "Zg=", "Zh==", "Zm9=", "====", "Z===", "Zg==Zg==", "Zm9v\n", "Zm 9",
                                 "Zm-_", "\xff\xff\xff\xff"})
    EXPECT_FALSE(base64_bytes(text)) << text;
}

}  // namespace
}  // namespace astrolith
