#include "twin/procedure/watched_moves.h"

#include "tests/fuzz/plain_bench.h"
#include "tests/support/faults.h"

namespace twinbench::procedure {
namespace {

constexpr double kSpeed = 10.0 * units::deg, kWay = 50.0 * units::deg, kStall_s = 5.0, kLook_s = 0.1;

/// An axis that begins after a while, goes on at its speed, and from some instant on at a share of that.
struct Axis {
  double begins_s = 0.0, fails_s = 1e9, share = 0.0;
  double At(double t_s) const {
    const double whole = std::min(t_s, fails_s) - begins_s, rest = std::max(t_s - fails_s, 0.0);
    return std::clamp(kSpeed * (std::max(whole, 0.0) + share * rest), 0.0, kWay);
  }
};

class WayOfAxis : public testing::Test {
 protected:
  /// When it was said that it stalls; nothing: the way came to its end.
  std::optional<double> StallOf(const Axis& axis) {
    way_.Begins({0.0}, {kWay}, {axis.At(0.0)}, begin_, Duration(0));
    double t_s = 0.0;
    for (; axis.At(t_s) < kWay; t_s += kLook_s) {
      const auto kind = test::KindOf([&] { way_.Shows({axis.At(t_s)}, begin_ + FromSeconds(t_s), kStall_s); });
      EXPECT_EQ(kind.value_or(FaultKind::kStalled), FaultKind::kStalled);
      if (kind) return t_s;
    }
    way_.HasEnded();
    begin_ += FromSeconds(t_s);
    return std::nullopt;
  }

  WatchedWay way_{{{"x", true}}};
  Time begin_{};
};

TEST_F(WayOfAxis, OneThatIsAtItsEndBehindABreakSoonerThanItGoesCountsFromThere) {
  EXPECT_EQ(StallOf({}), std::nullopt);
  for (const auto& [after_s, is_lost] : {std::pair(0.1, true), {4.0, false}}) {
    way_.HasFoundZeros();
    way_.Begins({0.0}, {kWay}, {0.0}, begin_, Duration(0));
    way_.Seen({0.0}, begin_);
    way_.IsCut();
    way_.Seen({kWay}, begin_ + FromSeconds(after_s));
    EXPECT_EQ(way_.HasLostZero(0), is_lost);
  }
}

TEST_F(WayOfAxis, WithoutAnyWayBeforeItIsSlowForAsLongAsTheLimitsSay) {
  EXPECT_EQ(StallOf({.begins_s = 4.0}), std::nullopt);
  EXPECT_NEAR(StallOf({.fails_s = 2.0}).value_or(0.0), 2.0 + kStall_s, 2.0 * kLook_s);
}

TEST_F(WayOfAxis, BehindOneAStallIsNoticedWithinHalfASecondWhereverItIsAndHoweverItCreeps) {
  EXPECT_EQ(StallOf({}), std::nullopt);
  constexpr double kSoon_s = 0.4 + 1e-9;
  for (const double fails_s : {0.0, 2.0, 4.8}) {
    for (const double share : {0.0, 0.01}) {
      const double noticed_s = StallOf({.fails_s = fails_s, .share = share}).value_or(1e3);
      EXPECT_LE(noticed_s, fails_s + kSoon_s + kLook_s)
          << fails_s << " " << share;  // and the look in which it failed
      EXPECT_GE(noticed_s, fails_s);
    }
  }
  EXPECT_EQ(StallOf({.fails_s = 1.0, .share = 0.2}), std::nullopt);  // somebody set an override
}

TEST_F(WayOfAxis, OneThatNeedsAWhileToBeginMayDoSoAgainAndForTwiceAsLong) {
  EXPECT_EQ(StallOf({.begins_s = 1.0}), std::nullopt);
  EXPECT_EQ(StallOf({.begins_s = 2.0}), std::nullopt);
  EXPECT_NE(StallOf({.begins_s = 5.0}), std::nullopt);
}

TEST_F(WayOfAxis, WhereItSettlesNothingIsAsked) {
  EXPECT_EQ(StallOf({}), std::nullopt);
  way_.Begins({0.0}, {kWay}, {0.0}, begin_, Duration(0));
  for (int look = 1; look < 20; ++look)
    EXPECT_NO_THROW(way_.Shows({kWay - 1e-4}, begin_ + FromSeconds(look * kLook_s), kStall_s));
}

TEST_F(WayOfAxis, WhoeverSendsItElsewhereIsToldAtTheNextLookWhereItsControllerTellsTargets) {
  const auto said_of = [this](double first, double second) {
    way_.Begins({0.0}, {kWay}, {0.0}, begin_, Duration(0));
    EXPECT_NO_THROW(way_.RequireOurs({first}));
    return test::KindOf([&] { way_.RequireOurs({second}); });
  };
  EXPECT_EQ(said_of(kWay, kWay), std::nullopt);
  EXPECT_EQ(said_of(kWay, 0.5 * kWay), FaultKind::kMoved);
  EXPECT_EQ(said_of(0.1 * kWay, 0.5 * kWay), std::nullopt);  // it tells how far it is
}

/// Stands, and is on a switch from the n-th look on.
class AtSwitch : public fuzz::PlainMachine {
 public:
  explicit AtSwitch(int limit) : limit_(limit) {}
  bool Settles(Duration within) override { return asked += within, false; }
  std::vector<AxisState> State() override {
    AxisState state;
    state.commanded = 1.0, state.encoder = 0.5, state.limit = limit_;
    return {state};
  }
  Duration asked{0};

