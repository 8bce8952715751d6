#include "hw_bridge/control/esp_table.h"
#include "hw_bridge/control/scpi.h"
#include "hw_bridge/control/scpi_table.h"
#include "tests/hw_control/esp_model.h"
#include "tests/support/faults.h"

namespace twinbench::hw {
namespace {

using test::AxisModel, test::EspModel, test::FakeController, test::KindOf, test::TextOf;
using testing::Contains, testing::HasSubstr, testing::Not, testing::StartsWith;
using Reply = FakeController::Reply;

constexpr Duration kTimeout = std::chrono::milliseconds(300);
constexpr Duration kSecond = std::chrono::seconds(1);

/// A SCPI controller of two axes that can be spoiled. One thread answers, another asks: hence the lock.
struct ScpiModel {
  std::mutex mutex;
  std::map<int, AxisModel> axis;
  double resolution_deg = 0.0;  // of what it understands; 0: all
  std::string move_error = "0,\"No error\"";
  bool restarts_at_move = false;
  std::string error = "0,\"No error\"";

  Reply operator()(const std::string& line) {
    const std::lock_guard lock(mutex);
    if (line == "*IDN?") return {"maker,two-axes,7,1.0\n"};
    if (line == "SYST:ERR?") return {std::exchange(error, "0,\"No error\"") + "\n"};
    AxisModel& a = axis[line[3] - '0'];
    const std::string verb = line.substr(5);
    if (verb.starts_with("ANGL ")) Move(a, verb.substr(5));
    if (verb == "HOME") a = AxisModel{};
    if (verb == "STAT?")
      return {fmt::format("{},{},0,1,{:d},0,\"\"\n", a.commanded, a.encoder, a.referenced)};
    if (verb.starts_with("SETT?")) return {"1\n"};
    if (verb == "LIM:LOW?") return {fmt::format("{}\n", a.lower)};
    if (verb == "LIM:UPP?") return {fmt::format("{}\n", a.upper)};
    return {};
  }

