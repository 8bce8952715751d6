#include "twin/procedure/rest.h"

#include "tests/fuzz/plain_bench.h"
#include "tests/support/faults.h"
#include "tests/support/kept_text.h"
#include "twin/core/nothing_moves.h"
#include "twin/procedure/machine_watch.h"
#include "twin/procedure/turning.h"

/// What counts as rest, and what axes that turn or were sent somewhere are held to.
namespace twinbench::procedure {
namespace {

/// An axis in mm whose controller does whatever the test wants, from the first stop and look on.
struct ScriptedAxis {
  std::function<void(ScriptedAxis&)> when_stopped = [](ScriptedAxis&) {}, when_looked_at = [](ScriptedAxis&) {};
  SeenAxis axis{"x", false, false, 0.0, 1.0 * units::um};
  int stops = 0, looks = 0;

  Stoppable Part() {
    return {[this] {
              ++stops;
              when_stopped(*this);
            },
            [this] {
              ++looks;
              when_looked_at(*this);
              return std::vector{axis};
            }};
  }
};

struct Creeps {
  double per_look_um;
  void operator()(ScriptedAxis& a) const { a.axis.encoder += per_look_um * units::um; }
};

struct Stop {
  const char* name;
  std::function<void(ScriptedAxis&)> is_so;
  bool is_at_rest;
  std::pair<int, int> stops = {1, 1};  // it is told at least and at most
};

class BringingToRest : public testing::TestWithParam<Stop> {};

TEST_P(BringingToRest, EndsWhereRestIsSeenOrNobodyKnows) {
  ScriptedAxis axis;
  GetParam().is_so(axis);
  fuzz::PlainClock clock;
  const Standstill stands = BringToRest(clock, {axis.Part()});
  EXPECT_EQ(stands.is_sure, GetParam().is_at_rest) << stands.why_not;
  EXPECT_EQ(stands.is_sure, stands.why_not.empty());
  EXPECT_GE(axis.stops, GetParam().stops.first);
  EXPECT_LE(axis.stops, GetParam().stops.second);
  if (!stands.is_sure) {
    EXPECT_LE(ToSeconds(clock.Now()), 5.0);
  }
  if (stands.is_sure && axis.looks > 0) {
    EXPECT_GE(axis.looks, 3);
    EXPECT_GE(ToSeconds(clock.Now()), 1.0);
  }
}

const DeviceFault kMute(FaultKind::kTimeout, "machine", "no answer");

const Stop kStops[] = {
    {"ThatWasAtRest", [](ScriptedAxis&) {}, true},
    {"ThatStopsWhenItIsTold",
     [](ScriptedAxis& a) {
       a.axis.moving = true;
       a.when_stopped = [](ScriptedAxis& b) { b.axis.moving = false; };
     },
     true},
    {"ThatTakesTime", [](ScriptedAxis& a) { a.when_looked_at = [](ScriptedAxis& b) { b.axis.moving = b.looks < 8; }; }, true, {2, 4}},
    {"ThatRunsOutSlowly",
     [](ScriptedAxis& a) {
       a.when_looked_at = [way = 40.0 * units::mm](ScriptedAxis& b) mutable {
         b.axis.encoder += way;
         way = b.looks < 14 ? 0.8 * way : 0.0;
       };
     },
     true, {3, 6}},
    {"ThatIsBusyForALookWithEveryWord",
     [](ScriptedAxis& a) {
       a.when_stopped = [](ScriptedAxis& b) { b.axis.moving = true; };
       a.when_looked_at = [heard = 0](ScriptedAxis& b) mutable { b.axis.moving = b.stops > std::exchange(heard, b.stops); };
     },
     true},
    {"ThatFlickersWithinItsLimit",
     [](ScriptedAxis& a) { a.when_looked_at = [](ScriptedAxis& b) { b.axis.encoder = b.looks % 2 * 0.9 * units::um; }; }, true},
    {"ThatCreepsFasterThanItsLimit", [](ScriptedAxis& a) { a.when_looked_at = Creeps{0.6}; }, false, {3, 6}},
    {"ThatCreepsAtNinetyMicrometresASecond", [](ScriptedAxis& a) { a.when_looked_at = Creeps{45.0}; }, false, {3, 6}},
    {"ThatCreepsAndHasNoLimit",
     [](ScriptedAxis& a) {
       a.axis.in_position = std::numeric_limits<double>::infinity();
       a.when_looked_at = Creeps{6.0};
     },
     false, {3, 6}},
    {"ThatNeverSaysSo", [](ScriptedAxis& a) { a.axis.moving = true; }, false, {3, 6}},
    {"ThatHearsTheThirdWord",
     [](ScriptedAxis& a) {
       a.axis.moving = true;
       a.when_stopped = [](ScriptedAxis& b) { b.axis.moving = b.stops < 3; };
     },
     true, {3, 3}},
    {"WhoseWordIsLostTwice",
     [](ScriptedAxis& a) {
       a.axis.moving = true;
       a.when_stopped = [](ScriptedAxis& b) {
         if (b.stops < 3) throw kMute;
         b.axis.moving = false;
       };
     },
     true, {3, 4}},
    {"ThatRefusesAndIsAtRest",
     [](ScriptedAxis& a) {
       a.when_stopped = [](ScriptedAxis&) { throw DeviceFault(FaultKind::kRefused, "machine", "it does not move"); };
     },
     true, {3, 20}},
    {"ThatNobodyReaches",
     [](ScriptedAxis& a) { a.when_stopped = a.when_looked_at = [](ScriptedAxis&) { throw kMute; }; }, false, {4, 20}},
    {"WithoutAnOriginByItsControllersWord", [](ScriptedAxis& a) { a.axis.encoder = kNaN; }, true},
    {"OfARecording", [](ScriptedAxis& a) { a.when_stopped = [](ScriptedAxis&) { throw NothingMoves(); }; }, true}};
INSTANTIATE_TEST_SUITE_P(Of, BringingToRest, testing::ValuesIn(kStops), [](const auto& test) { return test.param.name; });

TEST(BringingToRest, TellsAllBeforeItLooksAtAnyAndSaysWhoMoves) {
  ScriptedAxis mute, moving;
  mute.when_stopped = mute.when_looked_at = [](ScriptedAxis&) { throw kMute; };
  mute.when_looked_at = [&](ScriptedAxis&) {
    EXPECT_GT(moving.stops, 0);
    throw kMute;
  };
  moving.axis.moving = true;
  fuzz::PlainClock clock;
  EXPECT_KEPT(BringToRest(clock, {mute.Part(), moving.Part()}).why_not);
}

TEST(BringingToRest, WhatStoodAndIsSentOffAgainIsToldAtTheLookThatShowsIt) {
  ScriptedAxis axis;
  int looks_at_word = 0;
  axis.when_looked_at = [](ScriptedAxis& a) { a.axis.moving = a.axis.moving || a.looks == 2; };
  axis.when_stopped = [&](ScriptedAxis& a) { a.axis.moving = false, looks_at_word = a.looks; };
  fuzz::PlainClock clock;
  EXPECT_TRUE(BringToRest(clock, {axis.Part()}).is_sure);
  EXPECT_EQ(axis.stops, 2);
  EXPECT_EQ(looks_at_word, 2);
}

/// Seconds until a link is given up on which every word is waited for so long, and whether it was told that all rest.
std::pair<double, bool> TriedFor(double timeout_s, int parts, double answers_from_s = 1e9) {
  fuzz::PlainClock clock;
  const auto ask = [&] {
    if (ToSeconds(clock.Now()) >= answers_from_s) return;
    clock.Wait(FromSeconds(timeout_s));
    throw kMute;
  };
  std::vector<ScriptedAxis> axes(static_cast<std::size_t>(parts));
  std::vector<Stoppable> all;
  for (ScriptedAxis& axis : axes) {
    axis.when_stopped = axis.when_looked_at = [&](ScriptedAxis&) { ask(); };
    all.push_back(axis.Part());
  }
  const bool is_sure = BringToRest(clock, all, [&] { return HostTime(clock.Now().time_since_epoch()); }).is_sure;
  return {ToSeconds(clock.Now()), is_sure};
}

TEST(BringingToRest, OverADeadLinkIsGivenUpWithinFiveSecondsHoweverManyHangOnIt) {
  for (const double timeout_s : {0.3, 1.0, 2.0}) {
    for (const int parts : {1, 2}) {
      const auto [took_s, is_sure] = TriedFor(timeout_s, parts);
      EXPECT_FALSE(is_sure);
      EXPECT_LE(took_s, 5.0) << timeout_s << " " << parts;
      EXPECT_GT(took_s, 2.0) << timeout_s << " " << parts;  // it is no hiccup
    }
  }
}

TEST(BringingToRest, OverALinkThatAnswersAgainBeforeThatEndsAtRest) {
  for (const double timeout_s : {0.3, 1.0}) {
    const auto [took_s, is_sure] = TriedFor(timeout_s, 2, 2.0);
    EXPECT_TRUE(is_sure) << timeout_s;
    EXPECT_LE(took_s, 5.0) << timeout_s;
  }
}

TEST(WhetherAtRest, IsAskedThreeTimesOrUntilSomethingMoves) {
  ScriptedAxis rests, moves;
  EXPECT_TRUE(WhetherAtRest({rests.Part().look}).is_sure);
  EXPECT_EQ(rests.looks, 3);
  moves.axis.moving = true;
  EXPECT_EQ(WhetherAtRest({rests.Part().look, moves.Part().look}).why_not, "moving: x at 0.000000 mm");
  EXPECT_EQ(moves.looks, 1);
  EXPECT_EQ(rests.stops, 0);
}

/// A shaft that is told to go up to 10 deg/s within 2 s, and shows that times `factor`.
struct Shaft {
  const char* name;
  std::function<double(double told_deg)> shows_deg;
  const char* fault;
};

class TurningShaft : public testing::TestWithParam<Shaft> {};

TEST_P(TurningShaft, IsHeldToItsSpeed) {
  Turning turning;
  const MachineAxis axis{"shaft", true};
  std::string fault;
  const auto at = [](double s) { return Time{} + FromSeconds(s); };
  turning.Look(axis, 0.0, at(0.0), at(0.0));
  turning.Told(at(0.0), at(0.0), 10.0 * units::deg, std::chrono::seconds(2));
  for (double s = 0.5; s < 20.0 && fault.empty(); s += 0.5) {
    const double told_deg = s < 2.0 ? 2.5 * s * s : 10.0 * (s - 1.0);
    const auto kind = test::KindOf([&] { turning.Look(axis, GetParam().shows_deg(told_deg) * units::deg, at(s), at(s)); });
    if (kind) fault = FaultName(*kind);
  }
  EXPECT_EQ(fault, GetParam().fault);
}

const Shaft kShafts[] = {{"ThatObeys", [](double told) { return told; }, ""},
                         {"ThatIsSlowerByACommonSlip", [](double told) { return 0.95 * told; }, ""},
                         {"ThatStands", [](double) { return 0.0; }, "stalled"},
                         {"ThatStopsOnTheWay", [](double told) { return std::min(told, 80.0); }, "stalled"},
                         {"AtAThousandth", [](double told) { return 1e-3 * told; }, "stalled"},
                         {"AtTenTimesItsSpeed", [](double told) { return 10.0 * told; }, "following"},
                         {"AtATwentiethMoreThanATenth", [](double told) { return 1.15 * told; }, "following"},
                         {"TheOtherWayRound", [](double told) { return -told; }, "following"},
                         {"ThatTurnsBackOnTheWay", [](double told) { return told < 80.0 ? told : 160.0 - told; }, "following"}};
INSTANTIATE_TEST_SUITE_P(Is, TurningShaft, testing::ValuesIn(kShafts), [](const auto& test) { return test.param.name; });

TEST(Turning, UpAndDownAgainIsHeldToTheWayOfBothRamps) {
  const MachineAxis axis{"hob", true};
  for (const auto& [shown_deg, is_told] : {std::pair(40.0, false), {-40.0, true}, {400.0, true}, {0.04, true}}) {
    Turning turning;
    const auto at = [](int s) { return Time{} + std::chrono::seconds(s); };
    turning.Look(axis, 0.0, at(0), at(0));
    turning.Told(at(0), at(0), 20.0 * units::deg, std::chrono::seconds(2));
    turning.Told(at(2), at(2), 0.0, std::chrono::seconds(2));
    const auto look = [&, shown_deg = shown_deg] { turning.Look(axis, shown_deg * units::deg, at(10), at(10)); };
    if (is_told)
      EXPECT_THROW(look(), DeviceFault) << shown_deg;
    else
      EXPECT_NO_THROW(look());
  }
}

TEST(Whereabouts, FollowACircleAndTellWhoeverChangesATarget) {
  const std::vector<MachineAxis> axes = {{"x"}, {"y"}};
  const std::vector<AxisLimits> none;
  Whereabouts where(axes, none);
  std::vector<AxisState> states(2);
  states[0].commanded = 0.1;
  states[1].commanded = 0.0;
  EXPECT_NO_THROW(where.RequireOurs(states)) << "nobody was sent anywhere yet";
  where.SentRound({.sweep_rad = 0.5 * units::kPi}, states);
  EXPECT_NEAR(where.Sent(0, states[0]), 0.0, 1e-15);
  EXPECT_NEAR(where.Sent(1, states[1]), 0.1, 1e-15);
  EXPECT_THROW(where.RequireOurs(states), DeviceFault) << "it did not go";
  states[0].commanded = 9e-6;
  states[1].commanded = 0.1;
  EXPECT_NO_THROW(where.RequireOurs(states)) << "rounded";
  states[0].commanded = kNaN;
  EXPECT_NO_THROW(where.RequireOurs(states)) << "its origin is lost, which others tell";
  where.Released(1);
  states[1].commanded = 7.0;
  EXPECT_NO_THROW(where.RequireOurs(states)) << "it turns on";
  EXPECT_TRUE(std::isnan(where.Sent(1, states[1]))) << "whatever target its controller had before";
}

TEST(LimitSwitch, OfAMachineLeavesOnlyTheWayOffItOpen) {
  for (const int limit : {-1, 1}) {
    AxisState on_switch;
    on_switch.encoder = 0.1;
    on_switch.limit = limit;
    EXPECT_THROW(RequireMayGo({{"x"}}, {on_switch}, {0.1 + 0.01 * limit}, {}), DeviceFault);
    EXPECT_NO_THROW(RequireMayGo({{"x"}}, {on_switch}, {0.1 - 0.01 * limit}, {}));
  }
}

}  // namespace
}  // namespace twinbench::procedure