 private:
  int limit_;
};

TEST(WatchedMachine, ComesBackAtOnceWhereItRunsOntoASwitchAndNotWhereItLeavesOne) {
  const fuzz::PlainClock clock;
  const std::vector<AxisLimits> limits;
  const auto waited_s = [&](int limit) {
    AtSwitch machine(limit);
    WatchedMachine watched(machine, clock, limits);
    watched.StartMove({1.0}, 0.0);
    EXPECT_FALSE(watched.Settles(FromSeconds(1.0)));
    return ToSeconds(machine.asked);
  };
  EXPECT_NEAR(waited_s(+1), 0.1, 1e-9);
  EXPECT_NEAR(waited_s(-1), 1.0, 1e-9);
  EXPECT_NEAR(waited_s(0), 1.0, 1e-9);
}

/// Goes round, and is pushed off.
class OffCircle : public fuzz::PlainMachine {
 public:
  bool Settles(Duration) override { return false; }
  std::vector<AxisState> State() override {
    std::vector<AxisState> states(2);
    states[0].encoder = at_m;
    states[1].encoder = 0.0;
    return states;
  }
  double at_m = 0.05;
};

TEST(WatchedMachine, OneThatIsPushedOffItsCircleIsToldAtTheNextLook) {
  const fuzz::PlainClock clock;
  const std::vector<AxisLimits> limits;
  OffCircle machine;
  WatchedMachine watched(machine, clock, limits);
  watched.StartArc({});
  EXPECT_FALSE(watched.Settles(FromSeconds(0.3)));
  machine.at_m += 2e-3;
  EXPECT_EQ(test::KindOf([&] { watched.Settles(FromSeconds(0.3)); }), FaultKind::kFollowing);
}

/// Stands where its zero says; the first command of a run sets other zeros.
class ZeroedTable : public RotaryTable {
 public:
  void StartMove(double) override {
    if (as_sent) as_sent();
  }
  bool Settles(Duration) override { return true; }
  TableState State() override {
    if (std::exchange(is_silent, false)) throw DeviceFault(FaultKind::kTimeout, "table", "no answer");
    return {0.0, zero_rad, true, false, true, 0, ""};
  }
  void Stop() override {}
  void Home() override {}
  std::function<void()> as_sent;
  double zero_rad = 0.0;
  bool is_silent = false;
};

/// Two tables that are sent 30 deg one after the other.
struct PairOfTables {
  fuzz::PlainRotary others;
  ZeroedTable target, reference;
  RotaryBench bench = [this] {
    const RotaryBench plain = others.Bench();
    return RotaryBench{plain.clock,       target,           reference,    plain.adc, plain.autocollimator,
                       plain.thermometer, plain.goniometer, plain.fixture};
  }();
  WatchedTables watched{bench, {}, {}};

