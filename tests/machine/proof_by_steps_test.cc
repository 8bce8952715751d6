#include "twin/benches/proof_by_steps.h"

#include <fmt/core.h>

#include "tests/machine/benches.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/troubled_bench.h"
#include "tools/twinbench/planned_run.h"
#include "tools/twinbench/real_bench.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

/// Instruments and tables that become others in the middle of a run, on twins that do not say that they are ones.
namespace twinbench::test {
namespace {

using Changes = std::function<void(Reading& shown, const Reading& before)>;

/// Shows something else from the n-th reading on, or with that one alone.
class ChangedInstruments : public PassingInstruments {
 public:
  ChangedInstruments(InstrumentSet& inner, int good, int bad, Changes changes)
      : PassingInstruments(inner), good_(good), bad_(bad), changes_(std::move(changes)) {}
  Reading Read() override {
    const Reading before = shown_;
    shown_ = inner_.Read();
    return With(shown_, before, read_++);
  }
  Reading Look() override { return With(inner_.Look(), shown_, read_ - 1); }

 private:
  Reading With(Reading shown, const Reading& before, int number) const {
    if (number >= good_ && number < good_ + bad_) changes_(shown, before);
    return shown;
  }

  int good_, bad_, read_ = 0;
  Changes changes_;
  Reading shown_;
};

using RunEnd = std::pair<std::string, std::size_t>;  // its fault, and how many readings were kept

void ExpectEnded(const RunEnd& run, std::size_t behind) {
  EXPECT_NE(run.first, "");
  EXPECT_EQ(run.second, behind);
}

/// Of a run whose readings are proved.
RunEnd EndOf(DrivenTwin& twin, MachineBench bench) {
  twin.options.prove = ProofBySteps(bench, twin.scenario, twin.options);
  const std::string fault = twin.FaultOn(bench);
  return {fault, twin.log.readings.size()};
}

RunEnd RunWith(const Scenario& scenario, int good, int bad, const Changes& changes) {
  DrivenTwin twin(scenario);
  ChangedInstruments instruments(twin.bench.instruments, good, bad, changes);
  return EndOf(twin, AsHardware(twin.bench, instruments));
}

double& In(Reading& reading, const Scenario& scenario, const std::string& column) {
  return std::ranges::find(FormatOf(scenario.bench).columns, column, &ReadingColumn::name)->number(reading);
}

TEST(ProofBySteps, InstrumentsWhoseSignsAxesOrUnitsChangeAreNoticedAtOnceWhereSizesAreKnownElseWithinTwoReadings) {
  constexpr int kForGood = 1000;
  constexpr std::size_t kUnsure = 2;  // readings that may pass where only the sign of what is shown is known
  struct Case {
    Scenario scenario;
    std::string x, y;
    bool is_of_size;
  };
  for (const auto& [scenario, x, y, is_of_size] : {Case{ShortTurntable(), "autocollimator_x_arcsec", "autocollimator_y_arcsec", true},
                                                   Case{ShortPolygon(), "autocollimator_x_arcsec", "autocollimator_y_arcsec", true},
                                                   Case{ShortFreeform(), "qpd_x_V", "qpd_y_V", false}}) {
    const auto value = [&, &s = scenario](Reading& r, const std::string& column) -> double& { return In(r, s, column); };
    EXPECT_EQ(RunWith(scenario, 0, 0, {}).first, "") << scenario.bench;
    std::vector<Changes> changes = {[&, &a = x](Reading& r, const Reading&) { value(r, a) = -value(r, a); },
                                    [&, &a = x, &b = y](Reading& r, const Reading&) { std::swap(value(r, a), value(r, b)); }};
    if (is_of_size) changes.push_back([&, &a = x](Reading& r, const Reading&) { value(r, a) *= 0.206; });
    for (const Changes& change : changes) {
      for (const std::size_t good : {0u, 5u, 14u}) {
        const auto [fault, kept] = RunWith(scenario, static_cast<int>(good), kForGood, change);
        EXPECT_EQ(fault, "moved") << scenario.bench << " " << good;
        EXPECT_LE(kept, good + (is_of_size ? 0 : kUnsure)) << scenario.bench;
        EXPECT_GE(kept, good) << scenario.bench;
      }
    }
  }
}

/// A machine whose controller says that it goes where it is told and that stands, or goes against it, from a reading on.
class LyingMachine : public PassingMachine {
 public:
  LyingMachine(MachineController& inner, const MemoryLog& log, std::size_t good, double share)
      : PassingMachine(inner), log_(log), good_(good), share_(share) {}
  void StartMove(const std::vector<double>& to, double feed_m_s) override {
    told_ = to;
    if (log_.readings.size() < good_) return inner_.StartMove(to, feed_m_s);
    std::vector<double> gone = to;
    const std::vector<AxisState> at = inner_.State();
    for (std::size_t k = 0; k < to.size(); ++k) gone[k] = at[k].encoder + share_ * (to[k] - at[k].encoder);
    inner_.StartMove(gone, feed_m_s);
  }
  void StartArc(const Arc& arc) override {
    told_.clear();
    inner_.StartArc(arc);
  }
  std::vector<AxisState> State() override {
    std::vector<AxisState> states = inner_.State();
    for (std::size_t k = 0; k < told_.size(); ++k) states[k].encoder = states[k].commanded = told_[k];
    return states;
  }

