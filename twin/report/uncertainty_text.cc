#include "twin/report/uncertainty_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "twin/report/budget_lists.h"
#include "twin/report/spoken_keys.h"
#include "twin/report/text_table.h"
#include "twin/uncertainty/agreement.h"

namespace twinbench::report {
namespace {

using uncertainty::Budget;
using uncertainty::MonteCarlo;
using uncertainty::Source;
using uncertainty::Spread;

using Rows = std::vector<std::vector<std::string>>;

std::string DofText(double dof) {
  return std::isfinite(dof) ? fmt::format("{:.0f}", dof) : "∞";
}

/// "0.02 nm"; empty of what the readings leave.
std::string InputText(const Source& source) {
  if (uncertainty::IsOfReadings(source)) return "";
  return fmt::format("{:.3g}{}{}", source.u_input, source.input_unit.empty() ? "" : " ", source.input_unit);
}

std::string SensitivityText(const ListSource& s, const std::string& unit) {
  if (uncertainty::IsOfReadings(*s.source)) return "";
  const std::string words = SensitivityUnit(unit, s.source->input_unit);
  return fmt::format("{:.3g}{}{}", s.u / s.source->u_input, words.empty() ? "" : " ", words);
}

std::string SourcesTable(const QuantityList& group) {
  Rows rows;
  for (const ListSource& s : SourcesOf(group)) {
    rows.push_back({WithWords(s.source->name), std::string(1, s.source->type), InputText(*s.source),
                    SensitivityText(s, uncertainty::UnitOf(group.name)), fmt::format("{:.3g}", s.u),
                    DofText(s.source->dof), fmt::format("{:.1f} %", 100.0 * s.share)});
  }
  return TextTable({{"source"},
                    {"type"},
                    {"u(x)", true},
                    {"|c|", true},
                    {"u", true},
                    {"dof", true},
                    {"share of u^2", true}},
                   rows, kBudgetWidth);
}

const Budget* BudgetNamed(const std::vector<const Budget*>& budgets, const std::string& name) {
  const auto found = std::ranges::find(budgets, name, [](const Budget* b) -> const auto& { return b->quantity.name; });
  return found == budgets.end() ? nullptr : *found;
}

/// How many intervals of a list are those of the trials, and how many are not.
std::string AgreementText(const std::map<uncertainty::Verdict, int>& count) {
  const auto of = [&](uncertainty::Verdict v) { return count.contains(v) ? count.at(v) : 0; };
  const int agree = of(uncertainty::Verdict::kAgree), differ = of(uncertainty::Verdict::kDiffer),
            open = of(uncertainty::Verdict::kTooFewTrials);
  if (differ > 0)
    return fmt::format("GUM AND TRIALS DIFFER in {} of {}: take the trials' interval\n", differ,
                       agree + differ + open);
  return open > 0 ? fmt::format("whether GUM and trials agree takes more of them to say, in {} of {}\n", open,
                                agree + open)
                  : "GUM and trials agree\n";
}

/// Root mean square of the trials' standard deviations over a list, and of half their shortest intervals; and
/// whether the budgets' intervals are theirs.
std::string TrialsText(const QuantityList& group, const MonteCarlo& trials) {
  double sd2 = 0.0, half2 = 0.0;
  int count = 0;
  std::array<double, 2> last = {};
  std::map<uncertainty::Verdict, int> verdicts;
  for (const Spread& spread : trials.spreads) {
    const Budget* budget = BudgetNamed(group.budgets, spread.quantity.name);
    if (!budget) continue;
    sd2 += spread.sd * spread.sd;
    half2 += 0.25 * std::pow(spread.shortest[1] - spread.shortest[0], 2);
    last = spread.shortest;
    ++verdicts[Compare(*budget, spread, trials.trials).verdict];
    ++count;
  }
  if (count == 0) return "";
  const std::string interval =
      count == 1 ? fmt::format("{:.4g} to {:.4g}", last[0], last[1])
                 : fmt::format("± {:.3g}", std::sqrt(half2 / count));
  return fmt::format("by trials: u = {:.3g}, shortest 95 % interval {}; {}", std::sqrt(sd2 / count), interval,
                     AgreementText(verdicts));
}

/// The largest correlation between two of them.
std::string JointText(const uncertainty::Joint& joint) {
  if (joint.names.size() < 2) return "";
  Eigen::MatrixXd correlation = uncertainty::CorrelationOf(joint.cov);
  correlation.diagonal().setZero();
  Eigen::Index i = 0, j = 0;
  correlation.cwiseAbs().maxCoeff(&i, &j);
  return fmt::format("{}: {} values are uncertain together; strongest correlation {:+.2f}, {} and {}\n", joint.name,
                     joint.names.size(), correlation(i, j), joint.names[static_cast<std::size_t>(i)],
                     joint.names[static_cast<std::size_t>(j)]);
}

std::string RegionText(const uncertainty::JointSpread& spread) {
  const uncertainty::Region& r = spread.region;
  std::string text = fmt::format("{}: 95 % of the trials have every value within {:.2f} u at once", spread.joint.name,
                                 r.rectangle_k);
  if (std::isfinite(r.ellipsoid_k))
    text += fmt::format(", and lie in the ellipsoid of k = {:.2f} in {} dimensions (GUM: {:.2f})", r.ellipsoid_k,
                        r.dimensions, r.ellipsoid_gum_k);
  return text + "\n";
}

}  // namespace

std::string BudgetText(const std::vector<Budget>& budgets, const std::vector<uncertainty::Joint>& joints,
                       const MonteCarlo* trials) {
  std::string text;
  for (const QuantityList& group : ListsAmong(budgets)) {
    const double u = RootMeanSquare(group, [](const Budget& b) { return b.u; });
    const double expanded = RootMeanSquare(group, [](const Budget& b) { return b.Expanded(); });
    const std::string count =
        group.budgets.size() > 1 ? fmt::format(" ({} values, root mean squares)", group.budgets.size()) : "";
    text += fmt::format("{}{}: u = {:.3g}, expanded uncertainty U = {:.3g} (coverage factor k = {:.2f}, 95 %; {} "
                        "degrees of freedom)\n",
                        WithWords(group.name), count, u, expanded, u > 0.0 ? expanded / u : 0.0, DofText(FewestDof(group)));
    text += SourcesTable(group);
    if (trials) text += TrialsText(group, *trials);
    text += "\n";
  }
  for (const std::string& name : uncertainty::SourcesOfNothing(budgets))
    text += fmt::format(
        "NOT COUNTED: {}: no result is computed with it; what an error of it does to the readings is "
        "in no line above\n",
        name);
  for (const uncertainty::Joint& joint : joints) text += JointText(joint);
  if (!trials) return text;
  for (const uncertainty::JointSpread& spread : trials->together) text += RegionText(spread);
  return text + fmt::format("{} trials{}\n", trials->trials,
                        trials->settled ? "" : ", which is too few for two digits of every uncertainty");
}

}  // namespace twinbench::report
