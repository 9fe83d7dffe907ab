#include "lcmtypes/names.h"

#include <gtest/gtest.h>

#include <string>

#include "lcmtypes/field.h"

namespace anchord {
namespace {

TEST(Names, AcceptsUtf8) {
  EXPECT_EQ(text_fault(""), nullptr);
  EXPECT_EQ(text_fault("tea_box 2"), nullptr);
  // The first and last characters of each length, and around the surrogates (Unicode 15, table
  // 3-7).
  for (const char* text :
       {"\u00a0", "\u07ff", "\u0800", "\ud7ff", "\ue000", "\uffff", "\U00010000", "\U0010ffff"}) {
    EXPECT_EQ(text_fault(text), nullptr) << text;
  }
}

TEST(Names, RefusesWhatIsNoUtf8) {
  for (const char* text : {
           "\x80", "\xbf", "\xff",  // no first byte
           "\xc0\xaf", "\xc1\xbf",  // overlong
           "\xe0\x9f\xbf", "\xf0\x8f\xbf\xbf",
           "\xed\xa0\x80",                                   // surrogate
           "\xf4\x90\x80\x80", "\xf5\x80\x80\x80",           // beyond Unicode
           "\xc3", "\xe4\xb8", "\xf0\x9f\x8d", "\xe4\xb8z",  // cut short
       }) {
    EXPECT_STREQ(text_fault(text), "must be UTF-8");
  }
}

TEST(Names, RefusesControlCharacters) {
  for (int c = 0; c < 32; ++c) {
    EXPECT_NE(text_fault(std::string("a") + static_cast<char>(c)), nullptr) << c;
  }
  EXPECT_NE(text_fault("\x7f"), nullptr);
}

TEST(Names, RefusesWhatIsTooLongOrEmpty) {
  EXPECT_EQ(text_fault(std::string(kMaxNameBytes, 'a')), nullptr);
  EXPECT_NE(text_fault(std::string(kMaxNameBytes + 1, 'a')), nullptr);
  EXPECT_NE(name_fault(""), nullptr);
  EXPECT_EQ(name_fault("a"), nullptr);
}

TEST(Names, FindsTheFirstRepeat) {
  EXPECT_EQ(first_repeated({}), -1);
  EXPECT_EQ(first_repeated({"a", "b", "c"}), -1);
  EXPECT_EQ(first_repeated({"a", "b", "b", "a"}), 2);
}

TEST(Field, TextIsThePath) {
  const Field root;
  EXPECT_EQ(root.text(), "");
  EXPECT_EQ(root.element(2).text(), "[2]");
  const Field detections = root.member("detections");
  const Field detection = detections.element(3);
  EXPECT_EQ(detection.member("covariance").text(), "detections[3].covariance");
}

}  // namespace
}  // namespace anchord
