#include "twin/report/certificate/certified.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "twin/report/certificate/dsi_unit.h"
#include "twin/report/certificate/not_told_apart.h"
#include "twin/report/page/named_numbers.h"

namespace twinbench::certificate {
namespace {

using nlohmann::json;
using report::NumberAt;
using report::NumbersAt;
using Numbers = std::vector<double>;

constexpr double kNormal95 = 1.959963984540054;
constexpr std::array kAngles = {"position_deg", "commanded_deg", "order"};
constexpr std::array kPose = {"x_mm", "y_mm", "z_mm", "a_deg", "b_deg"};

/// One list or one number with its uncertainty, before anybody has asked whether it may be stated.
struct Candidate {
  const CertifiedPart& part;
  std::string path;  // of the list in results.json, as the uncertainty budget names it
  std::string title, quantity, unit;
  Numbers values, u;
  std::vector<std::string> status = {};
  std::vector<Abscissa> where = {};
  std::string note = {};
};

class Taker {
 public:
  explicit Taker(const json& results) : results_(results), lost_(AllNotToldApart(results)) {}

  void Take(const CertifiedPart& part) { Enter(part, results_, "", part.path, part.title); }

  Certified Taken() {
    for (const NotToldApart& one : lost_) taken_.left_out.push_back({one.what, one.why});
    return std::move(taken_);
  }

 private:
  void Enter(const CertifiedPart& part, const json& node, const std::string& path, const std::string& rest, const std::string& title) {
    if (rest.empty()) return TakeObject(part, node, path, title);
    const std::size_t end = rest.find('.');
    std::string key = rest.substr(0, end);
    const std::string left = end == std::string::npos ? "" : rest.substr(end + 1), inside = path.empty() ? key : path + "." + key;
    const bool is_list = key.ends_with("[]");
    if (is_list) key.resize(key.size() - 2);
    if (!node.is_object() || !node.contains(key)) return;
    const json& child = node.at(key);
    if (!is_list) return Enter(part, child, inside, left, title);
    if (!child.is_array()) return;
    if (left.empty() && IsListOfOrders(child)) return TakeObject(part, ListsOf(child), inside, title);
    for (const json& one : child) {
      missing_ = MissingOf(one);
      Enter(part, one, inside, left, title + WhichOf(one));
    }
    missing_.clear();
  }

  static bool IsListOfOrders(const json& terms) {
    return !terms.empty() && std::ranges::all_of(terms, [](const json& t) { return t.is_object() && t.contains("order") && t.at("order").is_number(); });
  }

  /// [{"order": 1, "amplitude_arcsec": 6.1, ...}, ...] as lists beside each other.
  static json ListsOf(const json& terms) {
    json lists = json::object();
    for (const json& term : terms) {
      for (const auto& [key, value] : term.items()) {
        if (value.is_number() || value.is_null()) lists[key].push_back(value);
      }
    }
    return lists;
  }

  /// What tells one object of a list from the others.
  static std::string WhichOf(const json& object) {
    std::string words;
    for (const char* key : {"table", "motion"}) {
      if (const std::string value = report::TextAt(object, key); !value.empty()) words += ", " + value;
    }
    for (const auto& [key, spoken] : std::initializer_list<std::pair<const char*, const char*>>{
             {"setup", "mounting"}, {"direction", "direction"}, {"radius_mm", "radius [mm]"}, {"feed_mm_min", "feed [mm/min]"}, {"head_deg", "head [deg]"}}) {
      if (const double value = NumberAt(object, key); std::isfinite(value)) words += fmt::format(", {} {}", spoken, value);
    }
    return words;
  }

  /// What the readings lack for the standard that the values are named after; empty: nothing.
  static std::string MissingOf(const json& object) {
    std::string words;
    if (!object.contains("missing") || !object.at("missing").is_array()) return words;
    for (const json& what : object.at("missing"))
      if (what.is_string()) words += (words.empty() ? "" : "; ") + what.get<std::string>();
    return words;
  }

  void TakeObject(const CertifiedPart& part, const json& object, const std::string& path, const std::string& title) {
    if (!object.is_object()) return;
    for (const auto& [key, value] : object.items()) {
      if (key.starts_with("u_")) continue;
      if (value.is_object()) TakeNamed(part, value, path + "." + key, title + ", " + key);
      else if (object.contains("u_" + key)) TakeNumbers(part, object, key, path, title);
    }
  }

  /// {"value": 0.1, "u": 0.01, "unit": "um"} or {"value_arcsec": 0.1, "u_arcsec": 0.01, "bias_arcsec": 0.02}
  void TakeNamed(const CertifiedPart& part, const json& named, const std::string& path, const std::string& title) {
    for (const auto& [key, value] : named.items()) {
      if (!key.starts_with("value")) continue;
      const std::string unit = key == "value" ? report::TextAt(named, "unit") : key.substr(6);
      Candidate candidate{part, path, title, "", unit, {NumberAt(named, key)}, {NumberAt(named, "u" + key.substr(5))}};
      const double u = candidate.u.front();
      if (const double bias = NumberAt(named, "bias" + key.substr(5)); std::isfinite(bias))
        candidate.note = fmt::format("scatter of the readings adds an estimated {} {} to the value, which is not taken out", report::NumberText(bias, u), unit);
      Judge(candidate);
    }
  }

