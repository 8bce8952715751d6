#include <gmock/gmock.h>

#include <thread>

#include "hw_bridge/control/esp_table.h"
#include "hw_bridge/control/scpi.h"
#include "hw_bridge/control/scpi_table.h"
#include "hw_bridge/control/served_clock.h"
#include "tests/hw_control/faults.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/served_twin.h"
#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

using test::KindOf, test::ServedTwin;

constexpr Duration kBeyondFaults = std::chrono::milliseconds(300);

/// The target of a served twin whose clock is held, and how to spoil it.
class FaultyTable {
 public:
  FaultyTable(const ServedTwin& served, const std::string& language)
      : clock_talk_(ParseAddress(served.ScpiAddress()).value(), kScpiIdentity, ""),
        talk_(ParseAddress(language == "scpi" ? served.ScpiAddress() : served.EspAddress()).value(),
              language == "scpi" ? kScpiIdentity : kEspIdentity, ""),
        clock_({clock_talk_, "clock", kBeyondFaults}) {
    clock_.Open();
    const DeviceLine line(talk_, "target", kBeyondFaults);
    if (language == "scpi")
      table_ = std::make_unique<ScpiTable>(line, 1, TableLimits{});
    else
      table_ = std::make_unique<EspTable>(line, 1, TableLimits{}, CommandNumbers{}, true);
  }

  RotaryTable& table() { return *table_; }
  ScpiClock& clock() { return clock_; }
  void Restart() { ScpiSimulation(clock_).Restart(); }
  void Inject(const std::string& kind) {
    DeviceLine line(clock_talk_, "simulation", kBeyondFaults);
    TellScpi(line, "SIM:FAUL target," + kind);
  }

 private:
  Dialogue clock_talk_, talk_;
  ScpiClock clock_;
  std::unique_ptr<ControlledTable> table_;
};

using Case = std::pair<std::string, FaultKind>;
using Spoilt = std::tuple<std::string, Case>;  // the language, what is wrong and as what it is told

class FaultOf : public testing::TestWithParam<Spoilt> {
 protected:
  const std::string language_ = std::get<0>(GetParam()), fault_ = std::get<1>(GetParam()).first;
  const FaultKind kind_ = std::get<1>(GetParam()).second;
};
INSTANTIATE_TEST_SUITE_P(
    Answers, FaultOf,
    testing::Combine(testing::Values("scpi", "esp"),
                     testing::Values(Case{"mute", FaultKind::kTimeout}, Case{"late", FaultKind::kTimeout},
                                     Case{"partial", FaultKind::kTimeout}, Case{"disconnect", FaultKind::kDropped},
                                     Case{"restart", FaultKind::kRestarted})),
    [](const auto& c) { return std::get<0>(c.param) + "_" + std::get<1>(c.param).first; });

TEST_P(FaultOf, AControllerEndsTheCallInItsNameAndTheNextCallsWork) {
  ServedTwin served(test::RotaryScenario());
  FaultyTable faulty(served, language_);
  faulty.table().StartMove(0.5);
  faulty.table().WaitSettled();
  faulty.Inject(fault_);
  EXPECT_EQ(KindOf([&] { faulty.table().StartMove(0.6); }), kind_);
  if (kind_ == FaultKind::kRestarted) {
    EXPECT_EQ(KindOf([&] { faulty.table().WaitSettled(); }), FaultKind::kRestarted);
    EXPECT_TRUE(std::isnan(faulty.table().EncoderAngle_rad()));
    faulty.table().Home();
  }
  faulty.table().StartMove(0.7);
  faulty.table().WaitSettled();
  EXPECT_EQ(faulty.table().State().encoder_rad, 0.7);  // the kinematic twin follows its command exactly
}

TEST_P(FaultOf, AControllerIsUndoneByStartingTheTwinAgain) {
  ServedTwin served(test::RotaryScenario());
  FaultyTable faulty(served, language_);
  const auto drive = [&faulty] {
    faulty.table().StartMove(0.3);
    faulty.table().WaitSettled();
    return std::pair{faulty.table().State().encoder_rad, faulty.clock().Now()};
  };
  faulty.Restart();
  const auto undisturbed = drive();
  faulty.Inject(fault_);
  EXPECT_EQ(KindOf([&] { faulty.table().StartMove(0.9); }), kind_);
  faulty.Restart();
  EXPECT_EQ(drive(), undisturbed);
}

TEST(ServedTables, RefuseWhatLiesBeyondTheControllersLimits) {
  for (const char* language : {"scpi", "esp"}) {
    ServedTwin served(test::RotaryScenario());
    FaultyTable faulty(served, language);
    EXPECT_EQ(KindOf([&] { faulty.table().StartMove(2e4); }), FaultKind::kLimit) << language;  // its own: 1e4 rad
    EXPECT_EQ(faulty.table().State().encoder_rad, 0.0) << language;
  }
}

/// How much bench time passes by itself in 20 ms.
Duration Drift(const ScpiClock& clock) {
  const Time before = clock.Now();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return clock.Now() - before;
}

TEST(ServedClock, IsHeldAgainWhereItsConnectionHadToBeOpenedAgain) {
  constexpr double kRealTime = 1.0;
  ServedTwin served(test::RotaryScenario(), kRealTime);
  Dialogue talk(ParseAddress(served.ScpiAddress()).value(), kScpiIdentity, "twinbench,");
  ScpiClock clock({talk, "clock", kBeyondFaults});
  EXPECT_EQ(Drift(clock), Duration(0));
  talk.Close();
  EXPECT_EQ(Drift(clock), Duration(0));
}

TEST(ServedClock, WaitsWhatItIsToldAndTakesNoRealTimeUnpaced) {
  constexpr double kRealTime = 1.0;
  ServedTwin served(test::RotaryScenario(), kRealTime);
  Dialogue talk(ParseAddress(served.ScpiAddress()).value(), kScpiIdentity, "twinbench,");
  ScpiClock clock({talk, "clock", kBeyondFaults});
  ScpiSimulation(clock).SetPaced(false);
  const Time before = clock.Now();
  clock.Wait(std::chrono::hours(10));  // far beyond what this test may take
  EXPECT_EQ(clock.Now() - before, std::chrono::hours(10));
  ScpiSimulation(clock).SetPaced(true);
  const auto begin = std::chrono::steady_clock::now();
  clock.Wait(std::chrono::milliseconds(50));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(50));
}

}  // namespace
}  // namespace twinbench::hw