  void SendBoth() {
    watched.target().StartMove(30.0 * units::deg);
    watched.reference().StartMove(30.0 * units::deg);
  }
};

TEST(WatchedTables, SeeAZeroOfEitherThatIsSetAsTheFirstIsSent) {
  for (ZeroedTable PairOfTables::*which : {&PairOfTables::target, &PairOfTables::reference}) {
    PairOfTables pair;
    pair.target.as_sent = [&] { (pair.*which).zero_rad = -20.0 * units::deg; };
    pair.SendBoth();
    EXPECT_THROW(pair.watched.target().Settles(FromSeconds(1.0)), DeviceFault);
  }
}

TEST(WatchedTables, LookAnewBehindAWayAndBehindAStop) {
  PairOfTables pair;
  pair.SendBoth();
  EXPECT_TRUE(pair.watched.target().Settles(FromSeconds(1.0)));
  pair.reference.zero_rad = 10.0 * units::deg;  // it has gone there
  pair.SendBoth();
  pair.watched.target().Stop();
  pair.reference.zero_rad = 0.0;  // by hand, while nobody watches
  pair.SendBoth();
  EXPECT_TRUE(pair.watched.target().Settles(FromSeconds(1.0)));
}

/// Two axes that are where they were sent at once, or where somebody says. Switched off and on they count from another zero.
class Switched : public fuzz::PlainMachine {
 public:
  explicit Switched(Clock& clock) : clock_(clock) {}
  const std::vector<MachineAxis>& Axes() const override { return axes_; }
  void StartMove(const std::vector<double>& to, double) override { ++moves, at = to, clock_.Wait(FromSeconds(1.0)); }
  void StartArc(const Arc&) override {}
  bool Settles(Duration) override { return !jogged_to; }
  void Stop() override {}
  void Home() override { at = {0.0, 0.0}; }
  std::vector<AxisState> State() override {
    if (std::exchange(is_silent, false)) throw DeviceFault(FaultKind::kTimeout, "machine", "no answer");
    std::vector<AxisState> states(2);
    const std::vector<double> shown = std::exchange(garbled, {});
    for (std::size_t k : {0, 1}) states[k].encoder = shown.empty() ? at[k] : shown[k], states[k].commanded = jogged_to.value_or(at[k]);
    return states;
  }
  std::vector<double> at = {0.0, 0.0};
  std::vector<double> garbled;  // for one look
  std::optional<double> jogged_to;
  bool is_silent = false;
  int moves = 0;

