#include "numerics/length_unit.h"
#include "numerics/printable_text.h"

namespace astrolith {
namespace {

TEST(LengthUnit, HasMetres) {
  EXPECT_EQ(metres_per_unit("km"), 1e3);
  EXPECT_EQ(metres_per_unit("m"), 1.0);
  EXPECT_EQ(metres_per_unit("cm"), 1e-2);
  EXPECT_EQ(metres_per_unit("mm"), 1e-3);
  EXPECT_EQ(metres_per_unit("px"), 1.0);
}

TEST(LengthUnit, IsKnownOrNot) {
  for (const char* unit : {"m", "km", "cm", "mm"}) EXPECT_TRUE(has_known_length(unit)) << unit;
  for (const char* unit : {"", "ft", "px", "body"}) EXPECT_FALSE(has_known_length(unit)) << unit;
}

TEST(PrintableText, OrdinaryTextStaysAsItIs) {
  for (const char* text : {"", "a.json: layers[0]: bad; mend it", "café \\n 小惑星.json", "\U0001f311"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(PrintableText, ControlsAreEscaped) {
  EXPECT_EQ(printable("a\nb\r\tc"), "a\\nb\\r\\tc");
  EXPECT_EQ(printable("\x1b[31m\x7f"), "\\x1b[31m\\x7f");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\u0085\u009b31m"), "\\u0085\\u009b31m") << "C1: 009b begins a terminal's command";
}

TEST(PrintableText, WhatHidesReordersOrBreaksALineIsEscaped) {
  EXPECT_EQ(printable("a\u2028b\u2029c"), "a\\u2028b\\u2029c");
  EXPECT_EQ(printable("\u202egpj.json\u202c"), "\\u202egpj.json\\u202c");
  EXPECT_EQ(printable("\u200b\u2066\ufeff\u00ad"), "\\u200b\\u2066\\ufeff\\u00ad");
  EXPECT_EQ(printable("\U000e0041\U0001ffff\ufffe"), "\\U000e0041\\U0001ffff\\ufffe");
}

TEST(PrintableText, BytesThatAreNotUtf8AreEscapedOneByOne) {
  EXPECT_EQ(printable("caf\xe9.json"), "caf\\xe9.json") << "Latin-1";
  EXPECT_EQ(printable("\xc0\x80"), "\\xc0\\x80") << "overlong";
  EXPECT_EQ(printable("\xe2\x80"), "\\xe2\\x80") << "cut off";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(printable("\xf4\x90\x80\x80\xff"), "\\xf4\\x90\\x80\\x80\\xff") << "beyond Unicode";
  EXPECT_EQ(printable("\xe2\x41"),
            "\\xe2"
            "A");
}

}  // namespace
}  // namespace astrolith
