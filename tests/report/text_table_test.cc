#include "twin/report/text_table.h"

#include <gtest/gtest.h>

#include "tests/support/kept_text.h"

namespace twinbench::report {
namespace {

TEST(TextTable, AlignsColumnsAndCellsOfSeveralLines) {
  EXPECT_KEPT(TextTable({{"cause"}, {"share", true}}, {{"play\n  lost motion", "97 %"}, {"drift", "3 %"}}, 80));
}

TEST(TextTable, BreaksTheWidestColumnAtWordsAndKeepsItsIndent) {
  EXPECT_KEPT(TextTable({{"a"}, {"b"}}, {{"name\n  one two three four five six", "1"}}, 20));
}

TEST(TextTable, KeepsAWholeColumnAsLongAsOthersCanGiveWay) {
  const std::string title = "some thirty letters of a title of";
  EXPECT_KEPT(TextTable({{"a"}, {"b", false, true}}, {{title, "1.0000000 ± 0.0000001 µm"}}, 56));
}

TEST(TextTable, LeavesOutColumnsWithoutCells) {
  EXPECT_EQ(TextTable({{"a"}, {"b"}}, {{"1"}}, 80), "a\n-\n1\n");
  EXPECT_EQ(TextTable({{"a"}}, {}, 80), "");
}

TEST(TextTable, CountsCharactersAndNotBytes) {
  EXPECT_EQ(WidthOf("10 µm ●"), 7u);
  EXPECT_KEPT(TextTable({{"a"}, {"b"}}, {{"µµµ", "1"}, {"mmm", "2"}}, 80));
}

TEST(Paragraph, HangsBehindItsHead) {
  EXPECT_EQ(Paragraph("! ", "one two three", 2, 9), "! one two\n  three\n");
}

}  // namespace
}  // namespace twinbench::report
