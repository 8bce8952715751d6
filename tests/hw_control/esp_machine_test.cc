#include "hw_bridge/control/esp_machine.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "hw_bridge/control/esp_words.h"
#include "tests/hw_control/fake_controller.h"
#include "tests/support/faults.h"

namespace twinbench::hw {
namespace {

using test::FakeController;
using testing::Contains, testing::HasSubstr;

/// A controller of X and Y in mm that understands so many decimals and, like the ESP301, knows no MS?.
struct EspGroupModel {
  std::mutex mutex;
  std::array<double, 2> at_mm{};
  std::array<bool, 2> motor_on = {true, true};
  int decimals = 4, error = 0, upper_mm = 100, fastest_mm_s = 0;  // 0: it knows no VU?
  std::string group;  // that somebody else has formed: "1,2"; it cannot be formed again

  /// Several questions stand on one line.
  FakeController::Reply operator()(const std::string& line) {
    const std::lock_guard lock(mutex);
    std::string answers;
    for (std::size_t from = 0; from <= line.size();) {
      const std::size_t end = std::min(line.find(';', from), line.size());
      if (const std::string answer = Answer(line.substr(from, end - from)); !answer.empty())
        answers += answer + "\r\n";
      from = end + 1;
    }
    return {answers};
  }

  std::string Answer(const std::string& command) {
    if (command == "VE?") return "ESP301 Version 3.0.1";
    if (command == "TB?") return fmt::format("{}, 100, text", std::exchange(error, 0));
    const std::size_t axis = command[0] == '2' ? 1 : 0;
    const std::string verb = command.substr(command.find_first_not_of("0123456789"));
    if (verb == "SN?") return "2";
    if (verb == "HN?") return group;
    if (verb == "MO?") return motor_on[axis] ? "1" : "0";
    if (verb == "MD?") return "1";
    if (verb == "PA?" || verb == "TP?") return fmt::format("{}", at_mm[axis]);
    if (verb == "SL?") return "-100";
    if (verb == "SR?") return std::to_string(upper_mm);
    if (verb == "VU?" && fastest_mm_s > 0) return std::to_string(fastest_mm_s);
    Obey(axis, verb);
    return "";
  }

  void Obey(std::size_t axis, const std::string& verb) {
    if (verb == "MO") motor_on[axis] = true;
    if (verb == "OR") at_mm = {0.0, 0.0};
    if (verb == "MS?") error = 6;
    if (verb.starts_with("HN") && !group.empty()) error = 16;
    if (!verb.starts_with("HL")) return;
    const std::string places = verb.substr(2);
    const auto comma = places.find(',');
    const double step_mm = std::pow(10.0, -decimals);
    at_mm = {ParseNumber(places.substr(0, comma)).value(), ParseNumber(places.substr(comma + 1)).value()};
    for (double& place_mm : at_mm) place_mm = std::trunc(place_mm / step_mm) * step_mm;
  }
};

class EspMachineWithoutStatus : public testing::Test {
 protected:
  EspMachine Machine(int decimals = -1) {
    return {DeviceLine(dialogue_, "machine", std::chrono::milliseconds(300)),
            {{"x"}, {"y"}},
            {AxisLimits{}, AxisLimits{}},
            {.traverse_m_s = 0.01, .numbers = {decimals}}};
  }
  /// Switched off and on: it counts from where it stands.
  void Restart() {
    const std::lock_guard lock(model_.mutex);
    model_.motor_on = {false, false};
    model_.at_mm = {0.0, 0.0};
  }

  EspGroupModel model_;
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
  EspMachine machine = Machine();
  EXPECT_EQ(test::KindOf([&] { machine.StartMove({0.01, 0.0}, 0.0); }), FaultKind::kRestarted);
}

TEST_F(EspMachineWithoutStatus, LimitsAndAGreatestSpeedThatSomebodyElseSetAreToldBeforeAnythingMoves) {
  model_.fastest_mm_s = 20;
  EspMachine machine = Machine();
  machine.AgreeOnLimits();
  machine.StartMove({0.01, 0.0}, 0.0);
  for (const auto& [upper_mm, fastest_mm_s] : {std::pair{1000, 20}, {50, 20}, {100, 40}}) {
    model_.upper_mm = upper_mm, model_.fastest_mm_s = fastest_mm_s;
    EXPECT_EQ(test::KindOf([&] { machine.StartMove({0.02, 0.0}, 0.0); }), FaultKind::kMoved);
    EXPECT_NEAR(machine.State()[0].encoder, 0.01, 1e-12);
  }
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

TEST_F(EspMachineWithoutStatus, NumbersHaveNoMoreDecimalsThanTheControllerUnderstands) {
  const std::vector<double> third_mm = {1e-2 / 3.0, 2e-2 / 3.0};
  EXPECT_EQ(test::KindOf([&] { Machine().StartMove(third_mm, 0.0); }), FaultKind::kRefused) << "it cut them off";
  Machine(4).StartMove(third_mm, 0.0);
  EXPECT_THAT(controller_.Lines(), Contains("1HL3.3333,6.6667"));
  EXPECT_THAT(controller_.Lines(), Contains("1HV10.0000"));
}

}  // namespace
}  // namespace twinbench::hw