 private:
  Clock& clock_;
  std::vector<MachineAxis> axes_ = {{"a", true}, {"b", true}};
};

class ZerosOfAMachine : public testing::Test {
 protected:
  void Stand(const std::vector<double>& at) {
    watched_.StartMove(at, 0.0);
    watched_.Settles(FromSeconds(1.0));
    for (int look = 0; look < 3; ++look) Look();
  }
  bool Look() { return watched_.State()[0].referenced; }
  void Cut() {
    machine_.is_silent = true;
    EXPECT_EQ(test::KindOf([&] { watched_.State(); }), FaultKind::kTimeout);
  }
  fuzz::PlainClock clock_;
  std::vector<AxisLimits> limits_;
  Switched machine_{clock_};
  WatchedMachine watched_{machine_, clock_, limits_};
};

TEST_F(ZerosOfAMachine, ThatCountsAnewBehindABrokenConnectionAreLostUntilTheyAreFound) {
  Stand({1.0, -1.0});
  Cut();
  EXPECT_TRUE(Look());
  Cut();
  machine_.at = {0.0, 0.0};
  EXPECT_FALSE(Look());
  machine_.moves = 0;
  EXPECT_EQ(test::KindOf([&] { watched_.StartMove({1.0, -1.0}, 0.0); }), FaultKind::kRestarted);
  EXPECT_EQ(machine_.moves, 0);
  watched_.Home();
  EXPECT_TRUE(Look());
  Stand({1.0, -1.0});
}

TEST_F(ZerosOfAMachine, AreLostOnAWayOnlyWhereItDoesNotLead) {
  for (const auto& [shown, is_known] : {std::pair(1.5, true), {2.0, true}, {0.0, false}, {2.0004, false}, {3.0, false}}) {
    watched_.Home();
    Stand({1.0, -1.0});
    watched_.StartMove({2.0, -2.0}, 500.0);
    machine_.at = {1.2, -1.2};
    EXPECT_TRUE(Look());
    Cut();
    watched_.Stop();
    machine_.at = {shown, -shown};
    EXPECT_EQ(Look(), is_known) << shown;
  }
}

TEST_F(ZerosOfAMachine, AreKnownBehindOneGarbledAnswer) {
  Stand({1.0, -1.0});
  machine_.garbled = {0.0, -1.0};
  EXPECT_TRUE(Look());
}

TEST_F(ZerosOfAMachine, AreKnownWhereSomebodyElseMovesItOnItsWay) {
  Stand({1.0, -1.0});
  watched_.StartMove({2.0, -2.0}, 0.0);
  machine_.jogged_to = 0.2;
  EXPECT_EQ(test::KindOf([&] { watched_.Settles(FromSeconds(1.0)); }), FaultKind::kMoved);
  machine_.at = {0.2, 0.2};
  EXPECT_TRUE(Look());
}

TEST_F(ZerosOfAMachine, AreLostWithoutABreakWhereNoAxisGoesThatFastAndNotWhereAHandMayHaveMovedIt) {
  Stand({1.0, -1.0});
  clock_.Wait(FromSeconds(10.0));
  machine_.at[0] = 0.0;
  EXPECT_TRUE(Look());
  Stand({1.0, -1.0});
  machine_.at[0] = 0.0;
  EXPECT_FALSE(Look());
}

TEST_F(ZerosOfAMachine, AreLostBehindABreakOnACircleThatTheyAreNotOn) {
  Stand({0.05, 0.0});
  watched_.StartArc({});
  machine_.at = {0.0, 0.05};
  Cut();
  EXPECT_TRUE(Look());
  Cut();
  machine_.at = {0.0, 0.0};
  EXPECT_FALSE(Look());
}

TEST(WatchedTables, CountFromAnotherZeroWhereBothAreBesideTheirWay) {
  PairOfTables pair;
  pair.SendBoth();
  for (const double at_deg : {1.0, 0.0}) {
    pair.target.zero_rad = pair.reference.zero_rad = at_deg * units::deg;
    EXPECT_EQ(pair.watched.target().State().referenced && pair.watched.reference().State().referenced, at_deg > 0.0);
  }
}

TEST(WatchedTables, CountFromAnotherZeroWhereBothStandElsewhereAtOnceOrOneBehindABreak) {
  for (const bool both : {true, false}) {
    for (const bool is_cut : {true, false}) {
      PairOfTables pair;
      const auto look = [&] { return pair.watched.target().State().referenced; };
      pair.target.zero_rad = pair.reference.zero_rad = 30.0 * units::deg;
      pair.SendBoth();
      for (RotaryTable* table : {&pair.watched.target(), &pair.watched.reference()}) table->Settles(FromSeconds(1.0));
      for (int k = 0; k < 3; ++k) look(), pair.watched.reference().State();
      pair.bench.clock.Wait(FromSeconds(60.0));
      pair.reference.is_silent = is_cut;
      EXPECT_EQ(test::KindOf([&] { pair.watched.reference().State(); }).has_value(), is_cut);
      pair.target.zero_rad = 0.0;
      if (both) pair.reference.zero_rad = 0.0;
      EXPECT_EQ(look(), !both && !is_cut);
      pair.watched.target().Home();
      EXPECT_TRUE(look());
      EXPECT_EQ(pair.watched.reference().State().referenced, !both && !is_cut);
    }
  }
}

}  // namespace
}  // namespace twinbench::procedure
