#include "tests/machine/benches.h"
#include "tests/support/troubled_bench.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/procedure/doubted_instruments.h"

/// Somebody else - a pendant, another program - stops or moves the machine in the middle of a run. The twin does not say that it is
/// one, so that what is kept is what was taken.
namespace twinbench::test {
namespace {

constexpr double kFarAway = 1e-3;  // m or rad: what a hand moves
constexpr double kAtItsStop = 1e-6;

enum class Hand { kStops, kJogs };

void Act(Hand hand, MachineController& machine) {
  if (hand == Hand::kStops) return machine.Stop();
  std::vector<double> to;
  for (const AxisState& state : machine.State()) to.push_back(state.encoder);
  to.back() += kFarAway;
  machine.StartMove(to, 0.0);
}

/// A run in which a hand acts before the machine is asked for the n-th time; never: 0.
struct HandledRun {
  HandledRun(const Scenario& scenario, Hand hand, int at_call)
      : twin(scenario),
        troubled(AsHardware(twin.bench), InstrumentColumns(FormatOf(scenario.bench).columns),
                 [=, this](const std::string& device, const std::string& request, std::string&) {
                   if (device == "machine" && request != "stop" && ++calls == at_call) Act(hand, twin.bench.machine);
                 }) {
    fault = twin.FaultOn(troubled.Bench());
  }

  DrivenTwin twin;
  TroubledMachine troubled;
  int calls = 0;
  std::string fault;
};

/// Where axes stood about readings at rest, as files have it.
std::map<std::string, double> Places(const Reading& reading) {
  std::map<std::string, double> places;
  for (const auto& [column, text] : reading.extra) places[column] = std::stod(text);
  return places;
}

class SomebodyElse : public testing::TestWithParam<Scenario (*)()> {};

TEST_P(SomebodyElse, WhoStopsOrMovesAnAxisCostsAnAttemptAndLeavesNoReadingAtAWrongPlace) {
  constexpr int kMoments = 12;
  const HandledRun undisturbed(GetParam()(), Hand::kStops, 0);
  ASSERT_EQ(undisturbed.fault, "") << undisturbed.twin.said;
  const std::vector<Reading>& expected = undisturbed.twin.log.readings;
  for (const Hand hand : {Hand::kStops, Hand::kJogs}) {
    int noticed = 0;
    for (int moment = 1; moment <= kMoments; ++moment) {
      const int at_call = undisturbed.calls * moment / (kMoments + 1) + moment % 5;  // before, in and behind moves, and about readings
      const HandledRun run(GetParam()(), hand, at_call);
      noticed += !run.twin.log.attempts.empty();
      const std::vector<Reading>& kept = run.twin.log.readings;
      if (run.fault.empty()) {
        EXPECT_EQ(kept.size(), expected.size());
      }
      for (std::size_t k = 0; k < kept.size(); ++k) {
        const auto places = Places(kept[k]), meant = Places(expected[k]);
        ASSERT_EQ(places.size(), meant.size()) << k;
        for (const auto& [column, place] : meant)
          EXPECT_NEAR(places.at(column), place, kAtItsStop / units::mm) << column << " of reading " << k << ", call " << at_call;
      }
    }
    if (hand == Hand::kJogs) {
      EXPECT_GE(noticed, kMoments / 2);  // a jog before a move that goes elsewhere anyway changes nothing
    }
  }
}

/// The call that begins a circle, with its feed times `factor`; others as they are.
std::string Overridden(const std::string& request, double factor) {
  if (!request.starts_with("arc ")) return request;
  constexpr int kFeed = 6;
  std::istringstream words(request);
  std::string changed, word;
  for (int k = 0; words >> word; ++k) changed += (k > 0 ? " " : "") + (k == kFeed ? std::to_string(factor * std::stod(word)) : word);
  return changed;
}

TEST(SomebodyElse, WhoTurnsTheFeedOverrideEndsACircle) {
  for (const auto& [factor, fault] : {std::pair(1.0, ""), {0.5, "following"}, {1.5, "following"}}) {
    DrivenTwin twin(ShortCircles());
    MachineBench inner = AsHardware(twin.bench);
    const std::vector<ReadingColumn> shown = InstrumentColumns(FormatOf(twin.scenario.bench).columns);
    AskedMachine overridden(
        [&, factor = factor](const std::string& device, const std::string& request) { return Perform(inner, shown, device, Overridden(request, factor)); },
        [&] { return inner.clock.Now(); }, {inner.machine.Axes(), shown, false, nullptr});
    EXPECT_EQ(twin.FaultOn(overridden.Bench()), fault) << factor << twin.said;
  }
}

/// A controller whose zero is set anew where the machine stands, as it is looked at for the n-th time: to itself all is in order.
class Rezeroed : public PassingMachine {
 public:
  Rezeroed(MachineController& inner, int at_call) : PassingMachine(inner), at_call_(at_call), zero_(inner.Axes().size(), 0.0) {}
  void StartMove(const std::vector<double>& to, double feed_m_s) override {
    std::vector<double> really = to;
    for (std::size_t k = 0; k < to.size(); ++k) really[k] += zero_[k];
    inner_.StartMove(really, feed_m_s);
  }
  std::vector<AxisState> State() override {
    std::vector<AxisState> states = inner_.State();
    if (++calls_ == at_call_)
      for (std::size_t k = 0; k < states.size(); ++k) zero_[k] = states[k].encoder;
    for (std::size_t k = 0; k < states.size(); ++k) states[k].commanded -= zero_[k], states[k].encoder -= zero_[k];
    return states;
  }

