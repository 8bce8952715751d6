#include "hw_bridge/control/described_devices.h"

#include "hw_bridge/control/instrument_box.h"
#include "tests/core/input_error.h"
#include "tests/hw_control/fake_controller.h"
#include "tests/support/faults.h"
#include "tests/support/kept_text.h"

/// Instruments by their ready dialogues, each against a counterpart of its own on a serial line, and what a
/// dialogue can say besides.
namespace twinbench::hw {
namespace {

using test::FakeController, test::KindOf;

constexpr Duration kAnswersWithin = std::chrono::milliseconds(300);

/// The connection of one device by its dialogue.
struct Spoken {
  Spoken(const FakeController& at, const DialogueWords& its_words)
      : words(its_words),
        dialogue(ParseAddress(at.Address()).value(), words.identify, words.identify.empty() ? words.title : "") {
    dialogue.Speak(words.line);
  }
  DeviceLine Line() { return {dialogue, "instrument", kAnswersWithin}; }
  DialogueWords words;
  Dialogue dialogue;
};

/// ELCOMAT: a letter, answered by "<mode> <state> <x> <y>" and CR.
FakeController::Reply Elcomat(const std::string& line, const std::string& state) {
  if (line == "a\r") return {fmt::format("4 {} 0012.34 -0005.67\r", state)};
  if (line == "r\r") return {fmt::format("2 1{} -0001.50 00000.25\r", state.substr(1))};
  return {};
}

TEST(Elcomat, ShowsAbsoluteAndRelativeAnglesAndNothingInAnotherState) {
  std::atomic<const char*> state = "003";  // the instrument answers on a thread of its own
  FakeController device([&](const std::string& line) { return Elcomat(line, state.load()); },
                        FakeController::Wire::kPseudoTerminal);
  Spoken absolute(device, ReadyDialogueNamed("elcomat"));
  DescribedAutocollimator collimator(absolute.Line(), absolute.words);
  EXPECT_NEAR(collimator.Read().yaw_rad / units::arcsec, 12.34, 1e-12);
  EXPECT_NEAR(collimator.Read().tilt_rad / units::arcsec, -5.67, 1e-12);
  EXPECT_EQ(absolute.dialogue.identity(), "ELCOMAT, absolute angles") << "it does not tell who it is";
  state = "001";
  EXPECT_TRUE(std::isnan(collimator.Read().yaw_rad));
  absolute.dialogue.Close();

  state = "003";
  Spoken relative(device, ReadyDialogueNamed("elcomat_relative"));
  EXPECT_NEAR(DescribedAutocollimator(relative.Line(), relative.words).Read().yaw_rad / units::arcsec, -1.5, 1e-12);
}

TEST(Elcomat, AnAnswerOfAnotherFormIsNone) {
  FakeController device([](const std::string&) { return FakeController::Reply{"4 003 12.34\r"}; });
  Spoken spoken(device, ReadyDialogueNamed("elcomat"));
  const auto read = [&] { DescribedAutocollimator(spoken.Line(), spoken.words).Read(); };
  EXPECT_EQ(KindOf(read), FaultKind::kProtocol);
  EXPECT_KEPT(test::TextWithoutAddress(read));
}

/// A column in degrees, as a comparison's reference.
std::vector<ReadingColumn> Degrees() {
  return {ShownColumn("reference_deg", units::deg, "deg", [](auto& r) -> auto& { return r.reference_rad; })};
}

/// ND 28x: commands behind ESC with CR at their ends, answers between STX and CR LF.
TEST(HeidenhainNd287, IsACounterInUnitsOfItsLastDigit) {
  FakeController device(
      [](const std::string& line) {
        if (line == "\033A0000") return FakeController::Reply{"\002ND 287 349797 01\r\n"};
        return FakeController::Reply{line == "\033A0200" ? "\002+00123456\r\n" : "\025\r\n"};
      },
      FakeController::Wire::kPseudoTerminal, 0, '\r');
  Spoken spoken(device, ReadyDialogueNamed("heidenhain_nd287"));
  InstrumentWords file;
  file.fields = {"reference_deg"};
  file.scale = {1e-4};
  InstrumentBox box(spoken.Line(), WithDialogue(file, spoken.words, Degrees()), Degrees());
  EXPECT_FALSE(box.Latches());
  EXPECT_NEAR(box.Read().reference_rad / units::deg, 12.3456, 1e-12);
  EXPECT_EQ(spoken.dialogue.identity(), "ND 287 349797 01");
}

TEST(InstrumentWithDialogue, GoesFromTheDialoguesUnitToTheColumns) {
  const DialogueWords words = ParseDialogue(
      "[read]\nask = \"P?\"\nfields = [\"position\"]\nunits = [\"urad\"]\nscale = [-0.5]\nnothing = [\"---\"]\n",
      "my.toml");
  std::string answer = "2.0e6";
  FakeController device([&](const std::string& line) {
    return FakeController::Reply{(line == "*IDN?" ? "counter" : answer) + "\n"};
  });
  Spoken spoken(device, words);
  InstrumentWords file;
  file.fields = {"reference_deg"};
  InstrumentBox box(spoken.Line(), WithDialogue(file, words, Degrees()), Degrees());
  EXPECT_NEAR(box.Read().reference_rad, -1.0, 1e-15);
  answer = "---";
  EXPECT_TRUE(std::isnan(box.Read().reference_rad));

  file.fields = {"reference_dag"};
  file.where = "bench.toml:12";
  EXPECT_KEPT(MessageOf([&] { WithDialogue(file, words, Degrees()); }));
}

/// A table that acknowledges what it does and says `ERR` where it does not.
TEST(DescribedIndexer, KnowsAnAcknowledgementFromARefusal) {
  int looks = 0;
  FakeController device([&](const std::string& line) -> FakeController::Reply {
    if (line == "GO 12") return {"OK moving\n"};
    if (line == "GO 99") return {"ERR 5\n"};
    if (line == "POS?") return {++looks < 3 ? "0\n" : "1\n"};
    return {};
  });
  const DialogueWords words = ParseDialogue(
      "identify = \"\"\n[errors]\nacknowledged = \"OK\"\n[move]\ncommand = \"GO {tooth}\"\ndone = \"POS?\"\n",
      "my.toml");
  Spoken spoken(device, words);
  DescribedIndexer indexer(spoken.Line(), words, 5.0);
  indexer.IndexTo(12, 12.0 * units::deg);
  EXPECT_EQ(looks, 3);
  EXPECT_EQ(KindOf([&] { indexer.IndexTo(99, 99.0 * units::deg); }), FaultKind::kRefused);
}

/// Its table is never seated, or takes a minute to answer.
TEST(DescribedIndexer, IsToldToStopWhereTheOperatorStopsOrItsTimeIsOver) {
  for (const char* done : {"POS?", ""}) {
    FakeController device([](const std::string& line) -> FakeController::Reply { return {line == "POS?" ? "0\n" : ""}; });
    const DialogueWords words = ParseDialogue(fmt::format("identify = \"\"\n[errors]\n{}[move]\ncommand = \"GO {{tooth}}\"\ndone = \"{}\"\nstop = \"HALT\"\n",
                                                          *done ? "" : "acknowledged = \"OK\"\n", done), "my.toml");
    Spoken spoken(device, words);
    bool is_asked = false;
    DeviceLine line = spoken.Line();
    line.HearStop([&] { return std::exchange(is_asked, true); });
    DescribedIndexer indexer(line, words, 60.0);
    EXPECT_EQ(KindOf([&] { indexer.IndexTo(12, 12.0 * units::deg); }), FaultKind::kStopped);
    const auto is_told = [&] {
      const std::vector<std::string> lines = device.Lines();
      return std::ranges::find(lines, "HALT") != lines.end();
    };
    while (!is_told()) std::this_thread::yield();  // the word is on its way
  }
}

TEST(DescribedDevices, ARefusalIsNoNumberAndALimitIsOne) {
  FakeController device([](const std::string& line) -> FakeController::Reply {
    if (line == "T?") return {"?SYNTAX\n"};
    return {line == "LAST?" ? "E42 beyond\n" : ""};
  });
  const DialogueWords words = ParseDialogue(
      "identify = \"\"\n[errors]\nask = \"LAST?\"\nnone = \"E0\"\nlimit = \"E42\"\nrefusals = [\"?\"]\n"
      "[read]\nask = \"T?\"\nfields = [\"temperature\"]\n[tilt]\ncommand = \"TURN {yaw} {tilt}\"\nunit = "
      "\"mrad\"\n",
      "my.toml");
  Spoken spoken(device, words);
  DescribedThermometer thermometer(spoken.Line(), words);
  EXPECT_EQ(KindOf([&] { thermometer.Read_degC(); }), FaultKind::kRefused);
  DescribedGoniometer goniometer(spoken.Line(), words);
  EXPECT_EQ(KindOf([&] { goniometer.MoveTo(0.25, -0.5); }), FaultKind::kLimit);
  EXPECT_THAT(device.Lines(), testing::Contains("TURN 250 -500"));
}

}  // namespace
}  // namespace twinbench::hw
