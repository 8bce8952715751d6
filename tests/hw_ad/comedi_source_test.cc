#include "hw_bridge/numbers/number_drivers.h"
#include "tests/core/input_error.h"
#include "tests/hw_ad/backend_test.h"
#include "tests/support/kept_text.h"

/// On libcomedi itself. Run with the library of tests/support/comedi_device preloaded, as ctest does: it answers
/// for /dev/comedi0 with the counts of a served twin.
namespace twinbench::hw {
namespace {

using test::ComediSettings, test::ServedCard, test::Struck;

class ComediSourceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("LD_PRELOAD") == nullptr) GTEST_SKIP() << "needs the preloaded card; ctest brings it";
  }
  void TearDown() override { unsetenv("TWINBENCH_COMEDI_TWIN"); }
};

TEST_F(ComediSourceTest, GivesTheServedTwinsOwnBlocksAlsoInAnotherRangeAndResolution) {
  ServedCard(ComediSettings).ExpectTheTwinsOwnBlocks();
  const Scenario other = Altered(test::RotaryScenario(), {"adc.rate_kHz=100", "adc.range_V=5", "adc.bits=12",
                                                          "amplifier.offset_mV=[0, 0, -6000, 0]"});
  ServedCard(ComediSettings, other).ExpectTheTwinsOwnBlocks();
}

TEST_F(ComediSourceTest, TellsWhatTheCardIs) {
  const Negotiated actual = ServedCard(ComediSettings).Open()->Actual();
  EXPECT_EQ(actual.bits, 16);
  EXPECT_DOUBLE_EQ(actual.actual.scan_rate_Hz, 62.5e3);
  EXPECT_DOUBLE_EQ(actual.actual.channels[0].range_V, 10.0)
      << "the smallest that covers it, of 20 V, 10 V and 0 to 10 V";
  EXPECT_DOUBLE_EQ(actual.skew_s[3], 12e-6);
  EXPECT_FALSE(actual.stamps_scans);
  EXPECT_THAT(actual.identity, ::testing::HasSubstr("preloaded-ai16"));
}

class ComediFault : public ComediSourceTest, public ::testing::WithParamInterface<Struck> {};

TEST_P(ComediFault, IsNamedAndTheNextBlockIsWhole) {
  ServedCard(ComediSettings).ExpectNamedAndTheNextBlocksWhole(GetParam());
}

// A card knows no connection: what ends a stream of the twin fills its FIFO.
INSTANTIATE_TEST_SUITE_P(Every, ComediFault,
                         ::testing::Values(Struck{"drop", "overrun"}, Struck{"error", "overrun"},
                                           Struck{"gap", "overrun"}, Struck{"stall", "timeout"},
                                           Struck{"short", "dropped"}, Struck{"slip", "channel_slip"},
                                           Struck{"stuck", "stuck"}, Struck{"float", "signal_lost"}),
                         Struck::Name);

TEST_F(ComediSourceTest, SaysAsWhatTheDriverGaveUpAFullFifo) {
  const ServedCard card(ComediSettings);
  const auto opened = card.Open();
  card.served.Inject("drop");
  EXPECT_THAT(test::TextOf([&] { opened->Acquire(100, true); }), ::testing::HasSubstr("errno 32"));  // EPIPE, as the kernel's comedi
}

TEST_F(ComediSourceTest, RefusesWhatTheCardHasNot) {
  const ServedCard card(ComediSettings);
  EXPECT_EQ(card.FaultWith([](AdSettings& s) { s.device = "/dev/comedi7"; }), "dropped");
  EXPECT_EQ(card.FaultWith([](AdSettings& s) { s.channels[3] = "17"; }), "refused");
  EXPECT_EQ(card.FaultWith([](AdSettings& s) { std::ranges::reverse(s.channels); }), "refused") << "it scans up";
  EXPECT_EQ(card.FaultWith([](AdSettings& s) { s.subdevice = 1; }), "refused");
  EXPECT_EQ(card.FaultWith([](AdSettings& s) { s.reference = "common"; }), "refused");
  EXPECT_EQ(card.FaultWith([](AdSettings& s) { s.serial = "1234"; }), "identity")
      << "comedi tells no serial number";
}

