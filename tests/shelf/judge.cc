#include "tests/shelf/judge.h"

#include "tests/hidden/judge.h"
#include "twin/core/units.h"
#include "twin/diagnose/cause_groups.h"

namespace twinbench::shelf {
namespace {

using diagnose::Cause, diagnose::Diagnosis;
using Causes = std::vector<Cause>;

constexpr double kClose = 0.05, kRoughly = 0.1, kUncertainties = 3.0;

bool Contains(const std::vector<std::string>& all, const std::string& one) {
  return std::ranges::find(all, one) != all.end();
}

bool SpeaksOf(const std::string& text, const std::vector<std::string>& words) {
  return std::ranges::any_of(words, [&](const std::string& word) {
    return word.starts_with('^') ? text.starts_with(word.substr(1)) : text.find(word) != std::string::npos;
  });
}

/// By name and order, whatever its size.
bool Matches(const Cause& cause, const Expected& expected) {
  if (Contains(expected.effects, cause.effect)) return true;
  if (!std::isfinite(expected.order)) return false;
  if (cause.effect == "signal_clipping") return std::abs(std::remainder(expected.order, 4.0)) < 1e-9;
  return IsSameOrder(OrderOf(cause), expected.order);
}

bool IsNear(const Size& told, const Size& truth, double share) {
  const double allowed = std::max(share * truth.value, std::isfinite(told.u) ? kUncertainties * told.u : 0.0);
  return std::abs(told.value - truth.value) <= allowed;
}

std::vector<Size> RightSizes(const Expected& expected, const std::string& kind) {
  std::vector<Size> sizes = {InSI(expected.size, expected.unit)};
  for (const auto& [size, unit] : expected.others) sizes.push_back(InSI(size, unit));
  std::erase_if(sizes, [&](const Size& size) { return size.kind != kind; });
  return sizes;
}

/// True too of a size of another kind than all that are known.
bool IsRightSize(const std::optional<Size>& told, const Expected& expected, double share) {
  if (!told) return false;
  const std::vector<Size> sizes = RightSizes(expected, told->kind);
  return sizes.empty() || std::ranges::any_of(sizes, [&](const Size& size) { return IsNear(*told, size, share); });
}

/// Signals that are cut off have overtones of their own: what a wave of such an order adds to them is not its whole
/// size.
bool AddsToClipping(const Cause& cause, const Causes& all) {
  const double order = OrderOf(cause);
  return cause.effect == "periodic" && std::abs(std::remainder(order, 4.0)) < 1e-9 &&
         std::ranges::find(all, "signal_clipping", &Cause::effect) != all.end();
}

bool HasRightSize(const Cause& cause, const Expected& expected, const Causes& all, double share) {
  if (!std::isfinite(expected.size) || AddsToClipping(cause, all)) return true;
  const std::optional<Size> told = SizeOf(cause, expected);
  return !told || IsRightSize(told, expected, share) ||
         IsRightSize(AmplitudeTogether(all, expected.order), expected, share);
}

double Closeness(const Expected& expected) {
  return expected.approximate || !expected.IsWanted() ? kRoughly : kClose;
}

/// "0.0403 for 0.0388 deg".
std::string SizesOf(const Cause& cause, const Expected& expected) {
  const std::optional<Size> told = SizeOf(cause, expected);
  if (!told) return "";
  double size = expected.size;
  std::string unit = expected.unit;
  for (const auto& [other, its_unit] : expected.others) {
    if (InSI(size, unit).kind != told->kind) size = other, unit = its_unit;
  }
  return fmt::format("{:.4g} for {:.4g} {}", told->value / InSI(1.0, unit).value, size, unit);
}

double Together(const Causes& causes, const diagnose::CauseGroup& group) {
  double sum = 0.0;
  for (const std::size_t k : group) sum += causes[k].probability;
  return sum;
}

/// What is wrong with how a cause is named; empty if nothing.
std::string WrongWith(const Expected& expected, const Diagnosis& d) {
  if (diagnose::HasUnmodelled(d)) {
    for (const std::string& part : hidden::Split(d.unknown.signature, " | ")) {
      if (SpeaksOf(part, expected.words)) return "";
    }
  }
  std::string why = InWords(expected) + " is missing";
  for (const diagnose::CauseGroup& group : diagnose::GroupsOf(d.causes)) {
    bool is_there = false, is_of_size = true;
    for (const std::size_t k : group) {
      if (!Matches(d.causes[k], expected)) continue;
      is_there = true;
      if (HasRightSize(d.causes[k], expected, d.causes, Closeness(expected))) continue;
      is_of_size = false;
      why = fmt::format("{} has the size {}", d.causes[k].effect, SizesOf(d.causes[k], expected));
    }
    if (!is_there || !is_of_size) continue;
    const double p = Together(d.causes, group);
    if (p >= kNamed) return "";
    why = fmt::format("{} has {:.2f} only", InWords(expected), p);
  }
  return why;
}

bool IsSmallOrder(const Cause& cause, const Truth& truth, const Causes& all) {
  const double order = OrderOf(cause);
  const std::optional<Size> size = AmplitudeOf(cause, order);
  if (size && size->value <= truth.any_order_below_deg * units::deg) return true;
  return std::ranges::any_of(truth.orders, [&](const auto& one) {
    return IsSameOrder(order, one.first) &&
           (!size || AddsToClipping(cause, all) || IsNear(*size, InSI(one.second, "deg"), kRoughly));
  });
}

/// The size of a cause that must be named is another question.
bool IsThere(const Cause& cause, const Truth& truth, const Causes& all) {
  if (Contains(truth.effects, cause.effect) || IsSmallOrder(cause, truth, all)) return true;
  return std::ranges::any_of(truth.causes, [&](const Expected& expected) {
    return Matches(cause, expected) && (expected.IsWanted() || HasRightSize(cause, expected, all, kRoughly));
  });
}

/// Words of unmodelled parts that describe what has a name: to say them is no answer, and not false.
std::vector<std::string> DescriptionsOf(const Expected& expected) {
  const std::map<std::string, std::vector<std::string>> words = {
      {"latency", {"velocity", "speed"}}, {"backlash", {"direction"}},     {"hysteresis", {"direction"}},
      {"drift", {"function of time"}},    {"slip", {"step at", "offset"}}, {"settling", {"function of time"}},
      {"scale", {"linear trend"}},        {"outliers", {"step", "offset"}}};
  std::vector<std::string> described = expected.words;
  if (std::isfinite(expected.order)) described.push_back(fmt::format("order {:.0f} ", expected.order));
  for (const std::string& effect : expected.effects) {
    const auto found = words.find(effect);
    if (found != words.end()) described.insert(described.end(), found->second.begin(), found->second.end());
  }
  return described;
}

bool IsDescribed(const std::string& part, const Truth& truth) {
  if (truth.has_rest || SpeaksOf(part, truth.words)) return true;
  if (std::ranges::any_of(
          truth.orders, [&](const auto& one) { return SpeaksOf(part, {fmt::format("order {:.0f} ", one.first)}); }))
    return true;
  return std::ranges::any_of(truth.causes,
                             [&](const Expected& expected) { return SpeaksOf(part, DescriptionsOf(expected)); });
}

/// "periodic of order 8", "scale".
std::string NameOf(const Cause& cause) {
  const double order = OrderOf(cause);
  return cause.effect + (std::isfinite(order) ? fmt::format(" of order {:g}", order) : "");
}

/// What is said and is not there, at a probability or more.
std::vector<std::string> FalseNames(const Truth& truth, const Diagnosis& d, double from) {
  std::vector<std::string> names;
  for (const diagnose::CauseGroup& group : diagnose::GroupsOf(d.causes)) {
    const bool none =
        std::ranges::none_of(group, [&](std::size_t k) { return IsThere(d.causes[k], truth, d.causes); });
    if (none && Together(d.causes, group) >= from) names.push_back(NameOf(d.causes[group.front()]));
    for (const std::size_t k : group) {
      const Cause& cause = d.causes[k];
      if (!none && cause.probability >= from && !IsThere(cause, truth, d.causes)) names.push_back(NameOf(cause));
    }
  }
  return names;
}

std::vector<std::string> FalseParts(const Truth& truth, const Diagnosis& d, double from) {
  if (d.unknown.probability < from || !diagnose::HasUnmodelled(d)) return {};
  std::vector<std::string> parts = hidden::Split(d.unknown.signature, " | ");
  std::erase_if(parts, [&](const std::string& part) { return IsDescribed(part, truth); });
  return parts;
}

}  // namespace

std::string InWords(const Expected& expected) {
  if (std::isfinite(expected.order)) return fmt::format("order {:g}", expected.order);
  if (!expected.effects.empty())
    return expected.effects.front() + (expected.parameter.empty() ? "" : " " + expected.parameter);
  if (expected.words.empty()) return "nothing";
  const std::string& word = expected.words.front();
  return word.substr(word.starts_with('^') ? 1 : 0);
}

std::string InWords(const Truth& truth) {
  std::string text;
  for (const Expected& expected : truth.causes) {
    if (expected.IsWanted()) text += (text.empty() ? "" : " + ") + InWords(expected);
  }
  return text.empty() ? "none" : text;
}

Judged Judge(const Truth& truth, const Diagnosis& diagnosis) {
  Diagnosis said = diagnosis;
  if (said.verdict == diagnose::Verdict::kNone) said.causes.clear(), said.unknown = {};
  std::vector<std::string> why;
  for (const Expected& expected : truth.causes) {
    const std::string wrong = expected.IsWanted() ? WrongWith(expected, said) : "";
    if (!wrong.empty()) why.push_back(wrong);
  }
  Judged judged;
  if (truth.nothing_else) {
    const bool is_clean = InWords(truth) == "none";
    std::vector<std::string> wrong = FalseNames(truth, said, is_clean ? kNamed : kSure);
    const std::vector<std::string> parts = FalseParts(truth, said, is_clean ? kNamed : kSure);
    wrong.insert(wrong.end(), parts.begin(), parts.end());
    for (const std::string& name : wrong) why.push_back(name + " is not there");
    judged.is_sure_wrong = !FalseNames(truth, said, kSure).empty();
  }
  judged.is_right = why.empty();
  judged.why = fmt::format("{}", fmt::join(why, "; "));
  return judged;
}

}  // namespace twinbench::shelf
