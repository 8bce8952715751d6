#include <algorithm>

#include "twin/benches/turntable_autocollimator/diagnosis/family_parts.h"
#include "twin/benches/turntable_autocollimator/diagnosis/turntable_run.h"
#include "twin/core/units.h"
#include "twin/diagnose/unknown/design.h"

namespace twinbench::diagnose::turntable {
namespace {

constexpr double kPlausible_rad = 0.5 * units::arcsec;
constexpr double kPlausibleShare = 0.005;

std::vector<unknown::Place> GenericPlaces() {
  return {{"x", "x", Eigen::Vector2d::UnitX()},
          {"y", "y", Eigen::Vector2d::UnitY()},
          {"x, y", "x, y", Eigen::Matrix2d::Identity()}};
}

/// Every order of the turntable is free, and of the multi-tooth table where shifts tell its teeth.
std::vector<unknown::Angle> GenericAngles(const TurntableRun& turntable) {
  const Schedule& s = turntable.run.schedule;
  const int last = std::clamp((turntable.places.circle_blocks - 1) / 2, 0, 12);
  std::vector<unknown::Angle> angles = {{"target angle", s.target_rad, last, 0, "harmonic", "turntable"}};
  if (turntable.places.HasTeeth())
    angles.push_back({"reference angle", s.reference_rad, last, 0, "harmonic", "multitooth"});
  return angles;
}

/// 1 at positions, 0 in a sweep.
Eigen::VectorXd AtPositions(const Places& places) {
  Eigen::VectorXd at(std::ssize(places.sweep));
  for (Eigen::Index i = 0; i < at.size(); ++i) at[i] = places.sweep[static_cast<std::size_t>(i)] < 0 ? 1.0 : 0.0;
  return at;
}

}  // namespace

std::vector<Family> UnknownFamilies(const TurntableRun& turntable, const TimeSeries& series) {
  unknown::Design design;
  design.course = turntable.run.schedule;
  design.channels = turntable.run.channels;
  design.places = GenericPlaces();
  design.angles = GenericAngles(turntable);
  design.continued_rad = design.course.target_rad;
  design.moved = AtPositions(turntable.places);
  design.senses = {DirectionSignal(turntable.context)};
  design.above_K = turntable.context.above_K;
  design.twin_is_warm = true;
  design.series = series;
  design.shown = turntable.context.shown_rad;
  design.shown_name = "reading";
  design.unit = turntable.run.unit;
  design.to_SI = turntable.run.to_SI;
  design.plausible = kPlausible_rad;
  design.plausible_share = kPlausibleShare;
  design.named = {{"direction offset", ""}, {"trend", ""},   {"tone", "tone"},  {"step", "slip"},
                  {"linear map", ""},       {"restart", ""}, {"reading fringes", "autocollimator_periodic"}};
  return unknown::Families(design);
}

}  // namespace twinbench::diagnose::turntable
