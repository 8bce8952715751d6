#include "hw_bridge/control/esp_machine.h"

#include "hw_bridge/control/esp_words.h"
#include "tests/hw_control/esp_model.h"
#include "tests/support/faults.h"

namespace twinbench::hw {
namespace {

using test::EspModel, test::FakeController;
using testing::Contains, testing::HasSubstr;

class EspMachineWithoutStatus : public testing::Test {
 protected:
  EspMachine Machine(int decimals = -1, const std::function<bool()>& stop_asked = {}) {
    DeviceLine line(dialogue_, "machine", std::chrono::milliseconds(300));
    line.HearStop(stop_asked);
    return {line,
            {{"x"}, {"y"}},
            {AxisLimits{}, AxisLimits{}},
            {.traverse_m_s = 0.01, .numbers = {decimals}}};
  }
  /// Switched off and on: it counts from where it stands.
  void Restart() {
    model_.Become([](EspModel& m) { m.axis[1] = m.axis[2] = {.motor_on = false}; });
  }

  EspModel model_{.unit = 2};  // X and Y in mm
  FakeController controller_{[this](const std::string& line) { return model_(line); }};
  Dialogue dialogue_{ParseAddress(controller_.Address()).value(), kEspIdentity, "ESP301"};
};

TEST_F(EspMachineWithoutStatus, ARestartIsToldByMotorsThatAreOffUntilItIsHomed) {
  EspMachine machine = Machine();
  machine.AgreeOnLimits();
  machine.StartMove({0.0125, -0.025}, 0.0);
  EXPECT_NEAR(machine.State()[1].encoder, -0.025, 1e-12);
  Restart();
  for (const AxisState& axis : machine.State()) {
    EXPECT_FALSE(axis.referenced);
    EXPECT_TRUE(std::isnan(axis.encoder)) << "0 would be a place like another";
  }
  EXPECT_EQ(test::KindOf([&] { machine.StartMove({0.01, 0.0}, 0.0); }), FaultKind::kRestarted);
  machine.Home();
  EXPECT_TRUE(machine.State()[0].referenced);
  machine.StartMove({0.01, 0.0}, 0.0);
  EXPECT_NEAR(machine.State()[0].encoder, 0.01, 1e-12);
}

TEST_F(EspMachineWithoutStatus, AnAxisWhoseMotorIsOffAtTheStartHasNoOrigin) {
  Restart();
  EXPECT_EQ(test::KindOf([this] { Machine().StartMove({0.01, 0.0}, 0.0); }), FaultKind::kRestarted);
}

TEST_F(EspMachineWithoutStatus, LimitsUnitsAndAGreatestSpeedThatSomebodyElseSetAreToldBeforeAnythingMoves) {
  model_.fastest = 20;
  EspMachine machine = Machine();
  machine.AgreeOnLimits();
  machine.StartMove({0.01, 0.0}, 0.0);
  for (const auto& [upper_mm, fastest_mm_s] : {std::pair{1000, 20}, {50, 20}, {200, 40}}) {
    model_.axis[1].upper = upper_mm, model_.fastest = fastest_mm_s;
    EXPECT_EQ(test::KindOf([&] { machine.StartMove({0.02, 0.0}, 0.0); }), FaultKind::kMoved);
    EXPECT_NEAR(machine.State()[0].encoder, 0.01, 1e-12);
  }
  model_.axis[1].upper = 200, model_.fastest = 20, model_.unit = 3;
  EXPECT_EQ(test::KindOf([&] { machine.StartMove({0.02, 0.0}, 0.0); }), FaultKind::kMoved);
}

TEST_F(EspMachineWithoutStatus, AGroupThatIsThereAlreadyIsOursIfItIsOfOurAxes) {
  model_.group = "1, 2";
  EXPECT_NO_THROW(Machine().State());
  model_.group = "2,3";
  EXPECT_EQ(test::KindOf([&] { Machine().State(); }), FaultKind::kRefused);
}

TEST_F(EspMachineWithoutStatus, AStopIsSaidBeforeAnythingElseWheneverTheConnectionIsNew) {
  model_.group = "2,3";  // nothing but a stop is taken by it
  EspMachine machine = Machine();
  machine.Stop();
  EXPECT_EQ(controller_.Lines().front(), "ST");
  dialogue_.Close();
  const std::size_t said = controller_.Lines().size();
  machine.Stop();
  EXPECT_EQ(controller_.Lines()[said], "ST");
  EXPECT_THAT(controller_.Lines(), testing::Not(Contains(HasSubstr("HN"))));
}

TEST_F(EspMachineWithoutStatus, NothingIsBegunBehindTheOperatorsStopHoweverSlowlyItAnswers) {
  const auto is_looked_at = [&] { return std::ranges::any_of(controller_.Lines(), [](const std::string& line) { return line.find("TP?") != std::string::npos; }); };
  EspMachine machine = Machine(-1, is_looked_at);
  machine.Stop();  // for another reason
  EXPECT_EQ(test::KindOf([&] { machine.StartMove({1e-3, 1e-3}, 0.0); }), FaultKind::kStopped);
  EXPECT_THAT(controller_.Lines(), testing::Not(Contains(HasSubstr("HL"))));
  const auto said = std::ranges::count(controller_.Lines(), "ST");
  machine.Stop();
  EXPECT_GT(std::ranges::count(controller_.Lines(), "ST"), said);
  EXPECT_NO_THROW(machine.State()) << "what is asked behind the stop is for its end";
}

TEST(DeviceLineThatHearsStop, WaitsNoLongerForAnyLineOfAnAnswer) {
  FakeController silent([](const std::string& line) -> FakeController::Reply { return {line == "TWO?" ? "1\r\n" : ""}; });
  Dialogue dialogue(ParseAddress(silent.Address()).value(), "", "");
  for (const bool is_second : {false, true}) {
    DeviceLine line(dialogue, "machine", std::chrono::seconds(30));
    if (is_second) line.Ask("TWO?");
    int asked = 0;
    line.HearStop([&] { return asked++ > 0; });  // once it waits
    EXPECT_EQ(test::KindOf([&] { is_second ? line.NextLine() : line.Ask("ONE?"); }), FaultKind::kStopped);
  }
}

TEST_F(EspMachineWithoutStatus, NumbersHaveNoMoreDecimalsThanTheControllerUnderstands) {
  const std::vector<double> third_mm = {1e-2 / 3.0, 2e-2 / 3.0};
  EXPECT_EQ(test::KindOf([&] { Machine().StartMove(third_mm, 0.0); }), FaultKind::kRefused) << "it cut them off";
  Machine(4).StartMove(third_mm, 0.0);
  EXPECT_THAT(controller_.Lines(), Contains("1HL3.3333,6.6667"));
  EXPECT_THAT(controller_.Lines(), Contains("1HV10.0000"));
}

}  // namespace
}  // namespace twinbench::hw
