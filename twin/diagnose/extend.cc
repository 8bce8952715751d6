#include "twin/diagnose/extend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/bench_format.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/core/signal_effect.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

constexpr double kSmallest_SI = 1e-9;
constexpr double kRounding_SI = 1e-11;

bool IsAccepted(const Cause& cause, const DiagnosisRun& run) {
  return std::ranges::any_of(run.accepted, [&](const Accepted& accepted) {
    return accepted.family.effect == cause.effect && accepted.family.where == cause.where;
  });
}

/// Causes of a verdict "named" are all at work. Of a tie or beside the unknown it is those that the search took in,
/// and single disturbed readings, which it leaves out and which tie with nothing.
bool IsAtWork(const Cause& cause, const DiagnosisRun& run) {
  const bool is_disturbed = cause.effect == "outliers" && cause.probability > 0.5;
  return run.diagnosis.verdict == Verdict::kNamed || is_disturbed || IsAccepted(cause, run);
}

/// What the search took in predicts readings that it was not fitted to, or nothing could be held out.
bool IsProven(const DiagnosisRun& run) {
  return run.diagnosis.gain.folds == 0 || run.diagnosis.gain.positive;
}

/// Without what the search took in.
DiagnosisRun WithoutSearched(DiagnosisRun run) {
  std::erase_if(run.diagnosis.causes, [&](const Cause& cause) { return IsAccepted(cause, run); });
  run.accepted.clear();
  return run;
}

/// What the cause says of itself where the catalogue has a word for it.
void TakeEstimates(const Cause& cause, const EffectEntry& entry, EffectSettings& effect) {
  for (const ParameterEstimate& estimate : cause.parameters) {
    const auto parameter = std::find_if(entry.parameters.begin(), entry.parameters.end(),
                                        [&](const EffectParameter& p) { return p.name == estimate.name; });
    if (parameter == entry.parameters.end() || !std::isfinite(estimate.value)) continue;
    effect.parameters[estimate.name] = std::clamp(estimate.value, parameter->lower_SI, parameter->upper_SI);
    if (std::isfinite(estimate.u)) effect.finding.u[estimate.name] = estimate.u;
  }
  effect.finding.log_evidence = cause.log_evidence;
  effect.finding.probability = std::min(cause.probability, 1.0);  // sums of shares round
}

/// A structure without a name on one channel, where it is known.
struct Known {
  std::vector<int> reading;
  Eigen::VectorXd time_s, value_SI;
};

/// Times that a table may go by: each later than the one before.
bool Ascends(const Eigen::VectorXd& time_s) {
  for (Eigen::Index i = 1; i < time_s.size(); ++i) {
    if (!(time_s[i] > time_s[i - 1])) return false;
  }
  return time_s.size() > 0;
}

/// Nothing if it does not show.
std::vector<EmpiricalSettings> TableOf(const Known& known, const std::string& channel, const LinearRun& run,
                                       bool goes_by_time) {
  if (known.value_SI.size() == 0 || known.value_SI.cwiseAbs().maxCoeff() < kSmallest_SI) return {};
  EmpiricalSettings table;
  table.channel = channel;
  const bool has_times = known.time_s.size() == known.value_SI.size() && known.time_s.allFinite();
  if (has_times) table.time_s.assign(known.time_s.begin(), known.time_s.end());
  if (has_times && goes_by_time && Ascends(known.time_s)) {
    table.by = "time";
  } else {
    table.reading = known.reading;
  }
  std::vector<double>& values = ValuesOf(table, FormatOf(run.bench).signal);
  const bool is_angle = FormatOf(run.bench).signal == SignalKind::kAngle;
  for (const double value : known.value_SI) {
    const double whole = is_angle && std::abs(value) > units::turn ? std::remainder(value, units::turn)
                                                                   : value;  // no device shows more
    values.push_back(std::round(whole / kRounding_SI) * kRounding_SI);
  }
  return {table};
}

std::vector<EmpiricalSettings> EmpiricalsOf(const Accepted& accepted, const LinearRun& run) {
  const bool by_time = accepted.family.goes_by_time;
  if (!accepted.readings.empty())
    return TableOf({accepted.readings, accepted.times_s, accepted.at_readings}, run.channels.front(), run, by_time);
  const Eigen::VectorXd signal = accepted.columns * accepted.amplitudes;
  const int channels = run.Channels();
  std::vector<EmpiricalSettings> all;
  for (int c = 0; c < channels; ++c) {
    const Eigen::VectorXd own = signal(Eigen::seqN(c, signal.size() / channels, channels));
    std::ranges::move(TableOf({run.schedule.reading, run.schedule.time_s, own},
                              run.channels[static_cast<std::size_t>(c)], run, by_time),
                      std::back_inserter(all));
  }
  return all;
}

/// Columns of the family's series on each channel (channel after channel), or of its own rows.
Eigen::VectorXd Coefficients(const Accepted& accepted) {
  const Family& family = accepted.family;
  return family.map.size() > 0 ? Eigen::VectorXd(family.map * accepted.amplitudes) : accepted.amplitudes;
}

/// A product with its size.
struct Sized {
  EffectSettings signal;
  double size = 0.0;  // SI of the channel
};

Sized WithSize(const Product& product, const std::string& channel, const Eigen::VectorXd& columns,
               double shown_SI) {
  Sized sized{product.signal, 0.0};
  if (sized.signal.where.empty()) sized.signal.where = channel;
  const double cosine = product.scale * columns[product.column];
  if (!product.is_wave) {
    const bool is_share = product.signal.signal == "share";
    sized.signal.parameters[is_share ? "share" : "amplitude"] = cosine;
    sized.size = std::abs(cosine) * (is_share ? shown_SI : 1.0);
    return sized;
  }
  const double sine = product.scale * columns[product.column + 1];
  sized.size = std::hypot(cosine, sine);
  sized.signal.parameters["amplitude"] = sized.size;
  sized.signal.parameters["phase"] = std::atan2(-sine, cosine);
  return sized;
}

