#include "twin/procedure/jumps.h"

#include "tests/support/faults.h"
#include "tests/support/kept_text.h"
#include "twin/core/bench_format.h"
#include "twin/procedure/plausible.h"
#include "twin/procedure/step_proof.h"

namespace twinbench::procedure {
namespace {

constexpr double kNoiseOfOne = 1e-7, kJump = 1e-5;
constexpr int kPlaces = 8;

ClaimedColumn ClaimOf(const char* bench, const char* name) {
  const auto& columns = FormatOf(bench).columns;
  return {.column = *std::ranges::find(columns, name, &ReadingColumn::name), .noise = kNoiseOfOne, .is_of_place = true};
}

const ClaimedColumn& X() {
  static const ClaimedColumn claim = ClaimOf("turntable_autocollimator", "autocollimator_x_arcsec");
  return claim;
}

/// Eight positions there and back and so on, of a curve and a reversal of 2 um that is not quite the same everywhere.
Reading NumberOf(int k) {
  Reading r;
  r.reading = k, r.pass = k / kPlaces, r.direction = r.pass % 2 == 0 ? 1 : -1;
  r.position = r.direction > 0 ? k % kPlaces : kPlaces - 1 - k % kPlaces;
  r.autocollimator_yaw_rad = 3e-5 * std::sin(r.position) + r.pass % 2 * (2e-6 + 2e-7 * std::cos(r.position));
  return r;
}

using Alters = std::function<void(Reading&)>;
using Requires = std::function<void(const Reading&, const std::vector<Reading>& kept)>;

/// How many of two passes are kept before one is refused.
int PassUntilNoticed(const Alters& alter, const Requires& require) {
  std::vector<Reading> kept;
  for (int k = 0; k < 2 * kPlaces; ++k) {
    Reading r = NumberOf(k);
    alter(r);
    if (test::FaultOf([&] { require(r, kept); })) return k;
    kept.push_back(r);
  }
  return 2 * kPlaces;
}

/// x jumps before the n-th of all.
int PassUntilNoticed(int n, double jump_rad) {
  return PassUntilNoticed([=](Reading& r) { r.autocollimator_yaw_rad += r.reading >= n ? jump_rad : 0.0; },
                          [](const Reading& r, const auto& kept) { RequireNoJump({X()}, r, kept); });
}

TEST(RequireNoJump, WhatPassesDifferByIsTheSameBeforeAndBehindEachReading) {
  EXPECT_EQ(PassUntilNoticed(16, kJump), 16);
  EXPECT_EQ(PassUntilNoticed(8, kJump), 16);  // between the passes: it may be a reversal
  EXPECT_EQ(PassUntilNoticed(4, kJump), 13);  // in the first: behind two places of the second on either side
  EXPECT_EQ(PassUntilNoticed(10, kJump), 11);
  EXPECT_EQ(PassUntilNoticed(10, -kJump), 11);
  EXPECT_EQ(PassUntilNoticed(4, 1e-6), 16);  // 10 times the noise
  const auto there_and_back = [](int from, int to) {
    return PassUntilNoticed(
        [=](Reading& r) { r.autocollimator_yaw_rad += r.reading >= from && r.reading < to ? kJump : 0.0; },
        [](const Reading& r, const auto& kept) { RequireNoJump({X()}, r, kept); });
  };
  EXPECT_EQ(there_and_back(9, 15), 15);  // all but the first and the last of the second
  EXPECT_EQ(there_and_back(9, 14), 14);
  EXPECT_EQ(there_and_back(2, 6), 11);
}

using ShownLater = std::function<double(double k)>;  // by how much x is another at the k-th reading

/// Four passes. Numbers of the readings behind which the axes come again, and of that which ended it.
std::string Closed(const ShownLater& later) {
  Closing closing({X()}, {});
  std::string came;
  for (int k = 0; k < 4 * kPlaces; ++k) {
    Reading r = NumberOf(k);
    r.autocollimator_yaw_rad += later(k);
    if (test::FaultOf([&] { RequireNoJump({X()}, r, closing.taken()); })) return came + "jump";
    closing.Took(r);
    const Reading* const then = closing.Asks();
    if (!then) continue;
    came += fmt::format("{}->{} ", k, then->reading);
    Reading again = NumberOf(then->reading);
    again.autocollimator_yaw_rad += later(k + 0.5);
    if (const auto kind = test::KindOf([&] { closing.Require(again); })) return came + FaultName(*kind);
  }
  return came;
}

TEST(Closing, WhatIsShownAtThePlaceWherePassesBeganIsAsItWasOrHasDriftedSteadily) {
  const auto jumps_at = [](double n) { return [n](double k) { return k >= n ? kJump : 0.0; }; };
  const std::string all = "15->0 23->8 31->16 ";
  EXPECT_EQ(Closed([](double) { return 0.0; }), all);
  EXPECT_EQ(Closed([](double k) { return 1e-6 * k; }), all);
  EXPECT_EQ(Closed([](double k) { return k >= 8 ? 1e-6 : 0.0; }), all);  // 10 times the noise
  for (const double n : {1.0, 8.0, 15.0, 15.25}) EXPECT_EQ(Closed(jumps_at(n)), "15->0 changed") << n;
  for (const double n : {2.0, 5.0, 12.0, 14.0}) EXPECT_EQ(Closed(jumps_at(n)), "jump") << n;
  for (const double n : {16.0, 17.0, 23.0}) EXPECT_EQ(Closed(jumps_at(n)), "15->0 23->8 changed") << n;
  for (const double n : {24.0, 31.0}) EXPECT_EQ(Closed(jumps_at(n)), all + "changed") << n;
}

/// Two channels that differ by an offset and the same curve over the places, exchanged from the n-th of all on.
int PassUntilExchangeIsNoticed(int n, double curve_V) {
  const ClaimedColumn a = ClaimOf("rotary_4dof", "psd_a_x_V"), b = ClaimOf("rotary_4dof", "psd_b_x_V");
  const auto exchange = [=](Reading& r) {
    const double apart_V = 1e-2 + curve_V * std::sin(1.0 + r.position) + r.pass * 1e-3;  // a reversal, too
    r.mean_V = {0.1 * r.position + apart_V, 0.0, 0.1 * r.position, 0.0};
    if (r.reading >= n) std::swap(r.mean_V[0], r.mean_V[2]);
  };
  return PassUntilNoticed(exchange,
                          [&](const Reading& r, const auto& kept) { RequireNotReversed(a, &b, r, kept); });
}

TEST(Closing, OfARunThatIsGoneOnWithAsksForWhatWasKeptBefore) {
  std::vector<Reading> kept;
  for (int k = 0; k < 2 * kPlaces - 1; ++k) kept.push_back(NumberOf(k));
  Closing closing({X()}, kept);
  closing.Took(NumberOf(2 * kPlaces - 1));
  ASSERT_NE(closing.Asks(), nullptr);
  EXPECT_EQ(closing.Asks()->reading, 0);
}

TEST(RequireNotReversed, SpotsDifferAgainstEachOtherAsInThePassBefore) {
  EXPECT_EQ(PassUntilExchangeIsNoticed(100, 1e-4), 16);
  EXPECT_EQ(PassUntilExchangeIsNoticed(0, 1e-4), 16);  // from the begin on nothing tells it
  EXPECT_EQ(PassUntilExchangeIsNoticed(8, 1e-4), 13);
  EXPECT_EQ(PassUntilExchangeIsNoticed(10, 1e-4), 15);
  EXPECT_EQ(PassUntilExchangeIsNoticed(4, 1e-4), 14);  // in mid-pass, by three places beside others that are as before
  EXPECT_EQ(PassUntilExchangeIsNoticed(2, 1e-4), 16);  // two are too few
  EXPECT_EQ(PassUntilExchangeIsNoticed(8, 1e-6), 16);  // less than ten times the noise
}

TEST(RequireNotReversed, AColumnHasTheSignThatItHadInThePassBefore) {
  const auto negate = [](Reading& r) { r.autocollimator_yaw_rad *= r.reading >= kPlaces ? -1.0 : 1.0; };
  const auto require = [](const Reading& r, const auto& kept) { RequireNotReversed(X(), nullptr, r, kept); };
  EXPECT_EQ(PassUntilNoticed([](Reading&) {}, require), 16);
  EXPECT_EQ(PassUntilNoticed(negate, require), 13);
}

/// Shows a place and noise of about kNoiseOfOne, or what a fault makes of that.
class Shows : public InstrumentSet {
 public:
  using Fault = std::function<double(const std::vector<double>& so_far)>;
  explicit Shows(Fault fault) : fault_(std::move(fault)) {}
  Reading Read() override {
    shown_.push_back(place + kNoiseOfOne * std::sin(17.0 * static_cast<double>(shown_.size() + 1)));
    Reading reading;
    reading.autocollimator_yaw_rad = fault_(shown_);
    return reading;
  }
  void Arm(int, int) override {}
  LatchedSamples Latched() override {
    LatchedSamples latched;
    for (int k = 0; k < 40; ++k, place += kNoiseOfOne) latched.samples.push_back(Read());
    return latched;
  }
  double place = 0.0;

