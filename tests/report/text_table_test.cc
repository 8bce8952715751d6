#include "twin/report/text_table.h"

#include <gmock/gmock.h>

#include "tests/report/page_lines.h"

namespace twinbench::report {
namespace {

using testing::ElementsAre;

TEST(TextTable, AlignsColumnsAndCellsOfSeveralLines) {
  const std::string text =
      TextTable({{"cause"}, {"share", true}}, {{"play\n  lost motion", "97 %"}, {"drift", "3 %"}}, 80);
  EXPECT_THAT(test::LinesOf(text), ElementsAre("cause          share",  //
                                               "--------------------",  //
                                               "play            97 %",  //
                                               "  lost motion",         //
                                               "drift            3 %"));
}

TEST(TextTable, BreaksTheWidestColumnAtWordsAndKeepsItsIndent) {
  const std::string text = TextTable({{"a"}, {"b"}}, {{"name\n  one two three four five six", "1"}}, 20);
  EXPECT_THAT(test::LinesOf(text), ElementsAre("a                  b",  //
                                               "--------------------",  //
                                               "name               1",  //
                                               "  one two three",       //
                                               "  four five six"));
}

TEST(TextTable, KeepsAWholeColumnAsLongAsOthersCanGiveWay) {
  const std::string title = "some thirty letters of a title of";
  const std::string text = TextTable({{"a"}, {"b", false, true}}, {{title, "1.0000000 +- 0.0000001 um"}}, 56);
  EXPECT_THAT(test::LinesOf(text), ElementsAre("a                              b",                          //
                                               std::string(56, '-'),                                        //
                                               "some thirty letters of a       1.0000000 +- 0.0000001 um",  //
                                               "title of"));
}

TEST(TextTable, LeavesOutColumnsWithoutCells) {
  EXPECT_EQ(TextTable({{"a"}, {"b"}}, {{"1"}}, 80), "a\n-\n1\n");
  EXPECT_EQ(TextTable({{"a"}}, {}, 80), "");
}

TEST(TextTable, CountsCharactersAndNotBytes) {
  EXPECT_EQ(WidthOf("10 µm ●"), 7u);
  EXPECT_THAT(test::LinesOf(TextTable({{"a"}, {"b"}}, {{"µµµ", "1"}, {"mmm", "2"}}, 80)),
              ElementsAre("a    b", "------", "µµµ  1", "mmm  2"));
}

TEST(Paragraph, HangsBehindItsHead) {
  EXPECT_EQ(Paragraph("! ", "one two three", 2, 9), "! one two\n  three\n");
}

}  // namespace
}  // namespace twinbench::report