 private:
  int at_call_, calls_ = 0;
  std::vector<double> zero_;
};

/// Creeps off its circle behind the first, as its encoders say, until it is sent somewhere.
class Creeping : public PassingMachine {
 public:
  Creeping(MachineController& inner, double by_m) : PassingMachine(inner), by_m_(by_m) {}
  void StartArc(const Arc& arc) override { inner_.StartArc(arc), ++arcs_; }
  void StartMove(const std::vector<double>& to, double feed_m_s) override { inner_.StartMove(to, feed_m_s), moves += arcs_ > 0; }
  std::vector<AxisState> State() override {
    std::vector<AxisState> states = inner_.State();
    if (arcs_ > 0 && moves == 0)
      for (AxisState& state : states) state.encoder += by_m_;
    return states;
  }
  int moves = 0;

 private:
  double by_m_;
  int arcs_ = 0;
};

TEST(SomebodyElse, WhoLetsAMachineCreepOffItsCircleDoesNotMakeTheNextOneSmaller) {
  const auto moves_where_it_creeps = [](double by_m) {
    DrivenTwin twin(ShortCircles());
    Creeping machine(twin.bench.machine, by_m);
    EXPECT_EQ(twin.FaultOn(AsHardware(twin.bench, machine, twin.bench.instruments)), "") << twin.said;
    return machine.moves;
  };
  EXPECT_EQ(moves_where_it_creeps(5e-6), moves_where_it_creeps(0.0) + 1);
}

/// Instruments that show what they are said to, of a noise that nobody need state here.
void DoubtOn(procedure::MachineOptions& options, const Scenario& scenario) {
  std::vector<procedure::ClaimedColumn> claims;
  for (const ReadingColumn& column : FormatOf(scenario.bench).columns)
    if (column.role == ColumnRole::kShown) claims.push_back({column, column.name.ends_with("arcsec") ? 5.0 * units::arcsec : 0.05});
  options.require_as_before = [=](const Reading& again, const Reading& before) { procedure::RequireAsBefore(claims, again, before); };
}

TEST(SomebodyElse, WhoSetsTheZeroAnewEndsTheRunBeforeAReadingIsKeptElsewhere) {
  for (Scenario (*make)() : {ShortFreeform, ShortTurntable}) {
    DrivenTwin undisturbed(make());
    ASSERT_EQ(undisturbed.FaultOn(AsHardware(undisturbed.bench)), "");
    for (const int at_call : {60, 71, 82, 93}) {
      DrivenTwin twin(make());
      DoubtOn(twin.options, twin.scenario);
      Rezeroed machine(twin.bench.machine, at_call);
      const std::string fault = twin.FaultOn(AsHardware(twin.bench, machine, twin.bench.instruments));
      EXPECT_TRUE(fault == "implausible" || fault == "moved") << fault << ": " << twin.said;
      EXPECT_LT(twin.log.readings.size(), undisturbed.log.readings.size());
      for (std::size_t k = 0; k < twin.log.readings.size(); ++k)
        EXPECT_NO_THROW(twin.options.require_as_before(twin.log.readings[k], undisturbed.log.readings[k])) << k;
    }
  }
}

/// Shows nothing from the n-th reading on.
class Blind : public PassingInstruments {
 public:
  Blind(InstrumentSet& inner, int sees) : PassingInstruments(inner), sees_(sees) {}
  Reading Read() override {
    const Reading shown = inner_.Read();
    if (sees_-- > 0) return shown;
    Reading nothing;
    nothing.time = shown.time;
    return nothing;
  }

