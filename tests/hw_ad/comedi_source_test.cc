#include "hw_bridge/ad/comedi_source.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/hw_ad/backend_test.h"
#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/settings.h"

/// On libcomedi itself. Run with the library of tests/support/comedi_device preloaded, as ctest does: it answers
/// for /dev/comedi0 with the counts of a served twin.
namespace twinbench::hw {
namespace {

using test::ComediSettings;
using test::FaultIn;
using test::HeldTwin;
using Stopwatch = std::chrono::steady_clock;

class ComediSourceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("LD_PRELOAD") == nullptr) GTEST_SKIP() << "needs the preloaded card; ctest brings it";
  }
  void TearDown() override {
    unsetenv("TWINBENCH_COMEDI_TWIN");
    unsetenv("TWINBENCH_COMEDI_FAULT");
  }
  static std::unique_ptr<AdFrontEnd> Open(const HeldTwin& served, const Scenario& scenario,
                                          const AdSettings& settings) {
    return MakeAdConverter(settings, RotaryOf(scenario).adc, served, RotaryOf(scenario).amplifier.noise_V);
  }
};

TEST_F(ComediSourceTest, GivesTheServedTwinsOwnBlocks) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, ComediSettings(served));
  test::ExpectTheTwinsOwnBlocks(*card, served, scenario);
}

TEST_F(ComediSourceTest, GivesTheTwinsBlocksInAnotherRangeAndResolution) {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).adc.rate_Hz = 100e3;
  RotaryOf(scenario).adc.range_V = 5.0;
  RotaryOf(scenario).adc.bits = 12;
  RotaryOf(scenario).amplifier.offset_V[2] = -6.0;
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, ComediSettings(served));
  test::ExpectTheTwinsOwnBlocks(*card, served, scenario);
}

TEST_F(ComediSourceTest, TellsWhatTheCardIs) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const Negotiated actual = Open(served, scenario, ComediSettings(served))->Actual();
  EXPECT_EQ(actual.bits, 16);
  EXPECT_DOUBLE_EQ(actual.actual.scan_rate_Hz, 62.5e3);
  EXPECT_DOUBLE_EQ(actual.actual.channels[0].range_V, 10.0)
      << "the smallest that covers it, of 20 V, 10 V and 0 to 10 V";
  EXPECT_DOUBLE_EQ(actual.skew_s[3], 12e-6);
  EXPECT_FALSE(actual.stamps_scans);
  EXPECT_THAT(actual.identity, ::testing::HasSubstr("preloaded-ai16"));
}

TEST_F(ComediSourceTest, LosesTheLightAsTheTwinDoes) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, ComediSettings(served));
  served.Ask("GON:MOVE 10800,0;*OPC?");
  sim::Twin twin(scenario);
  twin.Bench().goniometer.MoveTo(3.0 * units::deg, 0.0);
  EXPECT_EQ(card->Acquire(100, true).status, twin.Bench().adc.Acquire(100, true).status);
  served.Ask("GON:MOVE 0,0;*OPC?");
  EXPECT_EQ(card->Acquire(100, true).status, ReadingStatus::kOk);
  served.Inject("no_light");
  EXPECT_EQ(card->Acquire(100, true).status, ReadingStatus::kNoLight);
}

// --- faults: each by its name, and the block after it is as good as any ---

struct Struck {
  const char* injected;
  const char* fault;
};

class ComediFault : public ComediSourceTest, public ::testing::WithParamInterface<Struck> {};

TEST_P(ComediFault, IsNamedAndTheNextBlockIsWhole) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, ComediSettings(served));
  served.Ask("GON:MOVE 150,80;*OPC?");
  card->Acquire(100, true);
  for (int round = 0; round < 2; ++round) {
    served.Inject(GetParam().injected);
    const auto start = Stopwatch::now();
    EXPECT_EQ(FaultIn([&] { card->Acquire(200, true); }), GetParam().fault);
    EXPECT_LT(std::chrono::duration<double>(Stopwatch::now() - start).count(), 1.0);
    const Acquisition after = card->Acquire(200, true);
    EXPECT_EQ(after.status, ReadingStatus::kOk);
    EXPECT_EQ(after.raw.size(), 800u);
  }
}

// A card knows no connection: what ends a stream of the twin fills its FIFO.
INSTANTIATE_TEST_SUITE_P(Every, ComediFault,
                         ::testing::Values(Struck{"drop", "overrun"}, Struck{"error", "overrun"},
                                           Struck{"gap", "overrun"}, Struck{"stall", "timeout"},
                                           Struck{"short", "dropped"}, Struck{"slip", "channel_slip"},
                                           Struck{"stuck", "stuck"}, Struck{"float", "signal_lost"}),
                         [](const auto& instance) { return std::string(instance.param.injected); });

