#include "systems/foundation/visible_text.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace flinch {
namespace {

TEST(VisibleText, LeavesWordsOfAnyLanguageAsTheyAre) {
  const std::string text = "flinch: 3 N\tand\n\xc3\xa4\xe2\x82\xac\xf0\x9f\xa4\x96 \xc2\xa0";
  EXPECT_EQ(visible_text(text), text);
  EXPECT_EQ(visible_text(""), "");
}

TEST(VisibleText, ShowsEveryControlCharacterOfOneByte) {
  for (int code = 0; code < 0x80; ++code) {
    const std::string letter(1, static_cast<char>(code));
    const bool is_control = (code < 0x20 && code != '\n' && code != '\t') || code == 0x7f;
    EXPECT_EQ(visible_text(letter) != letter, is_control) << code;
  }
  EXPECT_EQ(visible_text("a\x1b[31mb\x07"), "a\\u001b[31mb\\u0007");
  EXPECT_EQ(visible_text(std::string_view("a\0b", 3)), "a\\u0000b");
}

TEST(VisibleText, ShowsControlCharactersOfSeveralBytes) {
  EXPECT_EQ(visible_text("a\xc2\x9b"
                         "31m"),
            "a\\u009b31m");
  EXPECT_EQ(visible_text("\xc2\x80\xc2\x9f"), "\\u0080\\u009f");
  EXPECT_EQ(visible_text("\xe2\x80\xae\xe2\x81\xa6"), "\\u202e\\u2066");  // from right to left
}

TEST(VisibleText, ShowsBytesThatAreNoText) {
  EXPECT_EQ(visible_text("\xff-\x9b-\xc2"), "\\xff-\\x9b-\\xc2");
  EXPECT_EQ(visible_text("\xc0\x9b"), "\\xc0\\x9b");  // a longer form than needed
  EXPECT_EQ(visible_text("\xe0\x82\x9b"), "\\xe0\\x82\\x9b");
  EXPECT_EQ(visible_text("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a pair
  EXPECT_EQ(visible_text("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

TEST(VisibleText, LeavesNothingThatATerminalObeys) {
  std::string bytes;
  for (int first = 0; first < 256; ++first) {
    for (int second = 0; second < 256; ++second)
      bytes += {static_cast<char>(first), static_cast<char>(second)};
  }
  const std::string shown = visible_text(bytes);
  EXPECT_TRUE(std::all_of(shown.begin(), shown.end(), [](char letter) {
    const auto byte = static_cast<unsigned char>(letter);
    return byte >= 0x20 ? byte != 0x7f : byte == '\n' || byte == '\t';
  }));
  EXPECT_EQ(visible_text(shown), shown);
}

}  // namespace
}  // namespace flinch
