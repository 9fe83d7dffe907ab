#include "tools/anchorctl/table.h"

#include <gtest/gtest.h>

namespace anchord {
namespace {

Table sample() {
  Table table({{"OBJECT"}, {"PLACES", true}, {"P"}});
  table.add({"cup-1", glued("kitchen_table 0.68") + ", " + glued("sink 0.20"), "0.97"});
  table.add({"tea_box-12", "-", "0.10"}, true);
  return table;
}

TEST(Table, AlignsColumnsByCodePoints) {
  Table table({{"A"}, {"B"}});
  table.add({"±±±", "1"});
  table.add({"x", "2"});
  EXPECT_EQ(table.text({}), "A    B\n±±±  1\nx    2\n");
}

TEST(Table, AnyWidthWithoutATerminal) {
  EXPECT_EQ(sample().text({}),
            "OBJECT      PLACES                         P\n"
            "cup-1       kitchen_table 0.68, sink 0.20  0.97\n"
            "tea_box-12  -                              0.10\n");
}

TEST(Table, WrapsWhereItMayAndKeepsPartsTogether) {
  EXPECT_EQ(sample().text({false, 38, 0}),
            "OBJECT      PLACES                P\n"
            "cup-1       kitchen_table 0.68,   0.97\n"
            "            sink 0.20\n"
            "tea_box-12  -                     0.10\n");
}

TEST(Table, CutsWhatIsStillTooLong) {
  const std::string text = sample().text({false, 20, 0});
  EXPECT_NE(text.find("cup-1       kitchen…\n"), std::string::npos) << text;
}

TEST(Table, ColoursWholeLines) {
  Table table({{"A"}});
  table.add({"x"}, true);
  EXPECT_EQ(table.text({true, 0, 0}), "\x1b[1mA\x1b[0m\n\x1b[2mx\x1b[0m\n");
}

TEST(Cut, CountsCodePoints) {
  EXPECT_EQ(cut("±±±±", 4), "±±±±");
  EXPECT_EQ(cut("±±±±", 3), "±±…");
  EXPECT_EQ(cut("abc", 1), "…");
  EXPECT_EQ(cut("abc", 0), "abc");
}

}  // namespace
}  // namespace anchord
