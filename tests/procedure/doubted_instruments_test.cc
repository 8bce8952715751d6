#include "twin/procedure/doubted_instruments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/kept_text.h"
#include "twin/core/bench_format.h"
#include "twin/core/device_fault.h"
#include "twin/procedure/plausible.h"

namespace twinbench::procedure {
namespace {

constexpr double kNoise = 1e-7;

/// Shows a place and noise of about kNoise, or what a fault makes of that.
class Shows : public InstrumentSet {
 public:
  using Fault = std::function<double(const std::vector<double>& so_far)>;
  explicit Shows(Fault fault) : fault_(std::move(fault)) {}
  Reading Read() override {
    shown_.push_back(place + kNoise * std::sin(17.0 * static_cast<double>(shown_.size() + 1)));
    Reading reading;
    reading.autocollimator_yaw_rad = fault_(shown_);
    return reading;
  }
  void Arm(int, int) override {}
  LatchedSamples Latched() override {
    LatchedSamples latched;
    for (int k = 0; k < 40; ++k, place += kNoise) latched.samples.push_back(Read());
    return latched;
  }
  double place = 0.0;

 private:
  Fault fault_;
  std::vector<double> shown_;
};

/// Twelve places, an attempt more for each fault: of how many readings are wrong, and what was said.
std::string Measured(const Shows::Fault& fault, double noise = kNoise) {
  Shows shows(fault);
  const auto& columns = FormatOf("turntable_autocollimator").columns;
  DoubtedInstruments doubted(shows, {{*std::ranges::find(columns, "autocollimator_x_arcsec", &ReadingColumn::name), noise, 1e-3}});
  int wrong = 0, faults = 0;
  std::string said;
  for (int place = 0; place < 12; ++place) {
    shows.place = 1e-4 * std::sin(1.0 + place);
    for (int attempt = 0; attempt < 3; ++attempt) {
      try {
        if (std::abs(doubted.Read().autocollimator_yaw_rad - shows.place) > 3.0 * kNoise) ++wrong;
        break;
      } catch (const DeviceFault& caught) {
        ++faults;
        if (said.empty()) said = std::string(FaultName(caught.kind())) + ", " + caught.what();
      }
    }
  }
  try {
    for (int look = 0; look < 3; ++look) doubted.Latched();
  } catch (const DeviceFault& caught) {
    said += std::string("; in motion ") + FaultName(caught.kind());
  }
  return fmt::format("{} wrong, {} faults: {}", wrong, faults, said);
}

TEST(DoubtedInstruments, KeepNothingOfDeadStuckLateAndRangelessOnesAndAllOfGoodOnes) {
  const std::pair<Shows::Fault, double> cases[] = {
      {[](const auto& all) { return all.back(); }, kNoise},                            // good
      {[](const auto& all) { return std::round(all.back() / 3e-7) * 3e-7; }, kNoise},  // shown in steps of three times its noise
      {[](const auto&) { return 0.0; }, kNoise},                                       // dead
      {[](const auto& all) { return all[std::min<std::size_t>(all.size() - 1, 5)]; }, kNoise},  // stuck from the sixth on
      {[](const auto& all) { return all[all.size() < 2 ? 0 : all.size() - 2]; }, kNoise},       // late by one
      {[](const auto& all) { return all.back() + (all.size() == 5 ? 1e-4 : 0.0); }, kNoise},      // one spike
      {[](const auto& all) { return all[all.size() - (all.size() % 3 == 0 ? 2 : 1)]; }, kNoise},  // an old answer again, each third time
      {[](const auto& all) { return 1e3 * all.back(); }, kNoise},                               // in another unit
      {[](const auto&) { return 0.0; }, 0.0}};  // of one that claims nothing nothing is asked
  for (const auto& [fault, noise] : cases) EXPECT_KEPT(Measured(fault, noise));
}

/// The hob's encoder at an angle of the table's, and 20 times that.
Reading OfHob(double table_deg, double hob_deg) {
  Reading r;
  r.measured_rad = table_deg * units::deg;
  r.reference_rad = hob_deg * units::deg;
  return r;
}

TEST(RequireGoesAlong, WhatFollowsGoesTheWayThatItShouldWithinHalfOfItAndARangedOneWithinAHundredthOfItsRange) {
  const auto& columns = FormatOf("hob_transmission").columns;
  const ReadingColumn& column = *std::ranges::find(columns, "hob_encoder_deg", &ReadingColumn::name);
  ClaimedColumn claim{column, 0.0, 0.0, [](const Reading& r) { return 20.0 * r.measured_rad; }, true};
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
