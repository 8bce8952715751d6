#include "twin/report/compensation_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "twin/report/json_units.h"
#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

using separate::AlikeOrder;
using separate::CompensatedLine;
using separate::Compensation;
using separate::CompensationCheck;
using separate::IndexErrors;
using separate::IndexLine;
using separate::LineFate;
using separate::RemainingError;

constexpr std::size_t kWidth = 100;
constexpr double kReversals = 3.0;  // least reversal that is said, in its u
constexpr std::size_t kMostAlike = 5;  // orders that a line could have as well

const char* FateName(LineFate fate) {
  switch (fate) {
    case LineFate::kCompensated:
      return "compensated";
    case LineFate::kAliased:
      return "aliased";
    case LineFate::kTooFine:
      return "too_fine";
    case LineFate::kChanging:
      return "changing";
    case LineFate::kNoGain:
      return "no_gain";
  }
  return "";
}

std::string AlikeText(const IndexLine& line) {
  std::string text = line.is_half_seen ? "one phase of it is not seen" : "";
  for (std::size_t i = 0; i < line.alike.size() && i < kMostAlike; ++i)
    text += fmt::format("{}order {} ({:.1f} %)", text.empty() ? "" : ", ", line.alike[i].order,
                        100.0 * line.alike[i].probability);
  return text;
}

std::string LinesTable(const Compensation& compensation) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [line, fate] : compensation.lines) {
    rows.push_back({fmt::format("{}", line.order), fmt::format("{:.3f}", line.Amplitude_rad() / units::arcsec),
                    fmt::format("{:.3f}", line.u_rad / units::arcsec),
                    fmt::format("{:.1f} %", 100.0 * line.probability), FateName(fate), AlikeText(line)});
  }
  return TextTable({{"order", true},
                    {"arcsec", true},
                    {"u", true},
                    {"this order", true},
                    {"what becomes of it"},
                    {"it could be as well"}},
                   rows, kWidth);
}

bool HasReversal(const IndexErrors& errors) {
  return std::abs(errors.reversal_rad) > kReversals * errors.u_reversal_rad;
}

std::string ReversalText(const IndexErrors& errors) {
  return fmt::format("forward and backward differ by {:.3f} ± {:.3f} arcsec in the mean, which the table leaves",
                     std::abs(errors.reversal_rad) / units::arcsec, errors.u_reversal_rad / units::arcsec);
}

/// Readings of one place differ by more than the table would leave of their means.
bool NoiseIsNotWhite(const RemainingError& r) { return r.noise_rms_rad > r.predicted_rms_rad; }

std::string Warnings(const IndexErrors& errors, const Compensation& compensation) {
  std::string text;
  if (HasReversal(errors)) text += Paragraph("warning: ", ReversalText(errors), 9, kWidth);
  const RemainingError& r = compensation.remaining;
  if (NoiseIsNotWhite(r)) {
    text += Paragraph("warning: ",
                      fmt::format("readings of one place differ by {:.3f} arcsec rms, which the prediction does not "
                                  "hold: they drift, slip or play together. Diagnose the run first",
                                  r.noise_rms_rad / units::arcsec),
                      9, kWidth);
  }
  const auto warn = [&](const std::vector<int>& orders, const std::string& why) {
    if (!orders.empty()) text += Paragraph("warning: ", fmt::format("{}: {}", OrderRanges(orders), why), 9, kWidth);
  };
  warn(compensation.Orders(LineFate::kAliased),
       "refused as aliased: the positions that were read do not tell it from other orders. Readings between these "
       "positions, uneven ones best, do");
  warn(compensation.Orders(LineFate::kTooFine), "refused: a table of so few entries cannot follow it");
  warn(compensation.Orders(LineFate::kChanging),
       "refused as changing: from turn to turn by as much as it is. Something drifts or slips; diagnose names it");
  warn(compensation.Orders(LineFate::kNoGain), "refused: nothing would be gained");
  warn(compensation.fit.doubled, "not distinguished at these positions from at least one other order");
  warn(compensation.fit.unseen, "not seen at these positions, at least in one phase");
  return text;
}

nlohmann::json LineJson(const CompensatedLine& compensated) {
  const IndexLine& line = compensated.line;
  nlohmann::json alike = nlohmann::json::array();
  for (const AlikeOrder& other : line.alike)
    alike.push_back({{"order", other.order}, {"probability", other.probability}});
  return {{"order", line.order},
          {"fate", FateName(compensated.fate)},
          {"cos_arcsec", Arcsec(line.cos_rad)},
          {"sin_arcsec", Arcsec(line.sin_rad)},
          {"amplitude_arcsec", Arcsec(line.Amplitude_rad())},
          {"u_arcsec", Arcsec(line.u_rad)},
          {"probability", line.probability},
          {"log_odds", In(1.0, line.log_odds)},
          {"half_seen", line.is_half_seen},
          {"alike", alike}};
}

}  // namespace

