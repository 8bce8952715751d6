#include "hw_bridge/control/linuxcnc_machine.h"

#include "tests/hw_control/fake_controller.h"
#include "tests/support/faults.h"
#include "tests/support/kept_text.h"

namespace twinbench::hw {
namespace {

using test::FakeController, test::KindOf, test::TextWithoutAddress;
using testing::AllOf, testing::Contains, testing::HasSubstr;

/// A machine of X (joint 0) and C (joint 2), which stands at once where it is sent. What is asked for is answered
/// by `told`, and what it does with a block of a program is `obey`.
struct LinuxCncModel {
  std::mutex mutex;
  std::map<std::string, std::string> told = {
      {"machine", "ON"}, {"enable", "ON"}, {"estop", "OFF"}, {"mode", "MANUAL"}, {"program_status", "IDLE"},
      {"error", "OK"}, {"joint_homed", "YES NO YES"}, {"joint_limit", "OK OK OK"}, {"joint_fault", "OK OK OK"},
      {"joint_type", "LINEAR LINEAR ANGULAR"}, {"joint_units", "MM MM DEG"}, {"program_codes", "G0 F0 S0"},
      {"abs_cmd_pos", "0 0 0 0 0 0"}, {"abs_act_pos", "0 0 0 0 0 0"}};
  std::function<void(LinuxCncModel&, const std::string& block)> obey = [](LinuxCncModel&, const std::string&) {};
  bool accepts = true, greets = true;

  FakeController::Reply operator()(const std::string& line) {
    const std::lock_guard lock(mutex);
    if (!greets) return {};
    if (line.starts_with("hello "))
      return {line == "hello EMC twinbench 1.0" ? "HELLO ACK MILL 1.1\r\n" : "HELLO NAK\r\n"};
    if (line == "set echo off") return {line + "\r\n"};
    const std::string name = line.substr(4, line.find(' ', 4) - 4);
    std::string upper = name;
    for (char& c : upper) c = static_cast<char>(std::toupper(c));
    if (line.starts_with("get ")) return {upper + " " + told[name] + "\r\n"};
    const bool is_obeyed = accepts && told["enable"] == "ON";
    if (line == "set enable WRONG" || (name != "enable" && name != "verbose" && name != "set_wait" && !is_obeyed))
      return {"SET " + upper + " NAK\n\r"};
    if (name == "enable") told["enable"] = "ON";
    if (name == "mode") told["mode"] = line == "set mode mdi" ? "MDI" : "MANUAL";
    if (name == "home") told["joint_homed"] = "YES YES YES";
    if (name == "mdi") obey(*this, line.substr(8));
    return {"SET " + upper + " ACK\n\r"};
  }
  void StandAt(const std::string& places) { told["abs_cmd_pos"] = told["abs_act_pos"] = places; }
};

class OnLinuxCnc : public testing::Test {
 protected:
  LinuxCncMachine Machine(const std::string& enable_password = "EMCTOO") {
    dialogue_.Speak(WithAnyLineEnd());
    dialogue_.HearsGreetedOnly();
    const AxisLimits limits{.lower = -1.0, .upper = 1.0};
    return {DeviceLine(dialogue_, "machine", std::chrono::milliseconds(500)),
            {{"x", false}, {"table", true}},
            {limits, limits},
            {{'X', 0}, {'C', 2}},
            enable_password,
            {.traverse_m_s = 0.01, .numbers = {}}};
  }

