#include "twin/report/sound.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "twin/core/number_text.h"
#include "twin/core/unit_text.h"

namespace twinbench::report {
namespace {

using Json = nlohmann::json;

// --- text ---

/// Letters beyond ASCII too: µ, ±.
bool IsInWord(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return std::isalnum(byte) != 0 || byte >= 0x80 || c == '.' || c == '+' || c == '-' || c == '_';
}

/// A word of a line, or what stands between two of them.
struct Piece {
  std::string text;
  bool is_absent = false;
};

bool IsNoNumber(std::string_view word) {
  const std::string_view bare = word.substr(std::min(word.find_first_not_of("+-±"), word.size()));
  if (bare == "nan" || bare == "inf") return true;
  const std::optional<double> number = ParseNumber(word);
  return number && std::abs(*number) >= kAbsurd;
}

std::vector<Piece> PiecesOf(std::string_view line) {
  std::vector<Piece> pieces;
  for (std::size_t at = 0; at < line.size();) {
    const bool in_word = IsInWord(line[at]);
    std::size_t end = at;
    while (end < line.size() && IsInWord(line[end]) == in_word) ++end;
    const std::string_view word = line.substr(at, end - at);
    pieces.push_back({std::string(word), in_word && IsNoNumber(word)});
    at = end;
  }
  return pieces;
}

/// "value ± u": neither without the other.
void PairUp(std::vector<Piece>& pieces) {
  for (std::size_t k = 2; k + 2 < pieces.size(); ++k) {
    if (pieces[k].text != "±" || !(pieces[k - 2].is_absent || pieces[k + 2].is_absent)) continue;
    pieces[k - 2].is_absent = true;
    for (std::size_t i = k - 1; i <= k + 2; ++i) pieces[i] = {"", false};
  }
}

/// As people write the units of columns and keys.
std::string SpokenUnit(const std::string& word) {
  constexpr std::array<std::string_view, 6> kUnits = {"um", "urad", "degC", "urad_per_h", "per_m2", "arcsec_per_h"};
  return std::ranges::find(kUnits, word) == kUnits.end() ? word : UnitInPrint(word);
}

/// A hyphen before a number is a minus, but in values and lists of values behind "=": they may be copied into a file.
std::string WithMinus(const std::string& word, const std::string& before) {
  const bool is_negative = word.size() > 1 && word[0] == '-' && std::isdigit(static_cast<unsigned char>(word[1])) != 0;
  const bool stands_alone = before.empty() || std::string_view(" \n([").find(before.back()) != std::string_view::npos;
  if (!is_negative || !stands_alone) return word;
  const std::size_t equals = before.rfind('=');
  const bool is_value = equals != before.npos && before.find_first_not_of("0123456789.,[+- ", equals + 1) == before.npos;
  return is_value ? word : "−" + word.substr(1);
}

std::string WithoutNoNumbersIn(std::string_view line, const std::string& absent) {
  std::vector<Piece> pieces = PiecesOf(line);
  PairUp(pieces);
  std::string text;
  for (const Piece& p : pieces)
    text += !p.is_absent ? p.text : absent.empty() ? "" : fmt::format("{:>{}}", absent, std::min<std::size_t>(p.text.size(), 4));
  return text;
}

// --- JSON ---

void Clear(Json& node) {
  if (!node.is_structured()) node = nullptr;
  for (Json& inner : node)
    if (node.is_structured()) Clear(inner);
}

/// The value goes with its uncertainty, one by one in lists.
void ClearWith(const Json& before, const Json& after, Json& value) {
  if (before.is_array() && value.is_array() && before.size() == value.size()) {
    for (std::size_t k = 0; k < before.size(); ++k) ClearWith(before[k], after[k], value[k]);
  } else if (!before.is_null() && after.is_null()) {
    Clear(value);
  }
}

/// Counts may be as large as they like.
bool MayBeLarge(const std::string& key) {
  return key == "dof" || key == "seed" || key.starts_with("chi2");
}

}  // namespace

int ClearNoNumbers(nlohmann::json& node) {
  if (node.is_number_float() && !(std::abs(node.get<double>()) < kAbsurd)) {
    node = nullptr;
    return 1;
  }
  int cleared = 0;
  if (node.is_array()) {
    for (Json& inner : node) cleared += ClearNoNumbers(inner);
  } else if (node.is_object()) {
    const Json before = node;
    for (auto& [key, inner] : node.items()) cleared += MayBeLarge(key) ? 0 : ClearNoNumbers(inner);
    if (cleared == 0) return 0;
    for (const auto& [key, u] : before.items()) {
      const std::string of = key == "u" ? "value" : key.starts_with("u_") ? key.substr(2) : "";
      if (node.contains(of)) ClearWith(u, node[key], node[of]);
    }
  }
  return cleared;
}

namespace {

void ClearUncertainties(Json& node) {
  if (!node.is_structured()) return;
  for (auto& [key, inner] : node.items()) {
    if (node.is_object() && (key == "u" || key.starts_with("u_")))
      Clear(inner);
    else
      ClearUncertainties(inner);
  }
}

// --- why ---

/// "(of 432 readings 398 show clipped)"; nothing if all are whole.
std::string LeftOut(const std::vector<Reading>& readings) {
  std::map<std::string, int> counts;
  for (const Reading& r : readings)
    if (r.status != ReadingStatus::kOk) ++counts[ReadingStatusName(r.status)];
  std::string text;
  for (const auto& [status, count] : counts) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, status);
  return text.empty() ? "" : fmt::format(" (of {} readings {})", readings.size(), text);
}

const Misfit* WorstOf(const std::vector<Misfit>& misfits) {
  const auto worst = std::ranges::max_element(misfits, {}, [](const Misfit& m) { return std::isnan(m.per_u) ? 0.0 : m.per_u; });
  return worst != misfits.end() && worst->per_u > kMostMisfit ? &*worst : nullptr;
}

/// Uncertainties that are numbers, and all there are.
struct Counted {
  int known = 0, all = 0;
};

Counted CountUncertainties(const Json& node, bool is_u = false) {
  if (!node.is_structured()) return {is_u && node.is_number() ? 1 : 0, is_u ? 1 : 0};
  Counted counted;
  for (const auto& [key, inner] : node.items()) {
    const bool is_inner_u = node.is_object() ? key == "u" || (key.starts_with("u_") && key != "u_parts") : is_u;
    const Counted of = CountUncertainties(inner, is_inner_u);
    counted.known += of.known, counted.all += of.all;
  }
  return counted;
}

void TakeUncertainty(const std::string& why, Evaluation& evaluation) {
  evaluation.not_separated = why;
  evaluation.separation = nullptr;
  evaluation.tables.clear();
  evaluation.joints = {};
  ClearUncertainties(evaluation.results);
  evaluation.results["not_described"] = evaluation.not_separated;
  evaluation.summary = evaluation.summary.substr(0, evaluation.summary.find('\n') + 1) +
                       "no result: " + evaluation.not_separated + "\n";
}

}  // namespace