 private:
  Fault fault_;
  std::vector<double> shown_;
};

/// Twelve places, an attempt more for each fault: of how many readings are wrong, and what was said.
std::string Measured(const Shows::Fault& fault, double noise = kNoiseOfOne) {
  Shows shows(fault);
  DoubtedInstruments doubted(shows, {{X().column, noise, 1e-3}});
  int wrong = 0, faults = 0;
  std::string said;
  for (int place = 0; place < 12; ++place) {
    shows.place = 1e-4 * std::sin(1.0 + place);
    for (int attempt = 0; attempt < 3; ++attempt) {
      const auto caught = test::FaultOf([&] { wrong += std::abs(doubted.Read().autocollimator_yaw_rad - shows.place) > 3.0 * kNoiseOfOne; });
      if (!caught) break;
      ++faults;
      if (said.empty()) said = std::string(FaultName(caught->kind())) + ", " + caught->what();
    }
  }
  const auto in_motion = test::KindOf([&] {
    for (int look = 0; look < 3; ++look) doubted.Latched();
  });
  if (in_motion) said += std::string("; in motion ") + FaultName(*in_motion);
  return fmt::format("{} wrong, {} faults: {}", wrong, faults, said);
}

TEST(DoubtedInstruments, KeepNothingOfDeadStuckLateAndRangelessOnesAndAllOfGoodOnes) {
  const std::pair<Shows::Fault, double> cases[] = {
      {[](const auto& all) { return all.back(); }, kNoiseOfOne},                            // good
      {[](const auto& all) { return std::round(all.back() / 3e-7) * 3e-7; }, kNoiseOfOne},  // shown in steps of three times its noise
      {[](const auto&) { return 0.0; }, kNoiseOfOne},                                       // dead
      {[](const auto& all) { return all[std::min<std::size_t>(all.size() - 1, 5)]; }, kNoiseOfOne},  // stuck from the sixth on
      {[](const auto& all) { return all[all.size() < 2 ? 0 : all.size() - 2]; }, kNoiseOfOne},       // late by one
      {[](const auto& all) { return all.back() + (all.size() == 5 ? 1e-4 : 0.0); }, kNoiseOfOne},      // one spike
      {[](const auto& all) { return all[all.size() - (all.size() % 3 == 0 ? 2 : 1)]; }, kNoiseOfOne},  // an old answer again, each third time
      {[](const auto& all) { return 1e3 * all.back(); }, kNoiseOfOne},                               // in another unit
      {[](const auto&) { return 0.0; }, 0.0}};  // of one that claims nothing nothing is asked
  for (const auto& [fault, noise] : cases) EXPECT_KEPT(Measured(fault, noise));
}

/// Two channels, of which the second shows noise as long as told, and then nothing but its end.
class OneDies : public InstrumentSet {
 public:
  explicit OneDies(double ends) : ends_(ends) {}
  Reading Read() override {
    Reading reading;
    reading.autocollimator_yaw_rad = kNoiseOfOne * std::sin(17.0 * ++reads_);
    reading.autocollimator_tilt_rad = std::min(ends_, place + kNoiseOfOne * std::cos(17.0 * reads_));
    return reading;
  }
  void Arm(int, int) override {}
  LatchedSamples Latched() override { return {}; }
  double place = 0.0;

