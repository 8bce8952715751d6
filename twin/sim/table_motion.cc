#include "twin/sim/table_motion.h"

#include <algorithm>

namespace twinbench::sim {
namespace {

std::vector<mechanics::Harmonic> Harmonics(const TableSettings& settings, std::uint64_t seed,
                                           const std::string& name) {
  std::vector<mechanics::Harmonic> harmonics;
  for (const HarmonicSettings& h : settings.harmonics) {
    harmonics.push_back({static_cast<int>(h.component), h.order, h.amplitude, h.phase_rad});
  }
  const bool random =
      std::any_of(settings.random_rms.begin(), settings.random_rms.end(), [](double r) { return r > 0.0; });
  if (random) {
    Stream stream(seed, name + ".errors");
    const auto drawn = mechanics::MakeRandomHarmonics(settings.random_rms, settings.random_orders,
                                                      [&] { return stream.Normal(); });
    harmonics.insert(harmonics.end(), drawn.begin(), drawn.end());
  }
  return harmonics;
}

mechanics::ErrorTable Table(const TableSettings& settings) {
  if (!settings.errors) return {};
  return {settings.errors->position_rad, settings.errors->value};
}

bool AnyPositive(const std::array<double, kComponents>& sd) {
  return std::any_of(sd.begin(), sd.end(), [](double s) { return s > 0.0; });
}

}  // namespace

TableMotion::TableMotion(const TableSettings& settings, const Scenario& of, const std::string& name)
    : settings_(settings),
      seating_stream_(of.RunSeed(), name + ".seating"),
      stop_stream_(of.RunSeed(), name + ".repeatability"),
      scatters_(AnyPositive(settings.repeatability_sd)) {
  repeatable_ = mechanics::ErrorMotion(Harmonics(settings, of.seed, name), Table(settings));
  if (settings.half_frequency_tilt_rad == 0.0 && settings.half_frequency_radial_m == 0.0) return;
  const mechanics::HalfFrequencyMotion half = {settings.half_frequency_order, settings.half_frequency_tilt_rad,
                                               settings.half_frequency_radial_m};
  half_frequency_ = mechanics::ErrorMotion({}, {}, half);
}

mechanics::PoseError TableMotion::At(double label_rad) const {
  const mechanics::PoseError error = repeatable_.Evaluate(label_rad) + stop_;
  return half_frequency_ ? error + half_frequency_->Evaluate(label_rad) : error;
}

TableErrors TableMotion::Repeatable(int positions) const {
  std::vector<double> position_rad;
  for (int k = 0; k < positions; ++k) position_rad.push_back(2.0 * units::kPi * k / positions);
  return Repeatable(position_rad);
}

TableErrors TableMotion::Repeatable(const std::vector<double>& position_rad) const {
  TableErrors errors;
  for (const double angle_rad : position_rad) {
    const auto value = repeatable_.Evaluate(angle_rad).Array();
    errors.position_rad.push_back(angle_rad);
    for (int c = 0; c < kComponents; ++c) errors.value[c].push_back(value[c]);
  }
  return errors;
}

mechanics::PoseError TableMotion::Draw(const std::array<double, kComponents>& sd, Stream& stream) {
  std::array<double, kComponents> drawn{};
  for (int c = 0; c < kComponents; ++c) drawn[c] = sd[c] * stream.Normal();
  return mechanics::PoseError::FromArray(drawn);
}

}  // namespace twinbench::sim