  void Move(AxisModel& a, const std::string& text) {
    error = move_error;
    if (!error.starts_with("0,")) return;
    if (restarts_at_move) a = AxisModel{.referenced = false};
    const double to_deg = ParseNumber(text).value();
    a.Go(resolution_deg > 0.0 ? std::trunc(to_deg / resolution_deg) * resolution_deg : to_deg);
  }
};

class ScpiTables : public testing::Test {
 protected:
  ScpiTable Table(int axis, const TableLimits& limits = {}, CommandNumbers numbers = {}) {
    return {DeviceLine(dialogue_, axis == 1 ? "target" : "reference", kTimeout), axis, limits, numbers};
  }
  ScpiModel model_;
  FakeController controller_{[this](const std::string& line) { return model_(line); }};
  Dialogue dialogue_{ParseAddress(controller_.Address()).value(), kScpiIdentity, "maker"};
};

TEST_F(ScpiTables, ASoftLimitRefusesBeforeAnythingIsSent) {
  ScpiTable table = Table(1, {.lower_rad = -1.0, .upper_rad = 1.0});
  for (const double beyond_rad : {1.0000001, -1.0000001, kNaN})
    EXPECT_EQ(KindOf([&] { table.StartMove(beyond_rad); }), FaultKind::kLimit);
  EXPECT_EQ(controller_.Connections(), 0);
  table.StartMove(1.0);  // the limit itself is allowed
  EXPECT_THAT(controller_.Lines(), Contains(StartsWith("ROT1:ANGL ")));
}

TEST_F(ScpiTables, TheControllersOwnLimitsHoldWhereTheFileGivesNoneAndItMayNotAllowMore) {
  ScpiTable none = Table(1), narrower = Table(1, {.lower_rad = -3.0, .upper_rad = 3.0});
  ScpiTable wider = Table(1, {.lower_rad = -3.0, .upper_rad = 201.0 * units::deg});
  none.AgreeOnLimits();
  EXPECT_EQ(KindOf([&] { none.StartMove(200.1 * units::deg); }), FaultKind::kLimit);
  EXPECT_THAT(controller_.Lines(), Not(Contains(HasSubstr("ANGL"))));
  EXPECT_EQ(KindOf([&] { wider.AgreeOnLimits(); }), FaultKind::kRefused);
  EXPECT_EQ(KindOf([&] { narrower.AgreeOnLimits(); }), std::nullopt);
}

TEST_F(ScpiTables, LimitsThatSomebodyElseSetAreToldBeforeAnythingMoves) {
  ScpiTable table = Table(1);
  table.AgreeOnLimits();
  table.StartMove(0.5);
  model_.axis[1].upper += 1.0;
  EXPECT_EQ(test::KindOf([&] { table.StartMove(0.25); }), FaultKind::kMoved);
  EXPECT_NEAR(table.State().encoder_rad, 0.5, 1e-15);
}

// PyMeasure sends 30.123456 deg as 30.1235; a controller that drops digits does the same.
TEST_F(ScpiTables, AControllerThatUnderstoodAnotherAngleIsStoppedAndTheDifferenceToldUnlessItsDecimalsAreKnown) {
  model_.resolution_deg = 1e-4;
  ScpiTable table = Table(1);
  const auto move = [&] { table.StartMove(30.123456 * units::deg); };
  EXPECT_EQ(KindOf(move), FaultKind::kRefused);
  EXPECT_THAT(TextOf(move), HasSubstr("0.2016 arcsec off"));  // 0.000056 deg
  EXPECT_THAT(controller_.Lines(), Contains("ROT1:STOP"));
  ScpiTable informed = Table(1, {}, {4});
  informed.StartMove(30.123456 * units::deg);
  EXPECT_THAT(controller_.Lines(), Contains("ROT1:ANGL 30.1235"));
  EXPECT_NEAR(informed.State().commanded_rad, 30.1235 * units::deg, 1e-15);
}

TEST_F(ScpiTables, ARefusalOfTheControllerIsTold) {
  ScpiTable table = Table(1);
  model_.move_error = "-222,\"Data out of range\"";
  EXPECT_EQ(KindOf([&] { table.StartMove(0.1); }), FaultKind::kLimit);
  model_.move_error = "-113,\"Undefined header\"";
  EXPECT_EQ(KindOf([&] { table.StartMove(0.1); }), FaultKind::kRefused);
  EXPECT_THAT(TextOf([&] { table.StartMove(0.1); }), HasSubstr("Undefined header"));
}

TEST_F(ScpiTables, AControllerWithoutOriginGivesNoAnglesAndIsNotMoved) {
  model_.axis[1] = {.referenced = false};
  ScpiTable table = Table(1);
  EXPECT_FALSE(table.State().referenced);
  EXPECT_TRUE(std::isnan(table.EncoderAngle_rad()));
  EXPECT_EQ(KindOf([&] { table.StartMove(0.1); }), FaultKind::kRestarted);
  EXPECT_EQ(KindOf([&] { table.Settles(kSecond); }), FaultKind::kRestarted);
  EXPECT_THAT(controller_.Lines(), Not(Contains(HasSubstr("ANGL"))));
  table.Home();
  EXPECT_EQ(KindOf([&] { table.StartMove(0.1); }), std::nullopt);
}

TEST_F(ScpiTables, AControllerThatRestartsAsTheMoveBeginsIsStopped) {
  model_.restarts_at_move = true;
  ScpiTable table = Table(1);
  EXPECT_EQ(KindOf([&] { table.StartMove(0.1); }), FaultKind::kRestarted);
  EXPECT_THAT(controller_.Lines(), Contains("ROT1:STOP"));
}

TEST(ScpiAnswers, AreReadWithTheQuotesAndCommasOfAFaultAndRefusedIfAnythingIsMissingOrStrange) {
  const auto state = ParseScpiState("180,90,1,0,1,-1,\"following error, axis 1\"");
  ASSERT_TRUE(state);
  EXPECT_DOUBLE_EQ(state->commanded_rad, units::kPi);
  EXPECT_DOUBLE_EQ(state->encoder_rad, units::kPi / 2);
  EXPECT_TRUE(state->moving && !state->in_position && state->referenced);
  EXPECT_EQ(state->limit, -1);
  EXPECT_EQ(state->fault, "following error, axis 1");
  for (const char* text :
       {"", "1", "1,1,0,1,1,0", "1,1,0,1,1,0,\"", "1,1,0,1,1,0,\"\",1", "1,,0,1,1,0,\"\"", "1x,1,0,1,1,0,\"\"",
        "1,1,2,1,1,0,\"\"", "1,1,0,-1,1,0,\"\"", "1,1,0,1,1,2,\"\"", "1,1,0,1,1,0.5,\"\""})
    EXPECT_FALSE(ParseScpiState(text)) << text;
  EXPECT_TRUE(std::isnan(ParseScpiNumber("9.91E37", units::arcsec).value()));
  EXPECT_DOUBLE_EQ(ParseScpiNumber("3600", units::arcsec).value(), units::deg);
  EXPECT_FALSE(ParseScpiNumber("nan", 1.0));
}

class EspTables : public testing::Test {
 protected:
  EspTable Table(int axis, bool polls_pass_time = false) {
    return {DeviceLine(dialogue_, axis == 1 ? "target" : "reference", kTimeout), axis, TableLimits{},
            CommandNumbers{}, polls_pass_time};
  }
  long Polls() const {
    const auto lines = controller_.Lines();
    return std::count(lines.begin(), lines.end(), "1MD?");
  }
  EspModel model_;
  FakeController controller_{[this](const std::string& line) { return model_(line); }};
  Dialogue dialogue_{ParseAddress(controller_.Address()).value(), kEspIdentity, "ESP301"};
};

TEST_F(EspTables, AnAxisIsDrivenInDegrees) {
  model_.unit = 9;  // radian
  EspTable table = Table(1);
  table.StartMove(30.0 * units::deg);
  EXPECT_THAT(controller_.Lines(), testing::IsSupersetOf({"1SN7", "1PA30"}));
}

TEST_F(EspTables, AMotorThatGoesOffWithoutMsQueryMeansThatTheOriginIsLost) {
  EspTable table = Table(1);
  table.StartMove(0.1);
  model_.Become([](EspModel& m) { m.axis[1] = {.motor_on = false}; });  // switched off and on
  EXPECT_FALSE(table.State().referenced);
  EXPECT_TRUE(std::isnan(table.EncoderAngle_rad()));
  EXPECT_EQ(KindOf([&] { table.StartMove(0.1); }), FaultKind::kRestarted);
  table.Home();
  EXPECT_EQ(KindOf([&] { table.StartMove(0.1); }), std::nullopt);
}

TEST_F(EspTables, AControllerWithMsQueryTellsOfItsOriginItself) {
  model_.knows_status = true;
  model_.axis[1] = {.referenced = false, .motor_on = false};
  EspTable table = Table(1);
  EXPECT_FALSE(table.State().referenced);
  EXPECT_EQ(KindOf([&] { table.StartMove(0.1); }), FaultKind::kRestarted);
}

TEST_F(EspTables, OfMsQueryTheLimitSwitchHasItsSide) {
  model_.knows_status = true;
  EspTable table = Table(1);
  for (const auto& [switches, side] : {std::pair{0, 0}, std::pair{2, -1}, std::pair{4, 1}}) {
    model_.Become([&, at = switches](EspModel& m) { m.switches = at; });
    EXPECT_EQ(table.State().limit, side);
  }
}

TEST_F(EspTables, LimitsUnitsAndAGreatestSpeedThatSomebodyElseSetAreToldBeforeAnythingMoves) {
  for (const int fastest_deg_s : {0, 40, 80}) {
    model_.fastest = fastest_deg_s;
    EspTable table = Table(1);
    table.AgreeOnLimits();
    table.StartMove(0.5);
    if (fastest_deg_s == 40) model_.fastest *= 2;
    if (fastest_deg_s == 80) model_.unit = 10;
    if (fastest_deg_s == 0) model_.axis[1].upper += 1.0;
    EXPECT_EQ(KindOf([&] { table.StartMove(0.25); }), FaultKind::kMoved);
    EXPECT_NEAR(table.State().encoder_rad, 0.5, 1e-9);
  }
}

TEST_F(EspTables, ErrorsOfTheAxisAreTold) {
  EspTable table = Table(1);
  table.StartMove(0.0);
  for (const auto& [error, kind] : {std::pair{104, FaultKind::kLimit}, std::pair{207, FaultKind::kLimit},
                                    std::pair{113, FaultKind::kRefused}, std::pair{6, FaultKind::kRefused}}) {
    model_.Become([to = error](EspModel& m) { m.error = to; });
    EXPECT_EQ(KindOf([&] { table.StartMove(0.0); }), kind) << error;
  }
}

TEST_F(EspTables, WithAHeldClockSoManyPollsAreMadeAsPassTheTime) {
  EspTable table = Table(1, true);
  table.StartMove(0.1);
  model_.polls_until_done = 1000;
  EXPECT_FALSE(table.Settles(kSecond));
  EXPECT_EQ(Polls(), 20);  // of 50 ms each
  EXPECT_FALSE(table.Settles(Duration(0)));
  EXPECT_EQ(Polls(), 21);  // one look at least
}

TEST_F(EspTables, WithARunningClockItIsPolledForSoLong) {
  EspTable table = Table(1);
  table.StartMove(0.1);
  model_.polls_until_done = 1'000'000;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(table.Settles(std::chrono::milliseconds(200)));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(200));
  model_.polls_until_done = 3;
  EXPECT_TRUE(table.Settles(std::chrono::seconds(20)));
}

}  // namespace
}  // namespace twinbench::hw
