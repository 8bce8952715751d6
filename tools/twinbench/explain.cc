#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/terminal.h"
#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/core/scenario.h"
#include "twin/report/curve_text.h"
#include "twin/report/json_units.h"

namespace twinbench::tools {
namespace {

struct ExplainOptions {
  std::string effect, bench;
};

constexpr int kLeastPlaces = 5;  // of a plot

/// What an effect does to the readings of its bench's usual scenario, without noise.
struct Signature {
  std::string column;              // the one that it moves most
  std::vector<double> difference;  // of each reading, in the column's unit; NaN where there is none
  double rms = 0.0;
};

double NumberIn(const ReadingColumn& column, const Reading& reading) {
  return ParseNumber(column.print(reading)).value_or(kNaN);
}

Signature SignatureIn(const ReadingColumn& column, const std::vector<Reading>& without,
                      const std::vector<Reading>& with) {
  Signature signature{column.name, {}, 0.0};
  int seen = 0;
  for (std::size_t k = 0; k < without.size(); ++k) {
    const double difference = NumberIn(column, with[k]) - NumberIn(column, without[k]);
    signature.difference.push_back(difference);
    if (std::isnan(difference)) continue;
    signature.rms += difference * difference;
    ++seen;
  }
  signature.rms = seen > 0 ? std::sqrt(signature.rms / seen) : 0.0;
  return signature;
}

/// Of the columns in which the bench shows something, the one that differs most.
Signature LargestSignature(const BenchFormat& bench, const std::vector<Reading>& without,
                           const std::vector<Reading>& with) {
  Signature largest;
  for (const ReadingColumn& column : bench.columns) {
    if (!column.IsShown() || !column.number) continue;
    Signature found = SignatureIn(column, without, with);
    if (found.rms > largest.rms) largest = std::move(found);
  }
  return largest;
}

/// Forward and backward means of a signature by one circumstance.
report::CurveText CurveBy(const ReadingColumn& by, const Signature& signature, const std::vector<Reading>& readings) {
  struct Sum {
    double of = 0.0;
    int n = 0;
    void Add(double value) { of += value, ++n; }
    double Mean() const { return n > 0 ? of / n : kNaN; }
  };
  std::map<double, std::pair<Sum, Sum>> places;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const double x = NumberIn(by, readings[k]);
    if (std::isnan(x) || std::isnan(signature.difference[k])) continue;
    auto& [forward, backward] = places[x];
    (readings[k].direction < 0 ? backward : forward).Add(signature.difference[k]);
  }
  report::CurveText curve;
  curve.title = "what it adds to " + signature.column;
  curve.x_name = by.name;
  for (const auto& [x, sums] : places) {
    curve.x.push_back(x);
    curve.forward.push_back(sums.first.Mean());
    curve.backward.push_back(sums.second.Mean());
  }
  return curve;
}

double MeanSquare(const std::vector<double>& values) {
  double squares = 0.0;
  int n = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    squares += value * value;
    ++n;
  }
  return n > 0 ? squares / n : 0.0;
}

/// How well a curve says what it is of: the share of the signature that is a function of the place, less what it jumps from
/// place to place.
double Clarity(const report::CurveText& curve, const Signature& signature) {
  double clarity = 0.0;
  for (const auto& course : {curve.forward, curve.backward}) {
    std::vector<double> jumps;
    for (std::size_t k = 1; k < course.size(); ++k) jumps.push_back(course[k] - course[k - 1]);
    clarity += MeanSquare(course) - MeanSquare(jumps);
  }
  return clarity / (signature.rms * signature.rms);
}

/// Against the circumstance that it goes with.
std::optional<report::CurveText> Picture(const BenchFormat& bench, const Signature& signature,
                                         const std::vector<Reading>& readings) {
  std::optional<report::CurveText> clearest;
  for (const ReadingColumn& column : bench.columns) {
    if (column.IsShown() || (!column.number && column.name != "time_s")) continue;
    const report::CurveText curve = CurveBy(column, signature, readings);
    if (curve.x.size() < kLeastPlaces) continue;
    if (!clearest || Clarity(curve, signature) > Clarity(*clearest, signature)) clearest = curve;
  }
  return clearest;
}

/// Two runs of the twin, reading by reading.
struct Pair {
  std::vector<Reading> without, with;

  Pair OfPhase(Phase phase) const {
    Pair part;
    for (std::size_t k = 0; k < without.size(); ++k) {
      if (without[k].phase != phase) continue;
      part.without.push_back(without[k]);
      part.with.push_back(with[k]);
    }
    return part;
  }
};

/// The test itself, unless the effect is next to nothing there: calibration shows what tables without errors do not.
Pair WhereItIsSeen(const BenchFormat& bench, const Pair& whole) {
  constexpr double kNextToNothing = 1e-3;
  const Pair test = whole.OfPhase(Phase::kFullCircle);
  const double in_test = LargestSignature(bench, test.without, test.with).rms;
  const double in_all = LargestSignature(bench, whole.without, whole.with).rms;
  return in_test > kNextToNothing * in_all ? test : whole;
}

std::string Block(const EffectEntry& effect) {
  std::string text = fmt::format("name=\"{}\"", effect.name);
  if (!effect.places.empty())
    text += fmt::format(", where=\"{}\"",
                        effect.default_place.empty() ? effect.places.front() : effect.default_place);
  return "effect=[{" + text + "}]";
}

