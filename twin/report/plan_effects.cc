#include "twin/report/plan_effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/diagnose/isolability.h"
#include "twin/diagnose/words.h"
#include "twin/report/diagnosis_tables.h"
#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

using diagnose::Confusable;
using diagnose::Isolability;
using diagnose::ShownCause;
using Json = nlohmann::json;

constexpr std::size_t kEffectsWidth = 118;

std::string PlaceOf(const ShownCause& cause) {
  return diagnose::Place(cause.effect, cause.where);
}

std::string SizeOf(const ShownCause& cause, double times) {
  diagnose::ParameterEstimate size = cause.smallest;
  size.value *= times;
  return diagnose::NameAndSize(size);
}

/// The last words of a result's name, which is where its unit stands.
std::string ShortName(const std::string& name) {
  const std::size_t last = name.rfind('.');
  if (last == std::string::npos || last == 0) return name;
  const std::size_t before = name.rfind('.', last - 1);
  return before == std::string::npos ? name : name.substr(before + 1);
}

/// The results that it moves most, by their own uncertainty.
std::string BiasLines(const plan::Unseen& unseen) {
  constexpr std::size_t kMostTold = 2;
  constexpr double kNegligible = 0.1;  // of u
  if (!unseen.not_known.empty()) return "not known: " + unseen.not_known;
  std::string lines;
  for (std::size_t k = 0; k < std::min(kMostTold, unseen.biases.size()); ++k) {
    const plan::Bias& bias = unseen.biases[k];
    if (bias.per_u < kNegligible) break;
    lines += fmt::format("{}{} by {:.2g} ({:.1f} u)", lines.empty() ? "" : "\n", ShortName(bias.name), bias.rms,
                         bias.per_u);
  }
  return lines.empty() ? "no result by 0.1 u" : lines;
}

constexpr double kSurelyFound = 2.0;  // times the smallest size

/// The longest first. What is told apart as soon as it is surely found is not worth a line.
std::vector<Confusable> RivalsOf(const Isolability& isolability, std::size_t present) {
  std::vector<Confusable> rivals;
  for (const Confusable& pair : isolability.confusable) {
    if (pair.present == present && pair.surely_told_from > kSurelyFound) rivals.push_back(pair);
  }
  std::ranges::stable_sort(rivals, std::ranges::greater{}, [](const Confusable& pair) {
    return std::pair(pair.told_from, pair.surely_told_from);
  });
  return rivals;
}

std::string RivalLines(const Isolability& isolability, std::size_t present) {
  constexpr std::size_t kMostNamed = 3;
  const std::vector<Confusable> rivals = RivalsOf(isolability, present);
  std::string lines;
  for (std::size_t k = 0; k < std::min(kMostNamed, rivals.size()); ++k) {
    lines += (lines.empty() ? "" : "\n") + PlaceOf(isolability.causes[rivals[k].blamed]);
    if (rivals[k].told_from <= kSurelyFound) {
      lines += " in another shape";
    } else if (std::isfinite(rivals[k].told_from)) {
      lines += fmt::format(" below {}", SizeOf(isolability.causes[present], rivals[k].told_from));
    }
  }
  if (rivals.size() > kMostNamed) lines += fmt::format("\nand {} more", rivals.size() - kMostNamed);
  return lines;
}

const plan::Unseen* UnseenOf(const PlannedEffects& effects, const ShownCause& cause) {
  const auto found = std::ranges::find_if(effects.unseen, [&cause](const plan::Unseen& u) {
    return u.effect == cause.effect && u.where == cause.where;
  });
  return found == effects.unseen.end() ? nullptr : &*found;
}

/// Causes that were weighed otherwise: a scatter has no signature.
bool IsShown(const Isolability& isolability, const diagnose::Detectable& other) {
  return std::ranges::any_of(isolability.causes, [&other](const ShownCause& cause) {
    return cause.effect == other.effect && cause.where == other.where;
  });
}