 private:
  int sees_;
};

TEST(SomebodyElse, WhoTakesTheMirrorAwayLeavesNoEmptyReading) {
  for (Scenario (*make)() : {ShortFreeform, ShortTurntable, ShortStops}) {
    DrivenTwin twin(make());
    Blind instruments(twin.bench.instruments, 4);
    EXPECT_EQ(twin.FaultOn(AsHardware(twin.bench, instruments)), "gap") << twin.said;
    EXPECT_EQ(twin.log.readings.size(), 4u);
  }
}

/// A counter that hands over several samples at once. From the n-th look on it stands, and jumps with every look by less than shows from
/// one sample to the next.
class StandingCounter : public PassingInstruments {
 public:
  StandingCounter(InstrumentSet& inner, int looks) : PassingInstruments(inner), looks_(looks) {}
  void Arm(int samples, int lines) override {
    held_.clear();
    inner_.Arm(samples, lines);
  }
  LatchedSamples Latched() override {
    const std::vector<Reading> more = inner_.Latched().samples;
    held_.insert(held_.end(), more.begin(), more.end());
    LatchedSamples latched;
    if (held_.size() < kTogether) return latched;
    latched.samples.swap(held_);
    if (looks_-- > 0) return latched;
    for (Reading& sample : latched.samples) sample.reference_rad = latched.samples[0].reference_rad + 20.0 * units::deg;
    return latched;
  }

 private:
  static constexpr std::size_t kTogether = 4;  // of the twelve of a pass
  int looks_;
  std::vector<Reading> held_;
};

TEST(SomebodyElse, WhoStopsACounterLeavesNoSampleOfTheLookInWhichItStood) {
  DrivenTwin twin(ShortHob());
  const BenchFormat& format = FormatOf(twin.scenario.bench);
  const auto from_table = [order = HobOf(twin.scenario).transmission.HobOrder()](const Reading& r) { return order * r.measured_rad; };
  const procedure::ClaimedColumn hob{*std::ranges::find(format.columns, "hob_encoder_deg", &ReadingColumn::name), 0.0, 0.0, from_table, true};
  twin.options.require_goes_along = [=](const Reading& r, const Reading& before) { procedure::RequireGoesAlong({hob}, r, before); };
  StandingCounter instruments(twin.bench.instruments, 4);
  EXPECT_EQ(twin.FaultOn(AsHardware(twin.bench, instruments)), "moved") << twin.said;
  ASSERT_FALSE(twin.log.readings.empty());
  const auto left_rad = [&](const Reading& r) { return r.reference_rad - from_table(r); };
  for (const Reading& r : twin.log.readings)
    EXPECT_NEAR(std::remainder(left_rad(r) - left_rad(twin.log.readings[0]), units::turn), 0.0, 1.0 * units::deg) << r.reading;
}

/// Hears another speed wherever it is told to end turning, as through a line with noise.
class TurnsOn : public PassingMachine {
 public:
  using PassingMachine::PassingMachine;
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override {
    inner_.StartTurning(axis, speed_rad_s == 0.0 ? 1e-4 : speed_rad_s, ramp);
  }
};

TEST(SomebodyElse, WhatWasToEndTurningAndTurnsOnIsAtRestBehindTheLastReading) {
  Scenario scenario = ShortHob();
  HobOf(scenario).interferometer.used = false;  // at rest it would be seen
  HobOf(scenario).hob_procedure.heads_rad = {0.0};
  DrivenTwin twin(scenario);
  TurnsOn machine(twin.bench.machine);
  EXPECT_EQ(twin.FaultOn(AsHardware(twin.bench, machine, twin.bench.instruments)), "") << twin.said;
  EXPECT_FALSE(twin.bench.machine.State()[0].moving);
}

INSTANTIATE_TEST_SUITE_P(Benches, SomebodyElse, testing::Values(ShortCircles, ShortFreeform, ShortTurntable, ShortStops));

}  // namespace
}  // namespace twinbench::test