/// What the twin can carry out of a structure without a name; nothing if it cannot.
std::vector<EffectSettings> SignalsOf(const Accepted& accepted, const LinearRun& run) {
  const std::vector<Product> products = accepted.family.products
                                            ? accepted.family.products(accepted.shape, accepted.grid_point)
                                            : std::vector<Product>{};
  if (products.empty()) return {};
  const Eigen::VectorXd all = Coefficients(accepted);
  const double shown_SI = run.Predicted().cwiseAbs().maxCoeff();
  const bool everywhere = products.front().signal.where.empty();
  const Eigen::Index count = everywhere ? all.size() / run.Channels() : all.size();
  std::vector<Sized> sized;
  for (int c = 0; c < (everywhere ? run.Channels() : 1); ++c) {
    for (const Product& product : products)
      sized.push_back(WithSize(product, run.channels[static_cast<std::size_t>(c)],
                               all.segment(everywhere ? c * count : 0, count), shown_SI));
  }
  constexpr double kSlight = 1e-3;  // of the largest: what a pattern leaves where it does not show
  const double largest = std::ranges::max(sized, {}, &Sized::size).size;
  std::vector<EffectSettings> signals;
  for (Sized& s : sized) {
    if (s.size > kSlight * largest) signals.push_back(std::move(s.signal));
  }
  return signals;
}

void AddUnnamed(const Accepted& accepted, const DiagnosisRun& run, const std::string& provenance,
                Scenario& scenario) {
  std::vector<EffectSettings> signals = SignalsOf(accepted, run.run);
  for (EffectSettings& signal : signals) {
    signal.finding.provenance = provenance;
    signal.finding.probability = std::min(run.diagnosis.unknown.probability, 1.0);
    scenario.effects.push_back(std::move(signal));
  }
  if (!signals.empty()) return;
  for (EmpiricalSettings& empirical : EmpiricalsOf(accepted, run.run)) {
    empirical.signature = run.diagnosis.unknown.signature;
    empirical.provenance = provenance;
    scenario.empiricals.push_back(std::move(empirical));
  }
}

std::string What(const Scenario& scenario, const Scenario& extended) {
  std::string text;
  for (std::size_t i = scenario.effects.size(); i < extended.effects.size(); ++i) {
    const EffectSettings& effect = extended.effects[i];
    text += fmt::format("# added: effect {}{}{}{}{}\n", effect.name, effect.signal.empty() ? "" : " ",
                        effect.signal, effect.where.empty() ? "" : " at ", effect.where);
  }
  for (std::size_t i = scenario.empiricals.size(); i < extended.empiricals.size(); ++i) {
    const EmpiricalSettings& empirical = extended.empiricals[i];
    text += fmt::format("# added: empirical signal on {}: {}\n", empirical.channel, empirical.signature);
  }
  return text.empty() ? "# nothing was added\n" : text;
}

/// A comment must stay on its line.
std::string OneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

}  // namespace

EffectSettings EffectOf(const Cause& cause, const std::string& bench, const std::string& provenance) {
  const EffectEntry* entry = FindEffect(cause.effect, bench);
  Require(entry != nullptr, "a named cause is an effect of the bench");
  EffectSettings effect;
  effect.name = cause.effect;
  effect.where = cause.where;
  effect.finding.provenance = provenance;
  for (const EffectParameter& parameter : entry->parameters)
    effect.parameters[parameter.name] = parameter.default_SI;
  TakeEstimates(cause, *entry, effect);
  return effect;
}

bool IsTabulated(const Accepted& accepted, const LinearRun& run) {
  return accepted.family.kind == Kind::kUnknown && SignalsOf(accepted, run).empty();
}

bool IsRepeatedOnly(const Accepted& accepted, const LinearRun& run) {
  return !accepted.family.goes_by_time && IsTabulated(accepted, run);
}

bool HasFittedSize(const Cause& cause, const std::string& bench) {
  const EffectEntry* const entry = FindEffect(cause.effect, bench);
  if (entry == nullptr || entry->parameters.empty()) return true;
  return std::ranges::any_of(cause.parameters, [&](const ParameterEstimate& estimate) {
    return std::isfinite(estimate.value) && std::ranges::count(entry->parameters, estimate.name, &EffectParameter::name) > 0;
  });
}

Scenario Extend(const Scenario& scenario, const DiagnosisRun& run, const std::string& provenance) {
  Scenario extended = scenario;
  for (const Cause& cause : run.diagnosis.causes) {
    if (IsAtWork(cause, run) && HasFittedSize(cause, scenario.bench)) extended.effects.push_back(EffectOf(cause, scenario.bench, provenance));
  }
  for (const Accepted& accepted : run.accepted) {
    if (accepted.family.kind == Kind::kUnknown) AddUnnamed(accepted, run, provenance, extended);
  }
  return extended;
}

std::string ExtendedToml(const Scenario& scenario, const DiagnosisRun& run, const std::string& provenance) {
  const Scenario extended = Extend(scenario, IsProven(run) ? run : WithoutSearched(run), provenance);
  return fmt::format("# {}\n{}\n{}", OneLine(provenance), What(scenario, extended), WriteScenario(extended));
}

}  // namespace twinbench::diagnose