std::string OrderRanges(const std::vector<int>& orders) {
  std::string text;
  for (std::size_t first = 0, last = 0; first < orders.size(); first = last + 1) {
    for (last = first; last + 1 < orders.size() && orders[last + 1] == orders[last] + 1;) ++last;
    const std::string range =
        first == last ? fmt::format("{}", orders[first]) : fmt::format("{}-{}", orders[first], orders[last]);
    text += (text.empty() ? "" : ", ") + range;
  }
  return orders.size() > 1 ? "orders " + text : "order " + text;
}

std::string CompensationText(const IndexErrors& errors, const Compensation& compensation) {
  const RemainingError& r = compensation.remaining;
  std::string text = fmt::format("index error of {} at {} places{}\n\n", errors.table, errors.Count(),
                                 errors.commanded ? ", a compensation at work" : "");
  text += compensation.lines.empty() ? "no line stands out of the noise\n" : LinesTable(compensation);
  text += fmt::format("\n{:24}{:8.3f} arcsec rms\n{:24}{:8.3f} ± {:.3f} arcsec rms", "before",
                      r.before_rms_rad / units::arcsec, "predicted with the table",
                      r.predicted_rms_rad / units::arcsec, r.u_predicted_rms_rad / units::arcsec);
  if (std::isfinite(r.noise_rms_rad) && !NoiseIsNotWhite(r))
    text += fmt::format(", {:.3f} of it noise of the readings", r.noise_rms_rad / units::arcsec);
  if (r.refused_rms_rad > 0.0) text += fmt::format(", {:.3f} refused lines", r.refused_rms_rad / units::arcsec);
  text += "\na correction is added to what is commanded";
  if (errors.table == "device") text += "; from what the device reads it is subtracted";
  return text + "\n" + Warnings(errors, compensation);
}

std::string CompensationCheckText(const CompensationCheck& check) {
  return fmt::format(
      "\ncheck at {} places: before {:.3f}, predicted {:.3f}, measured again {:.3f} arcsec rms\n"
      "predicted / measured {:.3f} ± {:.3f}; {}\n",
      check.places, check.before_rms_rad / units::arcsec, check.predicted_rms_rad / units::arcsec,
      check.remeasured_rms_rad / units::arcsec, check.Ratio(), check.u_ratio,
      check.IsBetter() ? "no worse than before" : "WORSE than before: do not use the table");
}

nlohmann::json CompensationJson(const IndexErrors& errors, const Compensation& compensation,
                                const CompensationCheck* check) {
  const RemainingError& r = compensation.remaining;
  nlohmann::json lines = nlohmann::json::array();
  for (const CompensatedLine& line : compensation.lines) lines.push_back(LineJson(line));
  nlohmann::json json = {{"table", errors.table},
                         {"places", errors.Count()},
                         {"points", compensation.table.position_rad.size()},
                         {"lines", lines},
                         {"doubled_orders", compensation.fit.doubled},
                         {"unseen_orders", compensation.fit.unseen},
                         {"aliased", compensation.IsAliased()},
                         {"before_rms_arcsec", Arcsec(r.before_rms_rad)},
                         {"predicted_rms_arcsec", Arcsec(r.predicted_rms_rad)},
                         {"u_predicted_rms_arcsec", Arcsec(r.u_predicted_rms_rad)},
                         {"refused_rms_arcsec", Arcsec(r.refused_rms_rad)},
                         {"noise_rms_arcsec", Arcsec(r.noise_rms_rad)},
                         {"reversal_arcsec", Arcsec(errors.reversal_rad)},
                         {"u_reversal_arcsec", Arcsec(errors.u_reversal_rad)}};
  if (check) {
    json["check"] = {{"places", check->places},
                     {"before_rms_arcsec", Arcsec(check->before_rms_rad)},
                     {"predicted_rms_arcsec", Arcsec(check->predicted_rms_rad)},
                     {"remeasured_rms_arcsec", Arcsec(check->remeasured_rms_rad)},
                     {"ratio", In(1.0, check->Ratio())},
                     {"u_ratio", In(1.0, check->u_ratio)},
                     {"no_worse", check->IsBetter()}};
  }
  return json;
}

std::vector<std::string> CompensationComments(const IndexErrors& errors, const Compensation& compensation,
                                              const std::string& source) {
  const RemainingError& r = compensation.remaining;
  const std::vector<int> compensated = compensation.Orders(LineFate::kCompensated);
  const std::vector<int> aliased = compensation.Orders(LineFate::kAliased);
  std::vector<std::string> comments = {
      "compensation of the index error in " + source,
      compensated.empty() ? "no order compensated" : OrderRanges(compensated) + " compensated",
      fmt::format("{:.3f} arcsec rms before, {:.3f} predicted", r.before_rms_rad / units::arcsec,
                  r.predicted_rms_rad / units::arcsec)};
  if (!aliased.empty()) comments.push_back(OrderRanges(aliased) + " refused as aliased");
  if (HasReversal(errors)) comments.push_back(ReversalText(errors));
  return comments;
}

}  // namespace twinbench::report
