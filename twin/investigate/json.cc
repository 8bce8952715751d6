#include "twin/investigate/json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/core/signal_effect.h"

namespace twinbench::investigate {
namespace {

using nlohmann::json;

json OrNull(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json EffectJson(const EffectSettings& effect, const std::string& bench) {
  json parameters = json::object();
  for (const EffectParameter& p : EntryOf(effect, bench).parameters) {
    const auto value = effect.parameters.find(p.name);
    if (value != effect.parameters.end()) parameters[p.Key()] = value->second / p.to_SI;
    const auto u = effect.finding.u.find(p.name);
    if (u != effect.finding.u.end()) parameters[p.UncertaintyKey()] = u->second / p.to_SI;
  }
  return {{"effect", effect.name}, {"where", effect.where}, {"parameters", std::move(parameters)}};
}

json CauseJson(const Open& open, const std::string& bench) {
  json effects = json::array();
  for (const EffectSettings& effect : open.fit.hypothesis.causes) effects.push_back(EffectJson(effect, bench));
  return {{"name", open.fit.hypothesis.Name()},
          {"probability", open.probability},
          {"chi2", open.fit.chi2},
          {"log_evidence", open.fit.log_evidence},
          {"effects", std::move(effects)}};
}

json StepJson(const Step& step) {
  json believed = json::array();
  for (const auto& [name, probability] : step.believed)
    believed.push_back({{"name", name}, {"probability", probability}});
  return {{"number", step.number},
          {"run", step.run.name},
          {"folder", FolderOf(step)},
          {"words", step.run.words},
          {"sets", step.run.sets},
          {"reason", step.reason},
          {"minutes", step.minutes},
          {"expected_bit", step.expected_bit},
          {"gained_bit", step.gained_bit},
          {"believed", std::move(believed)},
          {"unlisted", step.unlisted},
          {"u_goal", OrNull(step.u_goal)}};
}

}  // namespace

json ToJson(const Investigation& investigation, const std::string& bench) {
  json causes = json::array(), steps = json::array();
  for (const Open& open : investigation.belief.open) causes.push_back(CauseJson(open, bench));
  for (const Step& step : investigation.steps) steps.push_back(StepJson(step));
  json goal = nullptr;
  if (investigation.goal)
    goal = {{"text", investigation.goal->Text()},
            {"u", OrNull(investigation.u_goal)},
            {"met", investigation.IsGoalMet()}};
  return {{"told", ToldName(investigation.told)},
          {"ended", EndedName(investigation.ended)},
          {"minutes", investigation.minutes},
          {"goal", std::move(goal)},
          {"causes", std::move(causes)},
          {"unlisted", investigation.belief.unlisted},
          {"steps", std::move(steps)},
          {"refused", investigation.refused}};
}

}  // namespace twinbench::investigate