TEST_F(ComediSourceTest, RefusesARateThatTheCardTurnsIntoAnother) {
  ServedCard card(ComediSettings);
  RotaryOf(card.scenario).adc.rate_Hz = 977517.0;  // 1023 ns a conversion; the card does 4000 ns
  EXPECT_EQ(test::FaultIn([&] { card.Open(); }), "refused");
  EXPECT_THAT(test::TextOf([&] { card.Open(); }),
              ::testing::AllOf(::testing::HasSubstr("62500"), ::testing::HasSubstr("244379.25")));
}

/// A calibration file.
std::string CalibrationOf(const std::string& board) {
  return "{\n driver_name => \"twinbench\",\n board_name => \"" + board +
         "\",\n calibrations =>\n [\n  {\n   subdevice => 0,\n   channels => [],\n   ranges => [1],\n"
         "   arefs => [],\n   caldacs => [],\n   softcal_to_phys =>\n   {\n    expansion_origin => "
         "32770.0,\n    coefficients => [0.001, 0.000305, 1e-12]\n   },\n  },\n ]\n}\n";
}

TEST_F(ComediSourceTest, MeasuresWithTheCalibrationOfTheFile) {
  const TemporaryFolder folder;
  ServedCard card(ComediSettings);
  card.settings.calibration_file = folder.Write("card.cal", CalibrationOf("preloaded-ai16"));
  const auto opened = card.Open();
  const CalibrationPolynomial polynomial = opened->Actual().calibration[1];
  EXPECT_EQ(polynomial.origin, 2.0) << "32770 in offset binary";
  EXPECT_EQ(polynomial.coefficients_V, (std::vector<double>{0.001, 0.000305, 1e-12}));
  const Acquisition block = opened->Acquire(100, true);
  double sum_V = 0.0;
  for (std::size_t i = 1; i < block.raw.size(); i += 4) {
    const double code = block.raw[i] - 2.0;
    sum_V += 0.001 + 0.000305 * code + 1e-12 * code * code;
  }
  EXPECT_NEAR(block.channel[1].mean_V, sum_V / 100.0, 1e-13);
}

TEST_F(ComediSourceTest, RefusesACalibrationThatIsMissingOrOfAnotherBoard) {
  const TemporaryFolder folder;
  const std::string another = folder.Write("card.cal", CalibrationOf("another-board"));
  const ServedCard card(ComediSettings);
  for (const std::string& file : {std::string("/nowhere/card.cal"), another})
    EXPECT_EQ(card.FaultWith([&](AdSettings& s) { s.calibration_file = file; }), "refused") << file;
}

/// Of subdevice 2, which has two counters.
class ComediNumbersTest : public ComediSourceTest {
 protected:
  std::vector<double> Read(const std::vector<std::string>& items) {
    const std::string device = test::ComediSettings(served_).device;
    return MakeComediNumbers({.kind = "comedi", .address = "", .device = device, .items = items}, "instrument_1",
                             "bench.toml:7")
        ->Read();
  }

  test::HeldTwin served_{test::RotaryScenario()};
};

TEST_F(ComediNumbersTest, CountersAreReadWithTheSignThatTheyAreSaidToHave) {
  EXPECT_THAT(Read({"2 0", "2 1", "2 1 signed", "2 0 signed"}),
              testing::ElementsAre(1234567.0, 16777216.0 - 42.0, -42.0, 1234567.0));
}

TEST_F(ComediNumbersTest, WhatTheCardHasNotIsRefused) {
  const auto read = [&] { Read({"2 2"}); };
  EXPECT_EQ(test::FaultIn(read), "refused");
  EXPECT_THAT(test::TextOf(read), testing::HasSubstr("no channel 2 of subdevice 2"));
}

TEST_F(ComediNumbersTest, AnItemThatIsNoneIsToldWithItsLine) {
  for (const char* item : {"2", "x 0", "2 0 unsigned", "2 0 signed more", "-1 0", ""}) {
    const std::string refusal = MessageOf([&] { Read({item}); });
    EXPECT_THAT(refusal, testing::StartsWith("bench.toml:7: "));
    EXPECT_KEPT(refusal);
  }
}

}  // namespace
}  // namespace twinbench::hw
