#include "twin/core/csv.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/core/input_error.h"

namespace twinbench {
namespace {

CsvTable ParseTable(const std::string& text) {
  std::istringstream in(text);
  return ParseCsv(in, "t.csv");
}

std::string TableError(const std::string& text) {
  return MessageOf([&] { ParseTable(text); });
}

TEST(Csv, SkipsCommentsAndCountsTheirLines) {
  const CsvTable table = ParseTable("# made by hand\na,b\n\n# a comment\n1,2\n");
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.WhereHeader(), "t.csv:2");
  EXPECT_EQ(table.Where(table.rows[0]), "t.csv:5");
}

TEST(Csv, TakesFilesOfOtherSystems) {
  const CsvTable table = ParseTable(
      "\xEF\xBB\xBF"
      "a,b\r\n 1 ,2\r\n");
  EXPECT_EQ(table.columns, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(table.rows[0].fields, (std::vector<std::string>{"1", "2"}));
}

TEST(Csv, KeepsEmptyFieldsAlsoTheLast) {
  EXPECT_EQ(ParseTable("a,b,c\n,,\n").rows[0].fields, (std::vector<std::string>{"", "", ""}));
}

TEST(Csv, ReadsWhatItQuotes) {
  for (const std::string text : {"plain", "two, parts", "a \"word\"", " blanks ", "#no comment", ""}) {
    const CsvTable table = ParseTable("a,b\n" + QuoteCsv(text) + ",1\n");
    EXPECT_EQ(table.rows[0].fields[0], text);
    EXPECT_EQ(table.rows[0].fields[1], "1");
  }
}

TEST(Csv, NamesLineAndFaultOfABadFile) {
  EXPECT_EQ(TableError(""), "t.csv:1: the file has no header line; expected names of columns");
  EXPECT_EQ(TableError("a,,c\n"), "t.csv:1: column 2 has no name; expected a name");
  EXPECT_EQ(TableError("a,b,a\n"), "t.csv:1: column a comes twice; expected every column once");
  EXPECT_EQ(TableError("a,b\n1,2\n1,2,3\n"), "t.csv:3: 3 fields; expected 2, as in the header");
  EXPECT_EQ(TableError("a\n\"open\n"),
            "t.csv:2: a quote is opened and not closed; expected a \" at the end of the field");
}

TEST(Csv, NamesTheColumnOfAFieldThatIsNoNumber) {
  const CsvTable table = ParseTable("a,b\n1,x\n");
  EXPECT_EQ(MessageOf([&] { CsvNumber(table, table.rows[0], 1, 1.0); }),
            "t.csv:2: b is \"x\"; expected a finite number");
}

TEST(Csv, NamesAFileThatIsNotThere) {
  EXPECT_EQ(MessageOf([] { ReadCsv("no_such.csv"); }),
            "no_such.csv: the file cannot be opened; expected a readable file");
}

}  // namespace
}  // namespace twinbench