  void TakeNumbers(const CertifiedPart& part, const json& object, const std::string& key, const std::string& path, const std::string& title) {
    const auto [quantity, unit] = report::NameAndUnit(key);
    Candidate candidate{part, path + "." + key, title + ", " + quantity, quantity, unit, {}, {}};
    if (const auto values = NumbersAt(object, key), u = NumbersAt(object, "u_" + key); values && u && values->size() == u->size()) {
      candidate.values = *values, candidate.u = *u;
      candidate.where = Whereabouts(object, values->size());
      candidate.status = StatusOf(object, values->size());
    } else {
      candidate.values = {NumberAt(object, key)}, candidate.u = {NumberAt(object, "u_" + key)};
    }
    Judge(candidate);
  }

  static void AddAbscissa(const json& object, const std::string& key, std::size_t size, std::vector<Abscissa>& where) {
    const auto numbers = NumbersAt(object, key);
    if (!numbers || numbers->size() != size) return;
    const auto [name, unit] = report::NameAndUnit(key);
    where.push_back({name, *DsiUnit(unit), *numbers});
  }

  static std::vector<Abscissa> Whereabouts(const json& object, std::size_t size) {
    std::vector<Abscissa> where;
    for (const char* key : kAngles) AddAbscissa(object, key, size, where);
    for (const char* key : kPose) AddAbscissa(object, key, size, where);
    return where;
  }

  static std::vector<std::string> StatusOf(const json& object, std::size_t size) {
    if (!object.contains("status") || !object.at("status").is_array() || object.at("status").size() != size) return {};
    return object.at("status").get<std::vector<std::string>>();
  }

  void LeaveOut(const Candidate& candidate, const std::string& why) { taken_.left_out.push_back({candidate.title, why}); }

  void Judge(const Candidate& candidate) {
    const std::optional<std::string> unit = DsiUnit(candidate.unit);
    if (!unit) return LeaveOut(candidate, "its unit, " + candidate.unit + ", is none that the D-SI knows");
    const bool is_spectrum = !candidate.where.empty() && candidate.where.front().name == "order";
    std::string note = candidate.note;
    if (!missing_.empty()) note += (note.empty() ? "" : "; ") + fmt::format("not in full after {}: {}", candidate.part.norm, missing_);
    for (const NotToldApart& one : lost_) {
      if (candidate.part.subject.empty() || !one.Concerns(candidate.part.subject, candidate.quantity)) continue;
      if (!one.order || (one.IsSum() && !is_spectrum)) return LeaveOut(candidate, one.what + ": " + one.why);
      if (!is_spectrum) note += fmt::format("{}not in these values: order {}, {}", note.empty() ? "" : "; ", *one.order, one.why);
    }
    CertifiedQuantity kept{candidate.title, note, missing_.empty() ? candidate.part.norm : "", candidate.unit, *unit, {}, {}};
    kept.coverage_factor = CoverageOf(candidate.path);
    kept.is_normal = std::abs(kept.coverage_factor - kNormal95) < 1e-6;
    Sift(candidate, is_spectrum, kept);
    if (!kept.values.empty()) taken_.quantities.push_back(kept);
  }

  bool IsLostLine(const Candidate& candidate, double order) const {
    return std::ranges::any_of(lost_, [&](const NotToldApart& one) {
      return one.order == order && !candidate.part.subject.empty() && one.Concerns(candidate.part.subject, candidate.quantity);
    });
  }

  /// Why one of the values may not be stated; empty: it may.
  std::string AgainstOne(const Candidate& c, std::size_t i, bool is_spectrum, double k) const {
    if (!std::isfinite(c.values[i])) return "not available";
    if (!std::isfinite(c.u[i]) || c.u[i] <= 0.0) return "no uncertainty is stated";
    if (!c.status.empty() && c.status[i] != "ok") return "its status is " + c.status[i];
    if (is_spectrum && IsLostLine(c, c.where.front().values[i])) return "the order is not separable";
    if (c.unit == "deg" && (c.quantity.starts_with("phase") || c.title.ends_with("azimuth_deg")) && k * c.u[i] >= 180.0) return "known to half a turn or worse";
    return "";
  }

  void Sift(const Candidate& c, bool is_spectrum, CertifiedQuantity& kept) {
    for (const Abscissa& a : c.where) kept.where.push_back({a.name, a.dsi_unit, {}});
    std::vector<std::pair<std::string, int>> reasons;
    for (std::size_t i = 0; i < c.values.size(); ++i) {
      if (const std::string why = AgainstOne(c, i, is_spectrum, kept.coverage_factor); !why.empty()) {
        Count(reasons, why);
        continue;
      }
      kept.values.push_back(c.values[i]);
      kept.expanded.push_back(kept.coverage_factor * c.u[i]);
      for (std::size_t a = 0; a < c.where.size(); ++a) kept.where[a].values.push_back(c.where[a].values[i]);
    }
    for (const auto& [why, count] : reasons) LeaveOut(c, c.where.empty() ? why : fmt::format("{} of {} values: {}", count, c.values.size(), why));
  }

  static void Count(std::vector<std::pair<std::string, int>>& reasons, const std::string& why) {
    for (auto& [known, count] : reasons) {
      if (known == why) {
        ++count;
        return;
      }
    }
    reasons.emplace_back(why, 1);
  }

  double CoverageOf(const std::string& path) const {
    if (!results_.contains("uncertainty_budget")) return kNormal95;
    for (const json& budget : results_.at("uncertainty_budget")) {
      if (budget.value("name", "") == path && std::isfinite(NumberAt(budget, "k"))) return NumberAt(budget, "k");
    }
    return kNormal95;
  }

  const json& results_;
  std::vector<NotToldApart> lost_;
  std::string missing_;  // of the part that is being taken
  Certified taken_;
};

}  // namespace

Certified TakeCertified(const json& results, const CertifiedBench& bench) {
  Taker taker(results);
  for (const CertifiedPart& part : bench.parts) taker.Take(part);
  return taker.Taken();
}

}  // namespace twinbench::certificate
