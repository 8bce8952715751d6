#include "twin/benches/rotary_4dof/diagnosis/families.h"
#include "twin/benches/rotary_4dof/diagnosis/signals.h"
#include "twin/core/units.h"
#include "twin/diagnose/unknown/design.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::rotary {
namespace {

constexpr double kPlausible_m = 0.5 * units::um;  // of a disturbance on a PSD
constexpr double kPlausibleShare = 0.005;         // of a wrong scale

/// "psd_b_y" or "psd_a_y, psd_b_y in phase (tilt pattern)".
std::string OnWhat(const std::string& place) {
  if (place == "yaw") return "psd_a_x, psd_b_x in phase (yaw pattern)";
  if (place == "tilt") return "psd_a_y, psd_b_y in phase (tilt pattern)";
  if (place == "roll") return "psd_a_y, psd_b_y in antiphase (roll pattern)";
  if (place == "lateral") return "psd_a_x, psd_b_x in antiphase (lateral pattern)";
  return place;
}

/// A motion of the grating, a channel, or all channels independently.
std::vector<unknown::Place> GenericPlaces(const Eigen::Matrix4d& shown_by_motion) {
  std::vector<unknown::Place> places;
  const std::array<const char*, 4> motions = {"yaw", "tilt", "roll", "lateral"};
  for (int k = 0; k < 4; ++k) {
    const char* const motion = motions[static_cast<std::size_t>(k)];
    const Eigen::Vector4d shown = shown_by_motion.col(k);
    places.push_back({motion, OnWhat(motion), shown / shown.cwiseAbs().maxCoeff()});
  }
  for (int c = 0; c < kChannels; ++c) {
    const char* const name = kChannelNames[static_cast<std::size_t>(c)];
    places.push_back({name, name, Eigen::Vector4d::Unit(c)});
  }
  places.push_back({"all", "all channels", Eigen::MatrixXd::Identity(kChannels, kChannels)});
  return places;
}

/// Every order of both tables is free.
std::vector<unknown::Angle> GenericAngles(const Schedule& s, int positions) {
  const int last = std::min(12, (positions - 1) / 2);
  return {{"target angle", s.target_rad, last, 0, "harmonic", "target"},
          {"reference angle", s.reference_rad, last, 0, "harmonic", "reference"}};
}

Eigen::MatrixXd ByReading(const Eigen::VectorXd& rows) {
  return Eigen::Map<const Eigen::MatrixXd>(rows.data(), kChannels, rows.size() / kChannels).transpose();
}

}  // namespace

std::vector<Family> UnknownFamilies(const RotaryRun& rotary, double reference_degC, const TimeSeries& series) {
  const Schedule& s = rotary.run.schedule;
  unknown::Design design;
  design.course = s;
  design.channels = rotary.run.channels;
  design.places = GenericPlaces(rotary.shown_by_motion);
  design.angles = GenericAngles(s, rotary.design.n);
  design.continued_rad = ContinuedTarget_rad(s, false);
  design.moved = InCircle(s);
  design.senses = {DirectionSignal(s)};
  design.twin_is_warm = true;
  if (model::HasTemperature(s)) design.above_K = model::Above_K(s, reference_degC);
  design.series = series;
  design.shown = ByReading(rotary.run.Predicted());
  design.shown_name = "spot";
  design.detectors = {{0, 1}, {2, 3}};
  design.unit = rotary.run.unit;
  design.to_SI = rotary.run.to_SI;
  design.plausible = kPlausible_m;
  design.plausible_share = kPlausibleShare;
  design.named = {{"tone", "tone"}, {"step", "slip"}, {"direction offset", ""}, {"trend", ""}, {"restart", ""}, {"temperature", ""}};
  return unknown::Families(design);
}

}  // namespace twinbench::diagnose::rotary