Scenario Usual(const BenchFormat& bench, const std::vector<std::string>& overrides) {
  return ParseScenario(fmt::format("bench = \"{}\"\nnoise_free = true\n", bench.name), "the usual scenario", "",
                       overrides);
}

/// What is told of an effect on one bench.
struct Explained {
  const BenchFormat& bench;
  const EffectEntry& effect;
  Signature signature;                       // rms 0: the readings of the usual scenario stay as they are
  std::optional<report::CurveText> picture;  // where it has one
};

Explained OnBench(const BenchFormat& bench, const EffectEntry& effect) {
  Explained told{bench, effect, {}, {}};
  Pair seen{ReadingsOfTwin(Usual(bench, {})), ReadingsOfTwin(Usual(bench, {Block(effect)}))};
  if (seen.without.size() != seen.with.size()) return told;
  seen = WhereItIsSeen(bench, seen);
  told.signature = LargestSignature(bench, seen.without, seen.with);
  if (told.signature.rms > 0.0) told.picture = Picture(bench, told.signature, seen.with);
  return told;
}

void PrintSignature(const Explained& told) {
  if (told.signature.rms == 0.0) {
    fmt::print("    At this size it leaves the readings of the usual scenario as they are.\n");
    return;
  }
  fmt::print("    At this size it moves {} most: {:.3g} rms over the usual scenario, without noise.\n\n",
             told.signature.column, told.signature.rms);
  if (told.picture) fmt::print("{}\n", report::PlotOf(*told.picture, LettersOfStdout()));
}

void Print(const Explained& told) {
  const EffectEntry& effect = told.effect;
  fmt::print("{}, on {}: {}\n", effect.name, told.bench.name, effect.title);
  for (const EffectParameter& p : effect.parameters)
    fmt::print("    {} = {:g}   {}; from {:g} to {:g}\n", p.Key(), effect.Plausible(p) / p.to_SI, p.meaning,
               p.lower_SI / p.to_SI, p.upper_SI / p.to_SI);
  if (!effect.places.empty()) fmt::print("    where = {}\n", fmt::join(effect.places, ", "));
  fmt::print("    twinbench run SCENARIO -o RUN --set '{}'\n", Block(effect));
  PrintSignature(told);
}

nlohmann::json ParametersJson(const EffectEntry& effect) {
  nlohmann::json parameters = nlohmann::json::array();
  for (const EffectParameter& p : effect.parameters)
    parameters.push_back({{"key", p.Key()},
                          {"plausible", report::In(p.to_SI, effect.Plausible(p))},
                          {"lower", report::In(p.to_SI, p.lower_SI)},
                          {"upper", report::In(p.to_SI, p.upper_SI)},
                          {"meaning", p.meaning}});
  return parameters;
}

nlohmann::json PictureJson(const report::CurveText& curve) {
  const auto list = [](const std::vector<double>& values) {
    nlohmann::json numbers = nlohmann::json::array();
    for (const double value : values) numbers.push_back(report::In(1.0, value));
    return numbers;
  };
  return {{"against", curve.x_name}, {"x", list(curve.x)}, {"forward", list(curve.forward)}, {"backward", list(curve.backward)}};
}

nlohmann::json ExplainedJson(const Explained& told) {
  nlohmann::json json = {{"effect", told.effect.name},  {"bench", told.bench.name},    {"title", told.effect.title},
                         {"where", told.effect.places}, {"set", Block(told.effect)},   {"parameters", ParametersJson(told.effect)},
                         {"signature", nullptr}};
  if (told.signature.rms == 0.0) return json;
  json["signature"] = {{"column", told.signature.column}, {"rms", told.signature.rms}};
  if (told.picture) json["signature"].update(PictureJson(*told.picture));
  return json;
}

[[noreturn]] void RefuseEffect(const ExplainOptions& options) {
  std::vector<std::string> known;
  for (const BenchFormat* bench : BenchFormats()) {
    if (!options.bench.empty() && bench->name != options.bench) continue;
    for (const EffectEntry& effect : bench->effects) known.push_back(effect.name);
  }
  throw InputError("explain", "no bench has an effect " + options.effect,
                   "one that `twinbench list` has; the nearest is " + Nearest(options.effect, known));
}

void ExplainEverywhere(const ExplainOptions& options, JsonAnswer& answer) {
  if (!options.bench.empty() && !FindFormat(options.bench)) throw UnknownBench("--bench", options.bench);
  nlohmann::json all = nlohmann::json::array();
  bool found = false;
  for (const BenchFormat* bench : BenchFormats()) {
    const EffectEntry* effect = FindEffect(options.effect, bench->name);
    if (!effect || (!options.bench.empty() && bench->name != options.bench)) continue;
    const Explained told = OnBench(*bench, *effect);
    if (answer.IsWanted()) all.push_back(ExplainedJson(told));
    if (!answer.IsOnStdout()) {
      if (found) fmt::print("\n");
      Print(told);
    }
    found = true;
  }
  if (!found) RefuseEffect(options);
  answer.Write({{"benches", all}});
}

}  // namespace

void AddExplain(CLI::App& app) {
  auto* command = app.add_subcommand("explain", "Explain an effect, and show what it does to readings");
  auto options = std::make_shared<ExplainOptions>();
  command->add_option("effect", options->effect, "its name, as `twinbench list` has it")->required();
  command->add_option("--bench", options->bench, "on this bench only");
  AnswerWith(*command, "it", [options](JsonAnswer& answer) { ExplainEverywhere(*options, answer); });
}

}  // namespace twinbench::tools