std::string InPrint(const std::string& text) {
  std::string spoken;
  for (const Piece& piece : PiecesOf(text)) spoken += WithMinus(SpokenUnit(piece.text), spoken);
  return spoken;
}

std::string WithoutNoNumbers(const std::string& text, const std::string& absent) {
  std::string sound;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    sound += WithoutNoNumbersIn(std::string_view(text).substr(at, end - at), absent);
    if (end < text.size()) sound += '\n';
    at = end + 1;
  }
  return absent.empty() ? sound : InPrint(sound);
}

void KeepSound(const std::vector<Reading>& readings, Evaluation& evaluation) {
  if (const Misfit* worst = WorstOf(evaluation.misfits))
    TakeUncertainty(
        fmt::format(
            "the fit does not describe the readings: {} leaves {:.3g} times its stated standard uncertainty "
            "(rms), so nothing that is derived from it has an uncertainty",
            worst->of, worst->per_u),
        evaluation);
  const int absurd = ClearNoNumbers(evaluation.results) + ClearNoNumbers(evaluation.separation);
  if (const Counted u = CountUncertainties(evaluation.separation); u.all > 0 && u.known == 0)
    TakeUncertainty(fmt::format("the readings determine none of the errors{}", LeftOut(readings)), evaluation);
  for (ResultTable& table : evaluation.tables) table.text = WithoutNoNumbers(table.text, "");
  const std::string sound = WithoutNoNumbers(evaluation.summary);
  evaluation.summary = InPrint(evaluation.summary);
  if (absurd == 0 && sound == evaluation.summary) return;
  const std::string why = fmt::format("the readings of this run do not determine it{}", LeftOut(readings));
  evaluation.results["not_determined"] = why;
  evaluation.summary = sound + "-: " + why + "\n";
}

std::string WhatItWouldTake(const Evaluation& evaluation) {
  if (!WorstOf(evaluation.misfits)) return "more readings that have numbers: an instrument that reaches what it reads, more positions or "
                                            "mountings, and a scenario that states some noise";
  return "readings that differ from the model by noise: what is larger in them than the scenario says (an effect, a wrong constant, another "
         "bench) `twinbench diagnose` names";
}

}  // namespace twinbench::report