TEST_F(ComediSourceTest, StartsAgainAfterAFullFifo) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const auto card = Open(served, scenario, ComediSettings(served));
  setenv("TWINBENCH_COMEDI_FAULT", "fifo_full", 1);
  try {
    card->Acquire(100, true);
    FAIL() << "no fault";
  } catch (const DeviceFault& fault) {
    EXPECT_EQ(fault.kind(), FaultKind::kOverrun);
    EXPECT_THAT(fault.what(), ::testing::HasSubstr("errno 32"));  // EPIPE, as the kernel's comedi says it
  }
  unsetenv("TWINBENCH_COMEDI_FAULT");
  EXPECT_EQ(card->Acquire(100, true).status, ReadingStatus::kOk);
}

TEST_F(ComediSourceTest, RefusesWhatTheCardHasNot) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const AdSettings good = ComediSettings(served);
  AdSettings settings = good;
  settings.device = "/dev/comedi7";
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "dropped");
  settings = good;
  settings.channels[3] = "17";
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "refused");
  settings = good;
  settings.channels = {"3", "2", "1", "0"};  // it scans from 0 up
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "refused");
  settings = good;
  settings.subdevice = 1;
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "refused");
  settings = good;
  settings.reference = "common";
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "refused");
  settings = good;
  settings.serial = "1234";
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "identity") << "comedi tells no serial number";
}

TEST_F(ComediSourceTest, RefusesARateThatTheCardTurnsIntoAnother) {
  Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  RotaryOf(scenario).adc.rate_Hz = 977517.0;  // 1023 ns a conversion; the card does 4000 ns
  try {
    Open(served, scenario, ComediSettings(served));
    FAIL() << "was not refused";
  } catch (const DeviceFault& fault) {
    EXPECT_EQ(fault.kind(), FaultKind::kRefused);
    EXPECT_THAT(fault.what(), ::testing::AllOf(::testing::HasSubstr("62500"), ::testing::HasSubstr("244379.25")));
  }
}

// --- calibration files ---

class CalibrationFile {
 public:
  explicit CalibrationFile(const std::string& board) {
    std::ofstream(path_)
        << "{\n driver_name => \"twinbench\",\n board_name => \"" << board
        << "\",\n calibrations =>\n [\n  {\n   subdevice => 0,\n   channels => [],\n   ranges => [1],\n"
           "   arefs => [],\n   caldacs => [],\n   softcal_to_phys =>\n   {\n    expansion_origin => "
           "32770.0,\n    coefficients => [0.001, 0.000305, 1e-12]\n   },\n  },\n ]\n}\n";
  }
  ~CalibrationFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_ =
      (std::filesystem::temp_directory_path() / ("card" + std::to_string(getpid()) + ".cal")).string();
};

TEST_F(ComediSourceTest, MeasuresWithTheCalibrationOfTheFile) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  const CalibrationFile file("preloaded-ai16");
  AdSettings settings = ComediSettings(served);
  settings.calibration_file = file.path();
  const auto card = Open(served, scenario, settings);
  const CalibrationPolynomial polynomial = card->Actual().calibration[1];
  EXPECT_EQ(polynomial.origin, 2.0) << "32770 in offset binary";
  EXPECT_EQ(polynomial.coefficients_V, (std::vector<double>{0.001, 0.000305, 1e-12}));
  const Acquisition block = card->Acquire(100, true);
  double sum_V = 0.0;
  for (std::size_t i = 1; i < block.raw.size(); i += 4) {
    const double code = block.raw[i] - 2.0;
    sum_V += 0.001 + 0.000305 * code + 1e-12 * code * code;
  }
  EXPECT_NEAR(block.channel[1].mean_V, sum_V / 100.0, 1e-13);
}

TEST_F(ComediSourceTest, RefusesACalibrationThatIsMissingOrOfAnotherBoard) {
  const Scenario scenario = test::RotaryScenario();
  HeldTwin served(scenario);
  AdSettings settings = ComediSettings(served);
  settings.calibration_file = "/nowhere/card.cal";
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "refused");
  const CalibrationFile file("another-board");
  settings.calibration_file = file.path();
  EXPECT_EQ(FaultIn([&] { Open(served, scenario, settings); }), "refused");
}

}  // namespace
}  // namespace twinbench::hw
