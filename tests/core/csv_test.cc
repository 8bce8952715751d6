#include "twin/core/csv.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/core/input_error.h"
#include "tests/core/refusals.h"

namespace twinbench {
namespace {

CsvTable ParseTable(const std::string& text) {
  std::istringstream in(text);
  return ParseCsv(in, "t.csv");
}

std::string TableError(const std::string& text) {
  return MessageOf([&] { ParseTable(text); });
}

TEST(Csv, SkipsCommentsCountsTheirLinesAndTakesFilesOfOtherSystemsAndEmptyFields) {
  const CsvTable table = ParseTable("# made by hand\na,b\n\n# a comment\n1,2\n");
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.WhereHeader(), "t.csv:2");
  EXPECT_EQ(table.Where(table.rows[0]), "t.csv:5");
  const CsvTable foreign = ParseTable("\xEF\xBB\xBF" "a,b\r\n 1 ,2\r\n");
  EXPECT_EQ(foreign.columns, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(foreign.rows[0].fields, (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(ParseTable("a,b,c\n,,\n").rows[0].fields, (std::vector<std::string>{"", "", ""})) << "also the last";
}

TEST(Csv, ReadsWhatItQuotes) {
  for (const std::string text : {"plain", "two, parts", "a \"word\"", " blanks ", "#no comment", ""}) {
    const CsvTable table = ParseTable("a,b\n" + QuoteCsv(text) + ",1\n");
    EXPECT_EQ(table.rows[0].fields[0], text);
    EXPECT_EQ(table.rows[0].fields[1], "1");
  }
}

TEST(Csv, NamesLineAndFaultOfABadFile) {
  ExpectRefused("t.csv", TableError,
                {{1, ""}, {1, "a,,c\n"}, {1, "a,b,a\n"}, {3, "a,b\n1,2\n1,2,3\n"}, {2, "a\n\"open\n"}});
  const CsvTable table = ParseTable("a,b\n1,x\n");
  EXPECT_KEPT(MessageOf([&] { CsvNumber(table, table.rows[0], 1, 1.0); }));
  EXPECT_KEPT(MessageOf([] { ReadCsv("no_such.csv"); }));
  EXPECT_KEPT(MessageOf([] { ReadCsv("/"); }));
  EXPECT_KEPT(MessageOf([] { ReadCsv("/dev/null"); }));
  for (const char* header : {"mesured_deg", "measured_arcsec", "nothing_like_it"}) {
    const CsvTable other = ParseTable(std::string(header) + "\n1\n");
    EXPECT_KEPT(MessageOf([&] { NeededColumn(other, "measured_deg", "two angles"); }));
  }
}

}  // namespace
}  // namespace twinbench