 private:
  const MemoryLog& log_;
  std::size_t good_;
  double share_;
  std::vector<double> told_;
};

TEST(ProofBySteps, AtStopsOnACircleBarAndGridGoWithAMachineThatGoesOffIt) {
  const Scenario scenario = ShortCircles();
  constexpr std::size_t kStops = 24;  // the first reading at rest, of the bar; the grid's are the last 8
  const auto end_of = [&](std::size_t good, double share, const Changes& changes) {
    DrivenTwin twin(scenario);
    LyingMachine machine(twin.bench.machine, twin.log, good, share);
    ChangedInstruments instruments(twin.bench.instruments, changes ? static_cast<int>(good) : 1000, 1000, changes);
    return EndOf(twin, AsHardware(twin.bench, machine, instruments));
  };
  EXPECT_EQ(end_of(1000, 1.0, {}).first, "");
  for (const double share : {0.0, -1.0, 1e-3})
    EXPECT_EQ(end_of(kStops + 3, share, {}), RunEnd("moved", kStops + 3)) << share;
  const auto value = [&](Reading& r, const char* column) -> double& { return In(r, scenario, column); };
  const std::pair<std::size_t, Changes> changes[] = {
      {0, [&](Reading& r, const Reading&) { value(r, "bar_um") = -value(r, "bar_um"); }},
      {0, [&](Reading& r, const Reading&) { value(r, "bar_um") *= 1e-3; }},
      {8, [&](Reading& r, const Reading&) { std::swap(value(r, "grid_x_mm"), value(r, "grid_y_mm")); }},
      {8, [&](Reading& r, const Reading&) { value(r, "grid_y_mm") = -value(r, "grid_y_mm"); }}};
  for (const auto& [from, change] : changes)  // from a reading at rest on
    EXPECT_EQ(end_of(from, 1.0, change), RunEnd("moved", from == 0 ? kStops : 2 * kStops + 8)) << from;
}

TEST(ProofBySteps, BehindASweepTheBarGoesWithTheMachineOrNothingOfItIsKept) {
  const Scenario scenario = ShortCircles();
  constexpr int kFromTheBegin = -1;  // before any reading at rest
  EXPECT_EQ(RunWith(scenario, 0, 0, {}).first, "");
  for (const double factor : {-1.0, 1e-3, 1.4}) {
    const Changes scaled = [&](Reading& r, const Reading&) { In(r, scenario, "bar_um") *= factor; };
    EXPECT_EQ(RunWith(scenario, kFromTheBegin, 1000, scaled), RunEnd("moved", 0)) << factor;
  }
}

TEST(ProofBySteps, OneLateAnswerOfBothEncodersCostsAnAttemptWhereNothingBeforeItIsOfItsMounting) {
  const Changes late = [](Reading& r, const Reading& before) {
    r.reference_rad = before.reference_rad, r.measured_rad = before.measured_rad;
  };
  DrivenTwin twin(ShortStops());
  ChangedInstruments instruments(twin.bench.instruments, 24, 1, late);
  EXPECT_EQ(EndOf(twin, AsHardware(twin.bench, instruments)).first, "");
  ASSERT_EQ(twin.log.attempts.size(), 1u);
  EXPECT_EQ(twin.log.attempts[0].reading, 24);
}

/// A table whose controller says that it goes where it is told and whose angles are others: it stands, or is mirrored.
class Lying : public RotaryTable {
 public:
  Lying(RotaryTable& inner, const int& blocks, int good, double share) : inner_(inner), blocks_(blocks), good_(good), share_(share) {}
  void StartMove(double angle_rad) override {
    if (blocks_ < good_) at_rad_ = angle_rad;
    told_rad_ = angle_rad;
    inner_.StartMove(at_rad_ + share_ * (angle_rad - at_rad_) * (blocks_ < good_ ? 0.0 : 1.0));
  }
  bool Settles(Duration within) override { return inner_.Settles(within); }
  TableState State() override {
    TableState state = inner_.State();
    if (!std::isnan(told_rad_)) state.encoder_rad = state.commanded_rad = told_rad_;
    return state;
  }
  void Stop() override { inner_.Stop(); }
  void Home() override { inner_.Home(); }

