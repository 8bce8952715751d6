#include "hw_bridge/control/dialogue_words.h"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <set>

#include "hw_bridge/bench_file.h"
#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

using testing::HasSubstr, testing::StartsWith;

/// What is wrong with a text is kept, and where in `file` it is; line 0: in the text as a whole.
void ExpectRefused(const std::string& message, const std::string& file, int line) {
  EXPECT_THAT(message, StartsWith(file + (line > 0 ? ":" + std::to_string(line) + ": " : ":")));
  EXPECT_KEPT(message);
}

constexpr const char* kWhole = R"(title = "autocollimator of the cellar"
[read]
ask = "A?"
fields = ["x", "y"]
units = ["urad", "urad"]
)";

TEST(DialogueWords, AWholeOneIsTakenAsItStands) {
  const DialogueWords words = ParseDialogue(kWhole, "my.toml");
  EXPECT_EQ(words.title, "autocollimator of the cellar");
  EXPECT_EQ(words.read.fields, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(words.identify, "*IDN?") << "what is not said is as of SCPI";
  EXPECT_TRUE(words.errors == ErrorWords{});
}

TEST(DialogueWords, WhatIsWrongIsToldWithFileLineAndTheNearestRightThing) {
  const std::string whole = kWhole;
  const std::pair<int, std::string> cases[] = {
      {6, whole + "unitts = 3\n"}, {1, "[raed]\nask = \"A?\"\n"},
      {4, "[read]\nask = \"A?\"\nfields = [\"x\"]\nunits = [\"arcsecs\"]\n"},
      {4, "[read]\nask = \"A?\"\nfields = [\"x\", \"y\"]\nvalid = [\"4\"]\n"}, {1, "[read]\nfields = [\"x\"]\n"},
      {2, "[move]\ncommand = \"GOTO {toth}\"\n"}, {0, whole + "[latch]\narm = \"ARM {samples}\"\n"},
      {7, whole + "[line]\nends = \"LFCR\"\n"}, {7, whole + "[line]\nseparator = \"\"\n"},
      {0, "title = \"mute\"\n"},
  };
  for (const auto& [line, text] : cases)
    ExpectRefused(MessageOf([&] { ParseDialogue(text, "my.toml"); }), "my.toml", line);
}

/// Each is tried against its counterpart: the served ones in tests/contract and tests/machine, the others in
/// described_devices_test.cc.
TEST(DialogueWords, ReadyOnesAreTheseAndAllAreWhole) {
  std::set<std::string> names;
  for (const ReadyDialogue& ready : ReadyDialogues()) {
    names.insert(ready.name);
    EXPECT_FALSE(ParseDialogue(ready.text, ready.name).title.empty()) << ready.name;
  }
  EXPECT_EQ(names,
            (std::set<std::string>{"elcomat", "elcomat_relative", "heidenhain_nd287", "served_autocollimator",
                                   "served_goniometer", "served_indexer", "served_thermometer"}));
}

TEST(DialogueWords, EveryKeyStandsInTheDocumentation) {
  std::ifstream in(TWINBENCH_SOURCE_DIR "/docs/hardware.md");
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  const auto begin = whole.find("## An instrument in words");
  ASSERT_NE(begin, std::string::npos);
  const std::string section = whole.substr(begin, whole.find("\n## ", begin + 1) - begin);
  DialogueWords words;
  for (const ScenarioKey& key : words.Keys()) {
    EXPECT_THAT(section, HasSubstr("`" + key.name + "`")) << key.Path();
    EXPECT_THAT(section, HasSubstr(key.table.empty() ? "`" : "`[" + key.table + "]`"));
  }
  for (const ReadyDialogue& ready : ReadyDialogues()) EXPECT_THAT(section, HasSubstr("`" + ready.name + "`"));
}

TEST(DialogueWords, UnitsOfOneKindAreToldInEachOther) {
  EXPECT_NEAR(ScaleToColumn("urad", "autocollimator_x_arcsec", "here"), 0.20626480624709636, 1e-16);
  EXPECT_DOUBLE_EQ(ScaleToColumn("mm", "bar_um", "here"), 1e3);
  EXPECT_EQ(ScaleToColumn("um", "bar_um", "here"), 1.0);
  EXPECT_EQ(ScaleToColumn("", "bar_um", "here"), 1.0) << "the bench file's scale says what it is";
  EXPECT_THROW(ScaleToColumn("deg", "bar_um", "here"), InputError);
}

/// A bench file with a table of an instrument, which begins in line 11.
void ParseWithTable(const std::string& table, const std::string& folder) {
  const std::string file =
      "[adc]\nkind = \"iio\"\ndevice = \"d\"\nchannels = [\"a\", \"b\", \"c\", \"d\"]\n"
      "[target]\nkind = \"esp\"\naddress = \"tcp:a:1\"\n"
      "[reference]\nkind = \"esp\"\naddress = \"tcp:b:1\"\n";
  ParseBenchFile(file + table, "bench.toml", folder);
}

TEST(BenchFileWithDialogue, FindsAReadyOneAndAFileBesideTheBenchFile) {
  const TemporaryFolder folder;
  folder.Write("my.toml", kWhole);
  for (const char* dialogue : {"elcomat", "my.toml"})
    EXPECT_NO_THROW(ParseWithTable(
        "[autocollimator]\nkind = \"dialogue\"\naddress = \"serial:/dev/ttyUSB0:9600:7E2\"\ndialogue = \"" +
            std::string(dialogue) + "\"\n",
        folder.path()));
}

TEST(BenchFileWithDialogue, SaysWhichKeyIsWrongAndWhatWouldBeRight) {
  const std::string begin = "[autocollimator]\naddress = \"tcp:c:1\"\nkind = \"dialogue\"\n";
  const std::pair<int, std::string> cases[] = {
      {11, begin}, {14, begin + "dialogue = \"elcomatt\"\n"}, {14, begin + "dialogue = \"mine.toml\"\n"},
      {14, begin + "dialogue = \"heidenhain_nd287\"\n"},
      {15, begin + "dialogue = \"elcomat\"\nidentity = \"ELCOMAT\"\n"},
      {15, begin + "dialogue = \"elcomat\"\ntoken = \"abc\"\n"},
      {14, "[thermometer]\nkind = \"scpi\"\naddress = \"tcp:c:1\"\ndialogue = \"elcomat\"\n"},
  };
  for (const auto& [line, table] : cases)
    ExpectRefused(MessageOf([&] { ParseWithTable(table, "/nowhere"); }), "bench.toml", line);
}

}  // namespace
}  // namespace twinbench::hw
