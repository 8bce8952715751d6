#include "twin/benches/rotary_4dof/tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

namespace twinbench::benches::rotary {
namespace {

using measure::Vector4;
using separate::TableEstimate;

double UnitOf(Component c) {
  return IsAngle(c) ? units::arcsec : units::um;
}
const char* UnitName(Component c) {
  return IsAngle(c) ? "arcsec" : "um";
}
const char* NameOf(Component c) {
  return kComponentNames[static_cast<std::size_t>(c)];
}

/// Root mean square of the finite values; NaN if there is none.
double Rms(const std::vector<double>& values) {
  double sum = 0.0;
  int count = 0;
  for (const double v : values) {
    if (std::isnan(v)) continue;
    sum += v * v;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kNaN;
}

std::string ReadingCounts(const std::vector<measure::Motion>& motions) {
  std::map<ReadingStatus, int> counts;
  for (const measure::Motion& motion : motions) ++counts[motion.status];
  std::string text = fmt::format("{} reading{}", motions.size(), motions.size() == 1 ? "" : "s");
  for (const auto& [status, count] : counts) {
    if (status != ReadingStatus::kOk) text += fmt::format(", {} {} (left out)", count, ReadingStatusName(status));
  }
  return text + "\n";
}

std::string StabilityText(const measure::Stability& s) {
  std::string text =
      fmt::format("stability over {:.0f} s, {} readings: largest - smallest (deviation; noise of a reading)\n",
                  s.duration_s, s.readings);
  const std::array<double, measure::kDofs> unit = {units::arcsec, units::arcsec, units::arcsec, units::um};
  for (int d = 0; d < measure::kDofs; ++d) {
    text += fmt::format("  {}  {:7.3f} {:6}  ({:.3f}; {:.3f})\n", measure::kDofNames[d], s.range[d] / unit[d],
                        d < 3 ? "arcsec" : "um", s.deviation[d] / unit[d], s.noise[d] / unit[d]);
  }
  return text +
         fmt::format("  as a wavelength, the range of dy would be {:.2f} pm\n", s.wavelength_range_m / units::pm);
}

std::string VerificationText(const measure::Verification& v) {
  const auto line = [](const char* name, double rms, double max, double u) {
    return fmt::format("  {:4}  rms {:.3f} arcsec, largest {:.3f}, expected {:.3f}\n", name, rms / units::arcsec,
                       max / units::arcsec, u / units::arcsec);
  };
  return fmt::format("verification against the autocollimator, {} readings\n", v.readings) +
         line("yaw", v.rms_yaw_rad, v.max_yaw_rad, v.u_yaw_rad) +
         line("tilt", v.rms_tilt_rad, v.max_tilt_rad, v.u_tilt_rad);
}

std::string EstimateText(const char* name, const TableEstimate& estimate) {
  std::string text = fmt::format("{}\n", name);
  for (const Component c : estimate.components) {
    text += fmt::format("  {}  rms {:8.3f} {:6}  standard uncertainty of a position {:.3f}\n", NameOf(c),
                        Rms(estimate.value[c]) / UnitOf(c), UnitName(c), Rms(estimate.u[c]) / UnitOf(c));
  }
  return text;
}

std::string SeparationText(const separate::Separation& s) {
  std::string text = fmt::format("separation by the {} estimator, {} readings, {} degrees of freedom\n",
                                 EstimatorName(s.estimator), s.readings, s.dof);
  text += EstimateText("table under test: target (laboratory frame)", s.target);
  text += EstimateText("reference table (rotor frame)", s.reference);
  if (!s.not_separable.empty()) text += "not separable by this design (null space)\n";
  for (const auto& lost : s.not_separable) text += fmt::format("  {}: {}\n", lost.what, lost.why);
  for (const std::string& note : s.notes) text += fmt::format("note: {}\n", note);
  return text;
}

void Compare(const char* table, const TableEstimate& estimate, const TableErrors& truth, Score& score) {
  for (const Component c : estimate.components) {
    ComponentScore row;
    row.table = table;
    row.component = c;
    row.truth = truth[c];
    row.estimate = estimate.value[c];
    row.u = estimate.u[c];
    std::vector<double> error, normalised;
    for (std::size_t k = 0; k < row.truth.size(); ++k) {
      error.push_back(row.estimate[k] - row.truth[k]);
      normalised.push_back(error.back() / row.u[k]);
    }
    row.positions =
        static_cast<int>(std::count_if(error.begin(), error.end(), [](double e) { return !std::isnan(e); }));
    row.rms_truth = Rms(row.truth);
    row.rms_error = Rms(error);
    for (const double e : error) row.worst_error = std::fmax(row.worst_error, std::abs(e));
    row.rms_u = Rms(row.u);
    row.mean_chi2 = std::pow(Rms(normalised), 2);
    score.components.push_back(row);
  }
}

/// Means and lost orders are taken out of truth and estimate over the same positions.
TableErrors WhereEstimated(TableErrors truth, const TableEstimate& estimate) {
  for (std::size_t c = 0; c < kComponents; ++c) {
    const std::vector<double>& value = estimate.value.value[c];
    for (std::size_t i = 0; i < std::min(truth.value[c].size(), value.size()); ++i)
      if (std::isnan(value[i])) truth.value[c][i] = kNaN;
  }
  return truth;
}

}  // namespace

std::string Summary(const Analysis& analysis) {
  std::string text = ReadingCounts(analysis.motions);
  for (const std::string& note : analysis.calibration.notes) text += fmt::format("calibration: {}\n", note);
  if (analysis.verification.readings > 0) text += VerificationText(analysis.verification);
  if (analysis.stability.readings > 0) text += StabilityText(analysis.stability);
  if (analysis.separation) {
    text += SeparationText(*analysis.separation);
  } else {
    text += fmt::format("no separation: {}\n", analysis.not_separated);
  }
  return text;
}

Score CompareWithTruth(const separate::Separation& separation, const TableErrors& target,
                       const TableErrors& reference) {
  Score score;
  score.target_truth = separate::RemoveNotSeparable(WhereEstimated(target, separation.target),
                                                    separate::Table::kTarget, separation.not_separable);
  score.reference_truth = separate::RemoveNotSeparable(WhereEstimated(reference, separation.reference),
                                                       separate::Table::kReference, separation.not_separable);
  // What the published equations give of it is their invention: it is taken out of estimate and truth alike.
  const auto comparable = [&](TableEstimate estimate, separate::Table table) {
    estimate.value = separate::RemoveNotSeparable(estimate.value, table, separation.not_separable);
    return estimate;
  };
  Compare("target", comparable(separation.target, separate::Table::kTarget), score.target_truth, score);
  Compare("reference", comparable(separation.reference, separate::Table::kReference), score.reference_truth, score);
  return score;
}

std::string ScoreTable(const Score& score) {
  std::string text = "table      error  unit    truth rms  error rms  worst error  stated u  (error/u)^2\n";
  for (const ComponentScore& row : score.components) {
    const double unit = UnitOf(row.component);
    text += fmt::format("{:9}  {:5}  {:6}  {:9.4f}  {:9.4f}  {:11.4f}  {:8.4f}  {:11.3f}\n", row.table,
                        NameOf(row.component), UnitName(row.component), row.rms_truth / unit, row.rms_error / unit,
                        row.worst_error / unit, row.rms_u / unit, row.mean_chi2);
  }
  return text;
}

std::string PositionTable(const Score& score, const separate::Separation& separation) {
  std::string text;
  for (const auto* estimate : {&separation.target, &separation.reference}) {
    const std::string table = estimate == &separation.target ? "target" : "reference";
    text += fmt::format("{}: estimate ± standard uncertainty [truth]\nposition_deg", table);
    for (const Component c : estimate->components)
      text += fmt::format("{:>27}", fmt::format("{}_{}", NameOf(c), UnitName(c)));
    text += "\n";
    for (std::size_t k = 0; k < estimate->value.position_rad.size(); ++k) {
      text += fmt::format("{:12.2f}", estimate->value.position_rad[k] / units::deg);
      for (const ComponentScore& row : score.components) {
        if (row.table != table) continue;
        const double unit = UnitOf(row.component);
        text += fmt::format("  {:8.3f} ±{:6.3f} [{:6.2f}]", row.estimate[k] / unit, row.u[k] / unit,
                            row.truth[k] / unit);
      }
      text += "\n";
    }
  }
  return text;
}

nlohmann::json ToJson(const Score& score) {
  nlohmann::json json = nlohmann::json::object();
  for (const ComponentScore& row : score.components) {
    const double unit = UnitOf(row.component);
    const std::string suffix = std::string("_") + UnitName(row.component);
    json[row.table][NameOf(row.component)] = {{"positions", row.positions},
                                              {"rms_truth" + suffix, row.rms_truth / unit},
                                              {"rms_error" + suffix, row.rms_error / unit},
                                              {"worst_error" + suffix, row.worst_error / unit},
                                              {"rms_u" + suffix, row.rms_u / unit},
                                              {"mean_chi2", row.mean_chi2}};
  }
  return json;
}

std::vector<report::ScoredValue> ValuesOf(const Score& score) {
  std::vector<report::ScoredValue> values;
  for (const ComponentScore& row : score.components) {
    const double unit = UnitOf(row.component);
    const std::string name = fmt::format("{}.{}_{}", row.table, NameOf(row.component), UnitName(row.component));
    for (std::size_t k = 0; k < row.estimate.size(); ++k)
      values.push_back(
          {fmt::format("{}[{}]", name, k), row.estimate[k] / unit, row.u[k] / unit, row.truth[k] / unit});
  }
  return values;
}

}  // namespace twinbench::benches::rotary
