#include "twin/benches/turntable_autocollimator/parts_of_results.h"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "twin/core/units.h"
#include "twin/report/json_units.h"
#include "twin/separate/far_on_course.h"

namespace twinbench::benches::turntable {
namespace {

using separate::turntable::CollimatorSweep;
using separate::turntable::SweptAxis;
using separate::turntable::SweptRipple;
using separate::turntable::SweptValue;

constexpr const char* kOtherSense =
    "the autocollimator counts against the reference: errors of a table come out with the other sign unless one of "
    "them is turned round";
constexpr const char* kDoesNotFollow = "the autocollimator does not follow the reference: it has no scale here";

nlohmann::json SweptJson(const SweptValue& v, double unit) {
  return {{"value", report::In(unit, v.value)}, {"u", report::In(unit, v.u)}};
}

nlohmann::json RipplesJson(const std::vector<SweptRipple>& ripples) {
  nlohmann::json json = nlohmann::json::array();
  for (const SweptRipple& r : ripples)
    json.push_back({{"period_arcsec", report::Arcsec(r.period_rad.value)},
                    {"u_period_arcsec", report::Arcsec(r.period_rad.u)},
                    {"amplitude_arcsec", report::Arcsec(r.amplitude_rad.value)},
                    {"u_amplitude_arcsec", report::Arcsec(r.amplitude_rad.u)}});
  return json;
}

nlohmann::json SweepNotes(const SweptAxis& axis) {
  nlohmann::json notes = nlohmann::json::array();
  if (axis.Sense() < 0) notes.push_back(kOtherSense);
  if (axis.Sense() == 0) notes.push_back(kDoesNotFollow);
  return notes;
}

nlohmann::json SweepJson(const CollimatorSweep& sweep) {
  const SweptAxis& axis = sweep.axis;
  nlohmann::json json = {{"readings", sweep.readings},
                         {"axis", sweep.is_along_y ? "y" : "x"},
                         {"reference_from_arcsec", report::Arcsec(sweep.lowest_rad)},
                         {"reference_to_arcsec", report::Arcsec(sweep.highest_rad)},
                         {"ripple", RipplesJson(axis.ripples)},
                         {"shortest_ripple_arcsec", report::Arcsec(axis.shortest_period_rad)},
                         {"residual_rms_arcsec", report::Arcsec(axis.residual_rms_rad)},
                         {"dof", axis.dof},
                         {"notes", SweepNotes(axis)}};
  if (axis.Sense() == 0) return json;
  json["sense"] = axis.Sense();
  json["scale"] = SweptJson(axis.scale, 1.0);
  if (std::isfinite(axis.scale_in_middle.value)) json["scale_in_middle"] = SweptJson(axis.scale_in_middle, 1.0);
  if (std::isfinite(axis.bend_rad.value)) json["nonlinearity_arcsec"] = SweptJson(axis.bend_rad, units::arcsec);
  if (std::isfinite(axis.reversal_rad.value)) json["reversal_arcsec"] = SweptJson(axis.reversal_rad, units::arcsec);
  if (sweep.crosstalk) json["crosstalk_mrad"] = SweptJson(*sweep.crosstalk, units::mrad);
  return json;
}

std::string SweptLine(const char* name, const SweptValue& v, double unit, const char* unit_name, int digits) {
  return fmt::format("{:22}  {:.{}f} ± {:.{}f}{}\n", name, v.value / unit, digits, v.u / unit, digits, unit_name);
}

std::string SweepText(const CollimatorSweep& sweep) {
  const SweptAxis& axis = sweep.axis;
  std::string text = fmt::format("{} readings of a sweep of the autocollimator's {} from {:.2f} to {:.2f} arcsec\n",
                                 sweep.readings, sweep.is_along_y ? "y" : "x", sweep.lowest_rad / units::arcsec,
                                 sweep.highest_rad / units::arcsec);
  if (axis.Sense() != 0) text += SweptLine("scale", axis.scale, 1.0, "", 6);
  if (std::isfinite(axis.scale_in_middle.value))
    text += SweptLine("scale in the middle", axis.scale_in_middle, 1.0, "", 6);
  if (std::isfinite(axis.bend_rad.value))
    text += SweptLine("off a straight line", axis.bend_rad, units::arcsec, " arcsec at most", 3);
  for (const SweptRipple& r : axis.ripples)
    text += SweptLine("ripple", r.amplitude_rad, units::arcsec,
                      fmt::format(" arcsec, period {:.3f} ± {:.3f} arcsec", r.period_rad.value / units::arcsec,
                                  r.period_rad.u / units::arcsec)
                          .c_str(),
                      4);
  if (axis.ripples.empty())
    text += fmt::format("ripple                  none from {:.2f} arcsec of period on\n",
                        axis.shortest_period_rad / units::arcsec);
  if (std::isfinite(axis.reversal_rad.value))
    text += SweptLine("forward less backward", axis.reversal_rad, units::arcsec, " arcsec", 4);
  if (sweep.crosstalk)
    text += SweptLine(sweep.is_along_y ? "x by y" : "y by x", *sweep.crosstalk, units::mrad, " mrad", 3);
  text += fmt::format("residuals               {:.4f} arcsec rms\n", axis.residual_rms_rad / units::arcsec);
  for (const auto& note : SweepNotes(axis)) text += fmt::format("note: {}\n", note.get<std::string>());
  return text;
}

/// What one axis shows less the line through all it shows, by passes: a line of steps would be the least that readings differ by.
std::vector<std::vector<separate::OnCourse>> OffTheLine(const std::vector<Reading>& readings, double Reading::*shown_rad) {
  std::map<std::pair<int, int>, std::vector<separate::OnCourse>> passes;
  double count = 0.0, mean_rad = 0.0, mean_shown_rad = 0.0, squares = 0.0, products = 0.0;
  for (const Reading& r : readings) {
    if (r.phase != Phase::kCalibration || r.status != ReadingStatus::kOk || !std::isfinite(r.*shown_rad) || !std::isfinite(r.target_rad)) continue;
    passes[{r.setup, r.pass}].push_back({r.reading, r.target_rad, r.*shown_rad});
    count += 1.0;
    const double from_rad = r.target_rad - mean_rad;
    mean_rad += from_rad / count;
    mean_shown_rad += (r.*shown_rad - mean_shown_rad) / count;
    squares += from_rad * (r.target_rad - mean_rad);
    products += from_rad * (r.*shown_rad - mean_shown_rad);
  }
  std::vector<std::vector<separate::OnCourse>> off;
  for (auto& [of, pass] : passes) {
    for (separate::OnCourse& one : pass) one.value -= squares > 0.0 ? products / squares * one.angle_rad : 0.0;
    off.push_back(std::move(pass));
  }
  return off;
}

}  // namespace

std::vector<Reading> WithoutFarOfSweep(std::vector<Reading> readings, report::Evaluation& evaluation) {
  constexpr double kLeast_rad = 1e-12;
  std::set<int> numbers;
  for (const auto& [name, shown_rad] : {std::pair{"x", &Reading::autocollimator_yaw_rad}, {"y", &Reading::autocollimator_tilt_rad}}) {
    for (const separate::FarOnCourse& far :
         separate::FarOnCourses(OffTheLine(readings, shown_rad), kLeast_rad, [](double, double) { return false; })) {
      numbers.insert(far.reading);
      evaluation.results["far"].push_back(
          {{"reading", far.reading}, {"axis", name}, {"reference_arcsec", report::Arcsec(far.angle_rad)}, {"off_arcsec", report::Arcsec(far.off)}, {"times_scatter", far.times}});
      evaluation.summary += fmt::format("doubtful: {} of reading {} (reference at {:.6g} arcsec) lies {:.3g} arcsec from the curve through its neighbours, {:.2g} "
                                        "times the scatter of the others, and in no other pass: left out\n",
                                        name, far.reading, far.angle_rad / units::arcsec, far.off / units::arcsec, far.times);
    }
  }
  std::erase_if(readings, [&](const Reading& r) { return numbers.contains(r.reading); });
  return readings;
}

void AddSweep(const CollimatorSweep& sweep, report::Evaluation& evaluation) {
  evaluation.results["autocollimator"] = SweepJson(sweep);
  evaluation.summary += SweepText(sweep);
}

}  // namespace twinbench::benches::turntable