 private:
  RotaryTable& inner_;
  const int& blocks_;
  int good_;
  double share_, at_rad_ = 0.0, told_rad_ = kNaN;
};

using Blocks = std::array<ChannelBlock, kChannels>;
using ChangesVolts = std::function<void(Blocks& channel, const Blocks& before)>;

using ChangesAngles = std::function<AutocollimatorReading(AutocollimatorReading)>;

struct TableShares {
  double target = 1.0, reference = 1.0;
};

/// Tables, and channels and an autocollimator whose readings are others from the n-th block on.
RunEnd EndOfTables(int good, const ChangesVolts& changes, TableShares shares, const std::string& phase = "full_circle",
                   const ChangesAngles& changes_angles = {}) {
  Scenario scenario = RestlessBench();
  RotaryOf(scenario).procedure.phases = {phase};
  RotaryOf(scenario).procedure.stability_s = 60.0;
  sim::Twin twin(scenario);
  const RotaryBench inner = twin.Bench();
  int blocks = 0;
  Blocks last{};
  Lying target(inner.target, blocks, good, shares.target), reference(inner.reference, blocks, good, shares.reference);
  const auto change = [&](const std::string& device, const std::string&, CallAnswer& answer) {
    if (device == "autocollimator" && blocks >= good && changes_angles) {
      AutocollimatorReading shown;
      std::istringstream(answer.text) >> shown.yaw_rad >> shown.tilt_rad;
      shown = changes_angles(shown);
      answer.text = fmt::format("{} {}", shown.yaw_rad, shown.tilt_rad);
    }
    if (device != "adc") return;
    if (blocks++ < good)
      last = answer.block.channel;
    else if (changes)
      changes(answer.block.channel, last);
  };
  TroubledBench troubled({inner.clock, target, reference, inner.adc, inner.autocollimator, inner.thermometer,
                          inner.goniometer, inner.fixture},
                         {}, change);
  RotaryBench bench = troubled.Bench();
  MemoryLog log;
  procedure::Options options;
  options.log = &log;
  options.prove = ProofBySteps(bench, scenario, options);
  const auto kind = KindOf([&] { procedure::CarryOut(bench, scenario, log, {}, options); });
  return {kind ? FaultName(*kind) : "", log.readings.size()};
}

const std::vector<ChangesVolts>& WrongVolts() {
  static const std::vector<ChangesVolts> changes = {
      [](Blocks& c, const Blocks&) { for (ChannelBlock& one : c) one.mean_V *= 1e-3; },
      [](Blocks& c, const Blocks&) { for (ChannelBlock& one : c) one.mean_V = -one.mean_V; },
      [](Blocks& c, const Blocks&) { std::swap(c[0], c[1]); },
      [](Blocks& c, const Blocks& before) { c[2] = before[2]; }};
  return changes;
}

constexpr TableShares kWrongShares[] = {{0.0, 0.0}, {-1.0, -1.0}, {1e-3, 1e-3}};  // of one alone the spots leave the PSDs

TEST(ProofBySteps, TablesThatStandOrAreMirroredAndChannelsOfAnotherUnitOrOrderLeaveNoReading) {
  constexpr std::size_t kGood = 5;
  constexpr int kGoodBlocks = 3 * kGood;
  const std::pair<const char*, std::size_t> phases[] = {{"full_circle", 24}, {"calibration", 12}, {"verification", 7}};
  for (const auto& [phase, readings] : phases) {
    SCOPED_TRACE(phase);
    EXPECT_EQ(EndOfTables(1000, {}, {}, phase), RunEnd("", readings));
    for (const ChangesVolts& changes : WrongVolts()) ExpectEnded(EndOfTables(kGoodBlocks, changes, {}, phase), kGood);
    for (const TableShares shares : kWrongShares) ExpectEnded(EndOfTables(kGoodBlocks, {}, shares, phase), kGood);
  }
  const ChangesVolts stays_away = [](Blocks& c, const Blocks& before) { c = before; };  // as beside the reading
  ExpectEnded(EndOfTables(3 * kGood + 2, stays_away, {}), kGood);  // a zero that is set while the step is gone back
}

TEST(ProofBySteps, AnAutocollimatorWhoseSignsUnitsOrAxesChangeLeavesNoReadingOfACalibration) {
  constexpr std::size_t kGood = 5;
  const ChangesAngles changes[] = {[](AutocollimatorReading a) { return AutocollimatorReading{-a.yaw_rad, a.tilt_rad}; },
                                   [](AutocollimatorReading a) { return AutocollimatorReading{a.tilt_rad, a.yaw_rad}; },
                                   [](AutocollimatorReading a) { return AutocollimatorReading{0.206 * a.yaw_rad, 0.206 * a.tilt_rad}; }};
  for (const ChangesAngles& change : changes)  // it is read before the converter is
    ExpectEnded(EndOfTables(3 * kGood + 1, {}, {}, "calibration", change), kGood);
}

TEST(ProofBySteps, InAStabilityTestTablesGoAStepBeforeItsFirstReadingAndBehindItsLast) {
  EXPECT_EQ(EndOfTables(1000, {}, {}, "stability"), RunEnd("", 6));
  ExpectEnded(EndOfTables(0, {}, {0.0, 0.0}, "stability"), 0);
  ExpectEnded(EndOfTables(3 + 3, {}, {0.0, 0.0}, "stability"), 5);  // three blocks come before
}

TEST(ProofByClosing, AZeroThatJumpsBetweenTwoPassesEndsTheMountingOnEveryBench) {
  constexpr int kForGood = 1000;
  Scenario stops = ShortStops();
  EncoderOf(stops).device.noise_known = true, EncoderOf(stops).device.noise_rad = 1e-4 * units::deg;
  struct Case {
    Scenario scenario;
    std::string column;
    double jump;
    int turned;        // first reading of the pass back
    std::size_t last;  // of that pass
  };
  for (const auto& [scenario, column, jump, turned, last] :
       {Case{ShortTurntable(), "autocollimator_x_arcsec", 10.0 * units::arcsec, 5 + 6, 5 + 11},
        Case{ShortPolygon(), "autocollimator_x_arcsec", 10.0 * units::arcsec, 4, 7},
        Case{stops, "measured_deg", 0.02 * units::deg, 12, 23}}) {
    const Changes jumps = [&, &in = scenario, &name = column, &by = jump](Reading& r, const Reading&) { In(r, in, name) += by; };
    EXPECT_EQ(RunWith(scenario, 0, 0, {}).first, "") << scenario.bench;
    EXPECT_EQ(RunWith(scenario, turned, kForGood, jumps), RunEnd("changed", last)) << scenario.bench;
  }
  const ChangesVolts jumps = [](Blocks& c, const Blocks&) { c[0].mean_V += 0.5, c[2].mean_V += 0.5; };
  EXPECT_EQ(EndOfTables(3 * 6, jumps, {}), RunEnd("changed", 11));
}

/// As of an axis whose zero jumps while nobody looks.
TEST(ProofByClosing, AZeroOfAFiveAxisMachineThatJumpsIsNoticedBehindTheTenthPoseOfAMounting) {
  constexpr double kJump_V = 0.6;  // 20 um of X
  const Scenario scenario = ShortFreeform();
  const Changes jumps = [&](Reading& r, const Reading&) { In(r, scenario, "qpd_x_V") += kJump_V; };
  EXPECT_EQ(RunWith(scenario, 0, 0, {}).first, "");
  EXPECT_EQ(RunWith(scenario, 3, 1000, jumps), RunEnd("changed", 9));
}

/// By the bench's clock, of a run whose readings are proved, with hands that take as long as the scenario says.
double MinutesProved(const Scenario& scenario) {
  DrivenTwin twin(scenario);
  twin.options.prove = ProofBySteps(twin.bench, twin.scenario, twin.options);
  EXPECT_EQ(twin.Fault(), "");
  return ToSeconds(twin.bench.clock.Now()) / 60.0;
}

TEST(MinutesOnRealBench, AreThoseOfARunWhoseReadingsAreProved) {
  for (const Scenario& scenario : {ShortTurntable(), ShortPolygon(), ShortStops(), ShortFreeform()}) {
    const auto told = tools::MinutesOnRealBench(scenario);
    ASSERT_TRUE(told) << scenario.bench;
    EXPECT_NEAR(*told / MinutesProved(scenario), 1.0, 0.2) << scenario.bench;  // promised
  }
  EXPECT_GT(*tools::MinutesOnRealBench(ShortTurntable()), 1.05 * tools::OutlookAtOnce(ShortTurntable()).minutes);
}

}  // namespace
}  // namespace twinbench::test
