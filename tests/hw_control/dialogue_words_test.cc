#include "hw_bridge/control/dialogue_words.h"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <set>

#include "hw_bridge/bench_file.h"
#include "tests/core/input_error.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// What is wrong with a dialogue.
std::string WhatIsWrongWith(const std::string& text) {
  try {
    ParseDialogue(text, "my.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing";
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
  EXPECT_THAT(WhatIsWrongWith(whole + "unitts = 3\n"),
              AllOf(HasSubstr("my.toml:6"), HasSubstr("nearest is read.units")));
  EXPECT_THAT(WhatIsWrongWith("[raed]\nask = \"A?\"\n"), AllOf(HasSubstr("my.toml:1"), HasSubstr("read")));
  EXPECT_THAT(WhatIsWrongWith("[read]\nask = \"A?\"\nfields = [\"x\"]\nunits = [\"arcsecs\"]\n"),
              AllOf(HasSubstr("my.toml:4"), HasSubstr("\"arcsecs\" is no unit; expected \"arcsec\"")));
  EXPECT_THAT(WhatIsWrongWith("[read]\nask = \"A?\"\nfields = [\"x\", \"y\"]\nvalid = [\"4\"]\n"),
              AllOf(HasSubstr("my.toml:4"), HasSubstr("1 entries for 2 fields")));
  EXPECT_THAT(WhatIsWrongWith("[read]\nfields = [\"x\"]\n"),
              AllOf(HasSubstr("my.toml:1"), HasSubstr("only one of ask and fields")));
  EXPECT_THAT(WhatIsWrongWith("[move]\ncommand = \"GOTO {toth}\"\n"),
              AllOf(HasSubstr("my.toml:2"), HasSubstr("no place {toth}"), HasSubstr("expected {tooth}")));
  EXPECT_THAT(WhatIsWrongWith(whole + "[latch]\narm = \"ARM {samples}\"\n"),
              HasSubstr("only one of arm and fetch"));
  EXPECT_THAT(WhatIsWrongWith(whole + "[line]\nends = \"LFCR\"\n"),
              AllOf(HasSubstr("my.toml:7"), HasSubstr("\"CRLF\"")));
  EXPECT_THAT(WhatIsWrongWith(whole + "[line]\nseparator = \"\"\n"), HasSubstr("my.toml:7"));
  EXPECT_THAT(WhatIsWrongWith("title = \"mute\"\n"), HasSubstr("nothing that can be asked"));
}

/// Each is tried against its counterpart: the served ones in served_bits_test.cc and tests/machine, the others in
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

/// The bench file of a turntable with what its instrument is said.
std::string WhatIsWrongWithTable(const std::string& table, const std::string& folder = "") {
  const std::string file =
      "[adc]\nkind = \"iio\"\ndevice = \"d\"\nchannels = [\"a\", \"b\", \"c\", \"d\"]\n"
      "[target]\nkind = \"esp\"\naddress = \"tcp:a:1\"\n"
      "[reference]\nkind = \"esp\"\naddress = \"tcp:b:1\"\n";
  try {
    ParseBenchFile(file + table, "bench.toml", folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing";
}

TEST(BenchFileWithDialogue, FindsAReadyOneAndAFileBesideTheBenchFile) {
  const TemporaryFolder folder;
  std::ofstream(folder.File("my.toml")) << kWhole;
  const std::string address = "address = \"serial:/dev/ttyUSB0:9600:7E2\"\n";
  EXPECT_EQ(WhatIsWrongWithTable("[autocollimator]\nkind = \"dialogue\"\ndialogue = \"elcomat\"\n" + address),
            "nothing");
  EXPECT_EQ(WhatIsWrongWithTable("[autocollimator]\nkind = \"dialogue\"\ndialogue = \"my.toml\"\n" + address,
                                 folder.path()),
            "nothing");
}

TEST(BenchFileWithDialogue, SaysWhichKeyIsWrongAndWhatWouldBeRight) {
  const std::string begin = "[autocollimator]\naddress = \"tcp:c:1\"\nkind = \"dialogue\"\n";
  EXPECT_THAT(WhatIsWrongWithTable(begin),
              AllOf(HasSubstr("bench.toml:11"), HasSubstr("autocollimator.dialogue is missing")));
  EXPECT_THAT(
      WhatIsWrongWithTable(begin + "dialogue = \"elcomatt\"\n"),
      AllOf(HasSubstr("bench.toml:14"), HasSubstr("no ready dialogue \"elcomatt\""), HasSubstr("elcomat,")));
  EXPECT_THAT(WhatIsWrongWithTable(begin + "dialogue = \"mine.toml\"\n", "/nowhere"),
              HasSubstr("/nowhere/mine.toml cannot be read"));
  EXPECT_THAT(WhatIsWrongWithTable(begin + "dialogue = \"heidenhain_nd287\"\n"),
              HasSubstr("fields \"x\" and \"y\""));
  EXPECT_THAT(WhatIsWrongWithTable(begin + "dialogue = \"elcomat\"\nidentity = \"ELCOMAT\"\n"),
              HasSubstr("does not tell who it is"));
  EXPECT_THAT(WhatIsWrongWithTable(begin + "dialogue = \"elcomat\"\ntoken = \"abc\"\n"),
              HasSubstr("autocollimator.token"));
  EXPECT_THAT(
      WhatIsWrongWithTable("[thermometer]\nkind = \"scpi\"\naddress = \"tcp:c:1\"\ndialogue = \"elcomat\"\n"),
      HasSubstr("expected kind = \"dialogue\""));
}

}  // namespace
}  // namespace twinbench::hw
