#include "twin/benches/freeform_five_axis/displacement_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/estimators/displacement_fit.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/core/errors.h"

namespace twinbench::benches::freeform {
namespace {

using estimators::DisplacementFit, estimators::FittedTerm, estimators::PoseTerm, estimators::TermKind,
    estimators::UntoldTerm;
using Json = nlohmann::json;

/// "XOC" is E_X0C in ISO 230-1.
std::string SymbolOf(const PoseTerm& term) {
  if (term.kind == TermKind::kComponent) return fmt::format("E_{}", term.name.substr(1));
  return fmt::format("E_{}0{}", term.name[0], term.name[2]);
}

Json Known(const FittedTerm& fitted) {
  return {{"value", fitted.value}, {"u", fitted.u}, {"unit", fitted.term.unit}, {"u_parts", {{"noise", 1.0}}}};
}

/// Each once, a set-up in one word.
std::vector<std::string> WordsOfUntold(const DisplacementFit& fit, const std::vector<std::size_t>& which) {
  std::vector<std::string> words;
  for (const std::size_t k : which) {
    const std::string word = fit.untold[k].term.Words();
    if (std::ranges::count(words, word) == 0) words.push_back(word);
  }
  return words;
}

std::vector<std::string> WordsOfFitted(const DisplacementFit& fit, const std::vector<std::size_t>& which) {
  std::vector<std::string> words;
  for (const std::size_t k : which) {
    const PoseTerm& term = fit.fitted[k].term;
    const std::string word = term.kind == TermKind::kMounting ? "where the ball stands"
                             : term.kind == TermKind::kTool   ? "the tool's point"
                                                              : term.Words();
    if (std::ranges::count(words, word) == 0) words.push_back(word);
  }
  return words;
}

/// What moves the ball as another location does is no figure of its own. Components that do so belong to a location
/// by its definition: it is of the average line.
bool IsTold(const DisplacementFit& fit, const FittedTerm& location) {
  return !location.hangs_on_chain && std::ranges::none_of(location.looks_like, [&fit](std::size_t k) {
    return fit.untold[k].term.IsLocation();
  });
}

/// An error at one order: its cosine and sine, or the one number that it is.
struct Component {
  std::vector<std::size_t> fitted, untold;  // of the fit
};

/// Of locations those that are not told.
std::map<std::pair<std::string, int>, Component> ComponentsOf(const DisplacementFit& fit) {
  std::map<std::pair<std::string, int>, Component> all;
  for (std::size_t k = 0; k < fit.fitted.size(); ++k)
    if (const FittedTerm& fitted = fit.fitted[k];
        !fitted.term.IsSetUp() && !(fitted.term.IsLocation() && IsTold(fit, fitted)))
      all[{fit.fitted[k].term.name, fit.fitted[k].term.order}].fitted.push_back(k);
  for (std::size_t k = 0; k < fit.untold.size(); ++k)
    if (!fit.untold[k].term.IsSetUp()) all[{fit.untold[k].term.name, fit.untold[k].term.order}].untold.push_back(k);
  return all;
}

bool IsTold(const DisplacementFit& fit, const Component& component) {
  return component.untold.empty() && std::ranges::all_of(component.fitted, [&fit](std::size_t k) {
           return fit.fitted[k].looks_like.empty() && !fit.fitted[k].hangs_on_chain;
         });
}

/// Cosine and sine with their amplitude and the angle at which it is largest, or the one number.
Json PartsOf(const DisplacementFit& fit, const Component& component) {
  const FittedTerm& first = fit.fitted[component.fitted.front()];
  if (component.fitted.size() < 2) return Known(first);
  const FittedTerm& second = fit.fitted[component.fitted[1]];
  const double amplitude = std::hypot(first.value, second.value), phase_rad = std::atan2(second.value, first.value);
  return {{"order", first.term.order},
          {"unit", first.term.unit},
          {"cosine", first.value},
          {"u_cosine", first.u},
          {"sine", second.value},
          {"u_sine", second.u},
          {"amplitude", amplitude},
          {"u_amplitude", std::hypot(first.u * std::cos(phase_rad), second.u * std::sin(phase_rad))},
          {"phase_deg", phase_rad / units::deg},
          {"u_parts", {{"noise", 1.0}}}};
}

Json ErrorsJsonOf(const DisplacementFit& fit) {
  Json errors = Json::object();
  for (const FittedTerm& fitted : fit.fitted) {
    if (!fitted.term.IsLocation() || !IsTold(fit, fitted)) continue;
    Json& one = errors[fitted.term.name] = Known(fitted);
    one["iso230_1"] = SymbolOf(fitted.term);
    if (!fitted.looks_like.empty()) one["as_if_none_of"] = WordsOfUntold(fit, fitted.looks_like);
  }
  return errors;
}

Json ComponentsJson(const DisplacementFit& fit) {
  Json all = Json::object();
  for (const auto& [key, component] : ComponentsOf(fit)) {
    if (component.fitted.empty() || !IsTold(fit, component)) continue;
    Json one = PartsOf(fit, component);
    one["order"] = key.second;
    all[key.first].push_back(std::move(one));
  }
  return all;
}

/// What moves the ball as others do, or not at all.
Json NotObservableJson(const DisplacementFit& fit) {
  Json all = Json::array();
  for (const auto& [key, component] : ComponentsOf(fit)) {
    if (IsTold(fit, component)) continue;
    Json one = {{"error", key.first}};
    if (key.second > 0) one["order"] = key.second;
    std::set<std::size_t> fitted, untold;
    for (const std::size_t k : component.untold)
      fitted.insert(fit.untold[k].looks_like.begin(), fit.untold[k].looks_like.end());
    for (const std::size_t k : component.fitted)
      untold.insert(fit.fitted[k].looks_like.begin(), fit.fitted[k].looks_like.end());
    std::vector<std::string> alike = WordsOfFitted(fit, {fitted.begin(), fitted.end()});
    std::ranges::copy(WordsOfUntold(fit, {untold.begin(), untold.end()}), std::back_inserter(alike));
    const std::string own = component.fitted.empty() ? fit.untold[component.untold.front()].term.Words()
                                                     : fit.fitted[component.fitted.front()].term.Words();
    std::erase(alike, own);
    if (std::ranges::any_of(component.fitted, [&fit](std::size_t k) { return fit.fitted[k].hangs_on_chain; }))
      alike.push_back("other values on another machine (machine.also_possible)");
    one["indistinguishable_from"] = alike;
    if (component.untold.empty()) one["if_alone"] = PartsOf(fit, component);
    all.push_back(std::move(one));
  }
  return all;
}

Json SetUpJson(const DisplacementFit& fit) {
  Json set_up = {{"balls", Json::array()}};
  for (const FittedTerm& fitted : fit.fitted) {
    if (!fitted.term.IsSetUp()) continue;
    const std::string key = fitted.term.name + "_" + fitted.term.unit;
    if (fitted.term.kind == TermKind::kTool) {
      set_up["tool"][key] = {{"value", fitted.value}, {"u", fitted.u}};
      continue;
    }
    Json& balls = set_up["balls"];
    while (std::ssize(balls) <= fitted.term.ball) balls.push_back({{"ball", balls.size()}});
    balls[static_cast<std::size_t>(fitted.term.ball)][key] = {{"value", fitted.value}, {"u", fitted.u}};
  }
  return set_up;
}

std::string InWords(const std::string& topology) {
  return topology == "table_table" ? "table/table" : topology == "table_head" ? "table/head" : "head/head";
}

/// Where along an axis it is that its line lies so.
std::string ReferenceOf(const DisplacementFit& fit) {
  const bool is_carried =
      fit.chain.stages.size() == 2 && fit.chain.stages[0].on_table == fit.chain.stages[1].on_table;
  return fit.on_workpiece ? "at the origin of the workpiece"
         : is_carried     ? "where each axis passes the other"
                          : "where the coordinate along the axis is 0 (if the slide along it is square)";
}

Json MachineJson(const DisplacementFit& fit) {
  Json axes = Json::array();
  for (const auto& stage : fit.chain.stages)
    axes.push_back({{"axis", std::string(1, stage.Letter())},
                    {"on", stage.on_table ? "table" : "head"},
                    {"right_handed", stage.sense > 0.0}});
  return {{"topology", fit.chain.topology},
          {"axes", axes},
          {"positions", fit.on_workpiece ? "workpiece" : "machine"},
          {"locations", ReferenceOf(fit)},
          {"seen_from", fit.from_tool ? "tool" : "workpiece"},
          {"also_possible", fit.other_chains}};
}

std::string MachineText(const DisplacementFit& fit) {
  std::string text =
      fmt::format("{} displacements at {} poses, {} ball{}: {}, {}\n", fit.values, fit.readings, fit.balls,
                  fit.balls == 1 ? "" : "s", InWords(fit.chain.topology), WordsOf(fit.chain));
  text += fmt::format("x, y, z are places of {}; displaced is the {}, seen from the {}\n",
                      fit.on_workpiece ? "the ball on the workpiece" : "the slides",
                      fit.from_tool ? "workpiece" : "tool", fit.from_tool ? "tool" : "workpiece");
  for (const std::string& other : fit.other_chains)
    text += "note: the readings allow as well " + other +
            "; what differs there has no figure until displacement.topology and axes say which\n";
  return text;
}

std::string LocationsText(const DisplacementFit& fit) {
  std::string text =
      fmt::format("Location errors (ISO 230-1) of average lines, in the frame of what carries the axis, {}:\n",
                  ReferenceOf(fit));
  for (const FittedTerm& fitted : fit.fitted)
    if (fitted.term.IsLocation() && IsTold(fit, fitted))
      text += fmt::format("  {:<6} {:>10.3f} ± {:.2g} {}\n", fitted.term.name, fitted.value, fitted.u,
                          fitted.term.unit);
  return text;
}

std::string ComponentsText(const DisplacementFit& fit) {
  std::string text;
  for (const auto& [key, component] : ComponentsOf(fit)) {
    if (component.fitted.empty() || !IsTold(fit, component)) continue;
    const Json parts = PartsOf(fit, component);
    const bool is_wave = parts.contains("amplitude");
    const double value = parts.at(is_wave ? "amplitude" : "value"), u = parts.at(is_wave ? "u_amplitude" : "u");
    if (!(std::abs(value) > 3.0 * u)) continue;
    const std::string unit = parts.at("unit") == "um_m" ? "µm/m" : std::string(parts.at("unit"));
    text += fmt::format("  {:<6} order {} {:>10.3f} ± {:.2g} {}\n", key.first, key.second, value, u, unit);
  }
  return text.empty() ? "" : "Component errors beyond 3 u (amplitudes; all in results.json):\n" + text;
}

/// "EXC orders 1, 2; AOC".
std::string NotObservableText(const Json& not_observable) {
  std::map<std::string, std::vector<int>> orders;
  for (const Json& one : not_observable) {
    std::vector<int>& own = orders[one.at("error")];
    if (one.contains("order")) own.push_back(one.at("order"));
  }
  std::vector<std::string> words;
  for (const auto& [name, own] : orders)
    words.push_back(
        own.empty() ? name
                    : fmt::format("{} {} {}", name, own.size() == 1 ? "order" : "orders", fmt::join(own, ", ")));
  return words.empty() ? ""
                       : fmt::format("not observable one by one (results.json: not_observable): {}\n",
                                     fmt::join(words, "; "));
}

Json DriftJson(const DisplacementFit& fit) {
  Json all = Json::object();
  for (const estimators::Drift& drift : fit.drift)
    all[drift.along + "_um"] = {{"value", drift.over_run_um}, {"u", drift.u_um}};
  return all;
}

/// Those that are sure enough to be said.
std::string DriftText(const DisplacementFit& fit) {
  constexpr double kSure_u = 3.0;
  std::vector<std::string> words;
  for (const estimators::Drift& drift : fit.drift)
    if (std::abs(drift.over_run_um) > kSure_u * drift.u_um)
      words.push_back(fmt::format("{} {:.3f} ± {:.2g} µm", drift.along, drift.over_run_um, drift.u_um));
  if (fit.drift.empty()) return "";
  return fmt::format(
      "note: the readings {} over the run{}{}; errors are those at the first reading, with what the drift leaves open in "
      "u\n",
      words.empty() ? "may drift" : "drift", words.empty() ? "" : ": ", fmt::join(words, ", "));
}

Json LeftOutJson(const DisplacementFit& fit) {
  Json all = Json::array();
  for (const estimators::FarShift& far : fit.left_out)
    all.push_back({{"reading", far.reading},
                   {"column", kShift_m[static_cast<std::size_t>(far.component)].column},
                   {"off_um", far.off_um},
                   {"times_scatter", far.times}});
  return all;
}

std::string LeftOutText(const DisplacementFit& fit) {
  std::string text;
  for (const estimators::FarShift& far : fit.left_out) {
    std::vector<std::string> pose;
    for (const auto& stage : fit.chain.stages)
      pose.push_back(fmt::format("{} {:.6g} deg", stage.Letter(), far.turned_rad[stage.axis] / units::deg));
    text += fmt::format(
        "doubtful: {} of reading {} (row {}; {}) lies {:.3g} µm from the fit of all others, {:.2g} times their scatter: "
        "left out\n",
        kShift_m[static_cast<std::size_t>(far.component)].column, far.reading, far.reading + 1, fmt::join(pose, ", "),
        far.off_um, far.times);
  }
  return text;
}

/// What the fit leaves by the stated noise, or by what readings of one pose scatter; neither is less than a file
/// has digits.
double LeftOverNoise(const DisplacementSettings& settings, const DisplacementFit& fit) {
  constexpr double kDigits_um = 0.05;
  const double noise_um = settings.noise_m > 0.0 ? settings.noise_m / units::um : fit.repeat_um;
  return std::isfinite(noise_um) && fit.dof > 0 ? fit.residual_um / std::max(noise_um, kDigits_um) : kNaN;
}

std::string LeftText(const DisplacementFit& fit, double over_noise) {
  std::string text = fmt::format("residual {:.3f} µm rms of {:.3f} µm, {} degrees of freedom", fit.residual_um,
                                 fit.displaced_um, fit.dof);
  if (std::isfinite(fit.repeat_um))
    text += fmt::format("; readings of one pose repeat to {:.3f} µm", fit.repeat_um);
  constexpr double kDeviations = 4.0;
  if (over_noise > 1.0 + kDeviations / std::sqrt(2.0 * static_cast<double>(fit.dof)))
    text += fmt::format(
        "\nnote: the residual is {:.2g} times the noise: the machine errs as no error that is fitted; u is from "
        "the residual",
        over_noise);
  return text + "\n";
}

}  // namespace

report::Evaluation EvaluateDisplacements(const Scenario& scenario, const std::vector<Reading>& readings) {
  const DisplacementSettings& settings = FreeformOf(scenario).displacement;
  const DisplacementFit fit = estimators::FitDisplacements(settings, readings);
  const double over_noise = LeftOverNoise(settings, fit);
  report::Evaluation evaluation;
  const Json not_observable = NotObservableJson(fit);
  evaluation.separation = {{"errors", ErrorsJsonOf(fit)},
                           {"component_errors", ComponentsJson(fit)},
                           {"not_observable", not_observable},
                           {"set_up", SetUpJson(fit)},
                           {"rank", fit.rank},
                           {"unknowns", fit.singular_values.size()},
                           {"fitted", fit.fitted.size()},
                           {"singular_values", fit.singular_values},
                           {"residual_rms", {{"displacement_um", fit.residual_um}}},
                           {"dof", fit.dof}};
  evaluation.results = evaluation.separation;
  evaluation.results.erase("singular_values");
  evaluation.results["instrument"] = "displacement";
  evaluation.results["machine"] = MachineJson(fit);
  evaluation.results["displaced_rms_um"] = fit.displaced_um;
  if (std::isfinite(fit.repeat_um)) evaluation.results["repeatability_um"] = fit.repeat_um;
  if (!fit.left_out.empty()) evaluation.results["left_out"] = LeftOutJson(fit);
  if (!fit.drift.empty()) evaluation.results["drift"] = DriftJson(fit);
  evaluation.summary = MachineText(fit) + LocationsText(fit) + ComponentsText(fit) +
                       DriftText(fit) + LeftOutText(fit) + NotObservableText(not_observable) + LeftText(fit, over_noise);
  if (std::isfinite(over_noise)) {
    evaluation.results["residual_over_noise"] = over_noise;
    evaluation.misfits = {{"the fit of the displacements", over_noise}};
  }
  return evaluation;
}

void RefuseDisplacements(const Scenario& scenario, const std::string& what) {
  if (!FreeformOf(scenario).ReadsDisplacements()) return;
  throw InputError(
      "freeform_procedure.instrument",
      "there is no " + what + " of displacements at poses: no twin follows their machine",
      "instrument = \"probe\"; of an imported table, import, report and separate tell the machine's errors");
}

}  // namespace twinbench::benches::freeform