std::string DetectableText(const PlannedEffects& effects) {
  const Isolability& isolability = *effects.seen.isolability;
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < isolability.causes.size(); ++k) {
    const ShownCause& cause = isolability.causes[k];
    if (!std::isfinite(cause.smallest.value)) continue;
    const plan::Unseen* const unseen = UnseenOf(effects, cause);
    rows.push_back({PlaceOf(cause), SizeOf(cause, 1.0), unseen ? BiasLines(*unseen) : "", RivalLines(isolability, k)});
  }
  for (const diagnose::Detectable& other : effects.seen.diagnosis.detectable) {
    if (!IsShown(isolability, other) && std::isfinite(other.smallest.value))
      rows.push_back({diagnose::Place(other.effect, other.where), diagnose::NameAndSize(other.smallest), "", ""});
  }
  const std::string table = TextTable({{"effect"}, {"smallest detectable"}, {"undetected bias"}, {"may be mistaken for"}}, rows, kEffectsWidth);
  return table.empty() ? "" : table + "smallest detectable: by a test for that cause alone (80 % at 0.1 %); a diagnosis, which has to choose among all, needs more\n";
}

std::string NeverText(const Isolability& isolability) {
  std::string text;
  for (const std::vector<std::size_t>& set : NeverTold(isolability)) {
    std::string names;
    for (const std::size_t k : set) names += (names.empty() ? "" : "; ") + PlaceOf(isolability.causes[k]);
    text += Paragraph("Indistinguishable at any plausible size (aliased): ", names, 4, kEffectsWidth);
  }
  return text;
}

Json BiasesJson(const plan::Unseen& unseen) {
  Json biases = Json::array();
  for (const plan::Bias& bias : unseen.biases)
    biases.push_back({{"name", bias.name}, {"rms", bias.rms}, {"over_u", bias.per_u}});
  return biases;
}

Json CauseJson(const ShownCause& cause) {
  return {{"effect", cause.effect}, {"where", cause.where}};
}

Json DetectableJson(const PlannedEffects& effects) {
  Json list = Json::array();
  for (const diagnose::Detectable& one : effects.seen.diagnosis.detectable) {
    if (!std::isfinite(one.smallest.value)) continue;
    Json entry = {{"effect", one.effect},
                  {"where", one.where},
                  {"parameter", one.smallest.name},
                  {"unit", one.smallest.unit},
                  {"smallest", one.smallest.value / one.smallest.to_SI}};
    ShownCause cause;
    cause.effect = one.effect;
    cause.where = one.where;
    const plan::Unseen* const unseen = UnseenOf(effects, cause);
    if (unseen) entry["moves_unseen"] = BiasesJson(*unseen);
    list.push_back(std::move(entry));
  }
  return list;
}

/// @return both causes, and from which size of the first on they are told apart (0: any that is found), in the shape that
///         shows most and in the one that is most alike; null: no plausible one.
Json TieJson(const Isolability& isolability, const Confusable& pair) {
  const ShownCause& present = isolability.causes[pair.present];
  const double unit = present.smallest.value / present.smallest.to_SI;
  const double from = pair.told_from * unit, surely_from = pair.surely_told_from * unit;
  return {{"present", CauseJson(present)},
          {"blamed", CauseJson(isolability.causes[pair.blamed])},
          {"parameter", present.smallest.name},
          {"unit", present.smallest.unit},
          {"told_from", std::isfinite(from) ? Json(from) : Json()},
          {"told_from_in_any_shape", std::isfinite(surely_from) ? Json(surely_from) : Json()}};
}

}  // namespace

std::string PlannedEffectsText(const PlannedEffects& effects) {
  if (!effects.refused.empty()) return Paragraph("No cause would be found: ", effects.refused, 4, kEffectsWidth);
  return DetectableText(effects) + "\n" + NeverText(*effects.seen.isolability) + "\n" +
         InvisibleTable(effects.seen.diagnosis);
}

Json PlannedEffectsJson(const PlannedEffects& effects) {
  Json json = {{"detectable", Json::array()},
               {"invisible", Json::array()},
               {"ties", Json::array()},
               {"never_told_apart", Json::array()},
               {"no_cause_found_because", effects.refused.empty() ? Json() : Json(effects.refused)}};
  if (!effects.refused.empty()) return json;
  const Isolability& isolability = *effects.seen.isolability;
  json["detectable"] = DetectableJson(effects);
  for (const diagnose::Invisible& one : effects.seen.diagnosis.invisible)
    json["invisible"].push_back({{"effect", one.effect}, {"where", one.where}, {"could_bias", one.could_bias}});
  for (const Confusable& pair : isolability.confusable) json["ties"].push_back(TieJson(isolability, pair));
  for (const std::vector<std::size_t>& set : NeverTold(isolability)) {
    Json members = Json::array();
    for (const std::size_t k : set) members.push_back(CauseJson(isolability.causes[k]));
    json["never_told_apart"].push_back(std::move(members));
  }
  return json;
}

}  // namespace twinbench::report