  LinuxCncModel model_;
  FakeController controller_{[this](const std::string& line) { return model_(line); }};
  Dialogue dialogue_{ParseAddress(controller_.Address()).value(), LinuxCncHello("EMC"), kLinuxCncIdentity};
};

TEST_F(OnLinuxCnc, AMoveIsABlockInMachineCoordinatesWithoutExponents) {
  model_.obey = [](LinuxCncModel& model, const std::string&) { model.StandAt("0.012346 0 0 0 0 12.500000"); };
  LinuxCncMachine machine = Machine();
  machine.StartMove({1.23456e-5, 12.5 * units::deg}, 0.0);
  EXPECT_TRUE(machine.Settles(std::chrono::seconds(2)));
  EXPECT_THAT(controller_.Lines(), Contains("set mdi G90 G21 G94 G53 G1 F600.000000 X0.012345600 C12.500000000"));
  const std::vector<AxisState> states = machine.State();
  EXPECT_NEAR(states[0].encoder, 1.2346e-5, 1e-12);
  EXPECT_NEAR(states[1].encoder, 12.5 * units::deg, 1e-12) << "the sixth place is C's";
  EXPECT_TRUE(states[1].referenced) << "joint 1 is none of its axes";
}

TEST_F(OnLinuxCnc, LimitsAreReadAsAFeed) {
  model_.obey = [](LinuxCncModel& model, const std::string& block) {
    const double limit = block.find("AXIS_C") != std::string::npos ? 360.25 : -400.0;
    model.told["program_codes"] = fmt::format("G0 G17 F{:.0f} S0", (limit + 1e6) * 1e6);
  };
  const std::vector<AxisLimits> travel = Machine().Travel();
  EXPECT_NEAR(travel[0].lower, -0.4, 1e-12);
  EXPECT_NEAR(travel[1].upper, 360.25 * units::deg, 1e-12);
  EXPECT_THAT(controller_.Lines(), AllOf(Contains("set mdi G94 F[[#<_ini[AXIS_X]MIN_LIMIT>+1000000]*1000000]"),
                                         Contains("set mdi G94 F[[#<_ini[AXIS_C]MAX_LIMIT>+1000000]*1000000]")));
}

TEST_F(OnLinuxCnc, ABlockThatIsComplainedAboutAfterwardsHasNotBeenCarriedOut) {
  model_.obey = [](LinuxCncModel& model, const std::string&) {
    model.told["error"] = "Linear move on line 0 would exceed X's positive limit";
  };
  LinuxCncMachine machine = Machine();
  const auto move = [&] { machine.StartMove({0.5, 0.0}, 0.0), machine.Settles(std::chrono::seconds(2)); };
  EXPECT_EQ(KindOf(move), FaultKind::kLimit);
  model_.obey = [](LinuxCncModel& model, const std::string&) { model.told["error"] = "OK"; };
  EXPECT_KEPT(TextWithoutAddress(move));
  EXPECT_THAT(controller_.Lines(), Contains("set abort"));
}

TEST_F(OnLinuxCnc, AMoveThatGoesOnOrIsHeldIsNotDone) {
  LinuxCncMachine machine = Machine();
  model_.obey = [](LinuxCncModel& model, const std::string&) { model.told["program_status"] = "RUNNING"; };
  machine.StartMove({0.5, 0.0}, 0.0);
  EXPECT_FALSE(machine.Settles(std::chrono::milliseconds(100)));
  EXPECT_TRUE(machine.State()[0].moving);
}

TEST_F(OnLinuxCnc, WithoutItsOriginAnAxisStandsNowhereAndIsHomedInManualMode) {
  model_.told["joint_homed"] = "YES YES NO";
  LinuxCncMachine machine = Machine();
  EXPECT_TRUE(std::isnan(machine.State()[1].encoder));
  EXPECT_FALSE(std::isnan(machine.State()[0].encoder));
  EXPECT_EQ(KindOf([&] { machine.StartMove({0.0, 0.0}, 0.0); }), FaultKind::kRestarted);
  EXPECT_KEPT(TextWithoutAddress([&] { machine.Travel(); }));
  machine.Home();
  EXPECT_THAT(controller_.Lines(), AllOf(Contains("set mode manual"), Contains("set home -1")));
  EXPECT_TRUE(machine.State()[1].referenced);
}

TEST_F(OnLinuxCnc, NeitherEmergencyStopNorPowerAreSwitchedForAMove) {
  model_.told["estop"] = "ON";
  model_.told["machine"] = "OFF";
  LinuxCncMachine machine = Machine();
  EXPECT_KEPT(TextWithoutAddress([&] { machine.StartMove({0.0, 0.0}, 0.0); }));
  EXPECT_KEPT(TextWithoutAddress([&] { machine.Home(); }));
  EXPECT_KEPT(machine.State()[0].fault);
  model_.accepts = false;
  EXPECT_EQ(KindOf([&] { machine.Stop(); }), std::nullopt) << "it has been stopped";
  model_.told["machine"] = "ON";
  EXPECT_EQ(KindOf([&] { machine.Stop(); }), FaultKind::kRefused);
  EXPECT_THAT(controller_.Lines(), testing::Not(Contains(HasSubstr("set estop"))));
}

TEST_F(OnLinuxCnc, TheCommandIsTakenBackFromAnotherProgramToStopAMoveOnly) {
  LinuxCncMachine machine = Machine();
  machine.State();
  const auto times_taken = [&] { return std::ranges::count(controller_.Lines(), "set enable EMCTOO"); };
  ASSERT_EQ(times_taken(), 1);
  model_.told["enable"] = "OFF";
  EXPECT_KEPT(TextWithoutAddress([&] { machine.StartMove({0.0, 0.0}, 0.0); }));
  machine.Stop();
  EXPECT_EQ(times_taken(), 1) << "nothing moves, and whoever has it may be about to press the emergency stop";
  model_.told["program_status"] = "RUNNING";
  machine.Stop();
  EXPECT_EQ(times_taken(), 2);
  EXPECT_EQ(controller_.Lines().back(), "set abort");
}

TEST_F(OnLinuxCnc, AStopOnANewConnectionComesBeforeAnyLookAtItsAxes) {
  model_.told["joint_type"] = "LINEAR LINEAR LINEAR";  // another machine than the file's; it is stopped all the same
  Machine().Stop();
  EXPECT_EQ(controller_.Lines().back(), "set abort");
  EXPECT_THAT(controller_.Lines(), testing::Not(Contains(HasSubstr("joint"))));
}

TEST_F(OnLinuxCnc, AStopOnANewConnectionWaitsForNoAnswer) {
  model_.greets = false;
  EXPECT_EQ(KindOf([&] { Machine().Stop(); }), FaultKind::kTimeout);
  EXPECT_EQ(controller_.Lines(), (std::vector<std::string>{"hello EMC twinbench 1.0", "set enable EMCTOO", "set abort"}));
}

TEST_F(OnLinuxCnc, WhatItIsNotIsRefusedAtTheFirstCallAndSoAreCircles) {
  EXPECT_KEPT(TextWithoutAddress([&] { Machine().StartArc({}); }));
  EXPECT_KEPT(TextWithoutAddress([&] { Machine("WRONG").State(); }));
  model_.told["joint_units"] = "INCH MM DEG";
  EXPECT_KEPT(TextWithoutAddress([&] { Machine().State(); }));
  dialogue_.Close();
  Dialogue locked(ParseAddress(controller_.Address()).value(), LinuxCncHello("other"), kLinuxCncIdentity);
  EXPECT_EQ(KindOf([&] { locked.Open("machine", std::chrono::milliseconds(300)); }), FaultKind::kIdentity);
}

}  // namespace
}  // namespace twinbench::hw