 private:
  double ends_;
  int reads_ = 0;
};

TEST(DoubtedInstruments, OneChannelThatShowsNoNoiseAnyMoreIsDeadBesideOthersThatLive) {
  const ClaimedColumn y = ClaimOf("turntable_autocollimator", "autocollimator_y_arcsec");
  OneDies shows(1e-4);
  DoubtedInstruments doubted(shows, {{X().column, kNoiseOfOne}, {y.column, kNoiseOfOne}});
  for (; shows.place < 0.9e-4; shows.place += 1e-5) EXPECT_FALSE(test::KindOf([&] { doubted.Read(); }));
  shows.place = 2e-4;
  EXPECT_EQ(test::KindOf([&] { doubted.Read(); }), FaultKind::kStuck);
}

/// Sixteen readings: of how many the steps are proved.
int Steady(double x_from_the_tenth, double y_from_the_tenth) {
  StepProof proof(false);
  for (int k = 0; k < 16; ++k) {
    const double chance = 0.01 * std::sin(17.0 * k);
    const double x = k < 10 ? 0.95 : x_from_the_tenth, y = k < 10 ? 0.005 : y_from_the_tenth;
    const double step = k % 3 == 0 ? -1e-4 : 1e-4;
    const auto kind = test::KindOf([&] {
      proof.Require({{"x", step, step * (x + chance), 1e-7}, {"y", 0.0, step * (y + 0.1 * chance), 1e-7}});
    });
    EXPECT_EQ(kind.value_or(FaultKind::kChanged), FaultKind::kChanged);
    if (kind) return k;
  }
  return 16;
}

TEST(StepProof, GainAndRollAreWhatTheyWereBesideTheReadingsBefore) {
  EXPECT_EQ(Steady(0.95, 0.005), 16);
  EXPECT_EQ(Steady(0.92, 0.005), 16);  // a stage that goes its step less well
  EXPECT_EQ(Steady(0.80, 0.005), 11);
  EXPECT_EQ(Steady(0.95, 0.03), 11);
}

/// The hob's encoder at an angle of the table's, and 20 times that.
Reading OfHob(double table_deg, double hob_deg) {
  Reading r;
  r.measured_rad = table_deg * units::deg;
  r.reference_rad = hob_deg * units::deg;
  return r;
}

TEST(RequireGoesAlong, WhatFollowsGoesTheWayThatItShouldWithinHalfOfItAndARangedOneWithinAHundredthOfItsRange) {
  ClaimedColumn claim{ClaimOf("hob_transmission", "hob_encoder_deg").column, 0.0, 0.0,
                      [](const Reading& r) { return 20.0 * r.measured_rad; }, true};
  const Reading before = OfHob(10.0, 200.0);
  EXPECT_NO_THROW(RequireGoesAlong({claim}, OfHob(12.0, 240.01), before));
  EXPECT_NO_THROW(RequireGoesAlong({claim}, OfHob(12.0, -119.99), before));  // of a counter that begins anew every turn
  EXPECT_THROW(RequireGoesAlong({claim}, OfHob(12.0, 200.0), before), DeviceFault);
  EXPECT_THROW(RequireGoesAlong({claim}, OfHob(12.0, 160.0), before), DeviceFault);
  claim.is_angle = false;
  claim.range = 1000.0 * units::deg;
  EXPECT_NO_THROW(RequireGoesAlong({claim}, OfHob(10.1, 211.0), before));
  EXPECT_THROW(RequireGoesAlong({claim}, OfHob(10.1, 213.0), before), DeviceFault);
}

TEST(RequireAnother, ASampleAtTheLineOfTheOneBeforeIsNoneOfItsOwnWhateverElseItShows) {
  EXPECT_NO_THROW(RequireAnother(OfHob(12.0, 200.0), OfHob(10.0, 200.0), "hob_transmission"));
  EXPECT_THROW(RequireAnother(OfHob(10.0, 200.001), OfHob(10.0, 200.0), "hob_transmission"), DeviceFault);
}

TEST(RequireNextLine, SamplesAreAsManyLinesApartAsTheFirstTwo) {
  constexpr int kLines = 100;
  double step_rad = kNaN;
  const auto next = [&](double from_deg, double to_deg) {
    RequireNextLine(OfHob(to_deg, 0.0), OfHob(from_deg, 0.0), "hob_transmission", kLines, step_rad);
  };
  next(350.0, 352.0);
  EXPECT_NO_THROW(next(352.0, 354.009));
  EXPECT_NO_THROW(next(359.0, 1.0));  // of a counter that begins anew every turn
  for (const double to_deg : {353.98, 354.02, 356.0, 350.0, 352.0})
    EXPECT_THROW(next(352.0, to_deg), DeviceFault) << to_deg;
}

TEST(RequireTogether, AReferenceGoesWhereTheEncoderOfItsAxisGoes) {
  const auto reading = [](double reference_deg, const char* encoder_deg, int setup = 0) {
    Reading r;
    r.setup = setup, r.reference_rad = reference_deg * units::deg, r.extra["shaft_encoder_before_deg"] = encoder_deg;
    return r;
  };
  const Reading before = reading(350.0, "350");
  EXPECT_NO_THROW(RequireTogether(reading(20.004, "380"), before, "encoder_comparison"));  // some count on, others from 0
  EXPECT_NO_THROW(RequireTogether(reading(350.0, "380", 1), before, "encoder_comparison"));
  EXPECT_NO_THROW(RequireTogether(reading(350.0, "380"), before, "hob_transmission"));  // compares nothing with a reference
  EXPECT_THROW(RequireTogether(reading(350.0, "380"), before, "encoder_comparison"), DeviceFault);
  EXPECT_THROW(RequireTogether(reading(20.0, "350"), before, "encoder_comparison"), DeviceFault);
}

}  // namespace
}  // namespace twinbench::procedure
