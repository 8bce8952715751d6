#include "twin/diagnose/isolability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/engine/prior.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr double kInfiniteSize = std::numeric_limits<double>::infinity();

/// The family that shows a cause best, where it does.
struct BestShown {
  int family = 0, grid_point = 0;
};

using FamiliesByCause = std::vector<std::pair<ShownCause, BestShown>>;

/// Of the catalogue, where the first amplitude has that size and the shape is that of a grid point.
std::vector<ParameterEstimate> ParametersAt(const Family& family, int grid_point, double size) {
  const auto amplitudes = std::ssize(family.amplitudes), count = amplitudes + std::ssize(family.shapes);
  return ParametersOf(family, family.ShapeAt(grid_point), size * Eigen::VectorXd::Unit(amplitudes, 0),
                      Eigen::MatrixXd::Zero(count, count));
}

/// The twin can carry it out: all parameters are the catalogue's, and one of them is the family's amplitude (of another
/// value where that is of the trace that it leaves) or as large as it, which for a wave is told by cosine and sine. What
/// goes by another size (a level that signals are cut off at) need not be small in the twin where its signature is.
bool IsOfCatalogue(const ShownCause& cause, const std::string& bench) {
  const EffectEntry* const entry = FindEffect(cause.effect, bench);
  const auto has = [entry](const ParameterEstimate& p) {
    return std::ranges::count(entry->parameters, p.name, &EffectParameter::name) > 0;
  };
  const auto is_size = [&cause](const ParameterEstimate& p) {
    return p.name == cause.smallest.name ||
           std::abs(p.value - cause.smallest.value) <= 1e-6 * std::abs(cause.smallest.value);
  };
  return entry != nullptr && std::ranges::all_of(cause.at_smallest, has) &&
         std::ranges::any_of(cause.at_smallest, is_size);
}

ShownCause CauseShownBy(const Family& family, double information, int grid_point) {
  const Amplitude& a = family.amplitudes.front();
  ShownCause cause;
  cause.effect = family.effect;
  cause.where = family.where;
  cause.plausible_SI = a.prior_sd;
  cause.largest_SI = std::min(tuning::kPlausibleTop * a.prior_sd, std::max(a.upper, -a.lower));
  const double smallest = tuning::kBaarda / std::sqrt(std::max(information, 1e-300));
  const bool is_seen = smallest <= tuning::kPlausibleTop * a.prior_sd;
  cause.smallest = {a.name, a.unit, a.to_SI, is_seen ? smallest : kNaN, kNaN, a.lower, a.upper};
  if (is_seen) cause.at_smallest = ParametersAt(family, grid_point, smallest);
  return cause;
}

/// Every cause once, in the families' order.
FamiliesByCause CausesOf(const Scanner& scanner) {
  FamiliesByCause causes;
  std::vector<double> most;  // information about a plausible size
  for (int k = 0; k < std::ssize(scanner.Families()); ++k) {
    const Family& family = scanner.Families()[static_cast<std::size_t>(k)];
    if (family.kind != Kind::kNamed || family.amplitudes.empty()) continue;
    const double information = scanner.Information(k), sd = family.amplitudes.front().prior_sd;
    const double of_plausible = information * sd * sd;
    const BestShown shown{k, scanner.MostTelling(k)};
    const auto known = std::ranges::find_if(causes, [&family](const auto& one) {
      return one.first.effect == family.effect && one.first.where == family.where;
    });
    const auto at = static_cast<std::size_t>(known - causes.begin());
    if (known == causes.end()) {
      causes.emplace_back(CauseShownBy(family, information, shown.grid_point), shown);
      most.push_back(of_plausible);
    } else if (of_plausible > most[at]) {
      *known = {CauseShownBy(family, information, shown.grid_point), shown};
      most[at] = of_plausible;
    }
  }
  return causes;
}

/// Signatures of unit size, whitened: rows x shapes.
Eigen::MatrixXd WhiteSignatures(const LinearRun& run, const NoiseModel& noise, const std::vector<Family>& families,
                                const std::vector<BestShown>& shapes) {
  Eigen::MatrixXd columns(run.Rows(), std::ssize(shapes));
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const Family& family = families[static_cast<std::size_t>(shapes[k].family)];
    columns.col(static_cast<Eigen::Index>(k)) = family.ColumnsAt(shapes[k].grid_point).col(0);
  }
  return noise.Whiten(run, columns);
}

bool IsFamilyOf(const Family& family, const ShownCause& cause) {
  return family.kind == Kind::kNamed && family.effect == cause.effect && family.where == cause.where;
}

/// One shape of a cause.
struct ShapeOfCause {
  std::size_t cause = 0;
  BestShown at;
  bool shows_most = false;
  double smallest_SI = kNaN;  // size that is found in this shape
};

/// Of each cause the shape that shows most, and some others of the grids of its families, evenly spread.
/// @param rows  Of the design: of long records fewer, for each is weighed against the whole catalogue.
std::vector<ShapeOfCause> ShapesOf(const Scanner& scanner, const FamiliesByCause& causes, Eigen::Index rows) {
  constexpr Eigen::Index kManyRows = 4000;
  const std::size_t most_others = rows > kManyRows ? 2 : 6;
  std::vector<ShapeOfCause> shapes;
  for (std::size_t k = 0; k < causes.size(); ++k) {
    const auto& [cause, best] = causes[k];
    if (!std::isfinite(cause.smallest.value)) continue;
    shapes.push_back({k, best, true, cause.smallest.value});
    std::vector<ShapeOfCause> others;
    for (int f = 0; f < std::ssize(scanner.Families()); ++f) {
      const Family& family = scanner.Families()[static_cast<std::size_t>(f)];
      if (!IsFamilyOf(family, cause)) continue;
      for (int g = 0; g < family.grid; ++g) {
        const double smallest_SI = tuning::kBaarda / std::sqrt(std::max(scanner.Information(f, g), 1e-300));
        const bool is_best = f == best.family && g == best.grid_point;
        if (!is_best && smallest_SI <= cause.largest_SI) others.push_back({k, {f, g}, false, smallest_SI});
      }
    }
    const std::size_t count = std::min(most_others, others.size());
    for (std::size_t i = 0; i < count; ++i) shapes.push_back(others[(2 * i + 1) * others.size() / (2 * count)]);
  }
  return shapes;
}

/// One shape of a cause in one size.
struct Trial {
  std::size_t shape;
  double times, next_times;  // its smallest size; infinite: there is no larger plausible one
};

/// From the smallest size by octaves to the largest plausible one.
std::vector<Trial> TrialsOf(const FamiliesByCause& causes, const std::vector<ShapeOfCause>& shapes) {
  constexpr double kMostTimes = 32.0;
  std::vector<Trial> trials;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const ShownCause& cause = causes[shapes[k].cause].first;
    const double most = std::clamp(cause.largest_SI / shapes[k].smallest_SI, 1.0, kMostTimes);
    for (double times = 1.0; times < most; times *= 2.0) trials.push_back({k, times, std::min(2.0 * times, most)});
    trials.push_back({k, most, kInfiniteSize});
  }
  return trials;
}

/// Causes x trials, all families of a cause together.
struct Weighed {
  Eigen::MatrixXd log_posterior;  // odds against no cause
  Eigen::MatrixXd explained;      // of the power, the amplitudes free
};

Weighed WeighedBy(const Scanner& scanner, const Evidence& evidence, const FamiliesByCause& causes) {
  const std::vector<Family>& families = scanner.Families();
  const Eigen::MatrixXd logs = evidence.log_bayes.colwise() + LogPriors(families);
  Weighed weighed;
  weighed.log_posterior.resize(std::ssize(causes), logs.cols());
  weighed.explained.resize(std::ssize(causes), logs.cols());
  for (std::size_t k = 0; k < causes.size(); ++k) {
    std::vector<Eigen::Index> own;
    for (std::size_t f = 0; f < families.size(); ++f) {
      if (IsFamilyOf(families[f], causes[k].first)) own.push_back(static_cast<Eigen::Index>(f));
    }
    for (Eigen::Index j = 0; j < logs.cols(); ++j) {
      weighed.log_posterior(static_cast<Eigen::Index>(k), j) = LogSum(logs.col(j)(own));
      weighed.explained(static_cast<Eigen::Index>(k), j) = evidence.explained.col(j)(own).maxCoeff();
    }
  }
  return weighed;
}

/// Whether evidence that is `expected` in favour of what is there may leave the other cause in the answer.
bool MayShareTheAnswer(double expected) {
  constexpr double kOf95 = 1.645;
  const double least = expected - kOf95 * std::sqrt(2.0 * std::max(0.0, expected));
  return least < std::log(tuning::kNamedFrom / (1.0 - tuning::kNamedFrom));
}

/// @param trials  Those of one shape in ascending size.
std::vector<Confusable> ConfusableOf(const std::vector<ShapeOfCause>& shapes, const std::vector<Trial>& trials,
                                     const Weighed& weighed) {
  constexpr double kImitates = 0.1;  // of the power: what explains less is no rival, however small the cause
  std::map<std::pair<std::size_t, std::size_t>, Confusable> pairs;
  for (std::size_t j = 0; j < trials.size(); ++j) {
    const ShapeOfCause& shape = shapes[trials[j].shape];
    const auto column = static_cast<Eigen::Index>(j);
    const auto present = static_cast<Eigen::Index>(shape.cause);
    for (Eigen::Index other = 0; other < weighed.explained.rows(); ++other) {
      if (other == present) continue;
      const double expected = weighed.log_posterior(present, column) - weighed.log_posterior(other, column);
      const double imitated = weighed.explained(other, column) / weighed.explained(present, column);
      if (imitated < kImitates || !MayShareTheAnswer(expected)) continue;
      Confusable& pair = pairs[{shape.cause, static_cast<std::size_t>(other)}];
      pair.present = shape.cause;
      pair.blamed = static_cast<std::size_t>(other);
      if (shape.shows_most) pair.told_from = trials[j].next_times;
      pair.surely_told_from = std::max(pair.surely_told_from, trials[j].next_times);
    }
  }
  std::vector<Confusable> confusable;
  for (const auto& [names, pair] : pairs) confusable.push_back(pair);
  return confusable;
}

std::vector<Confusable> ConfusableOf(const LinearRun& run, const Analysis& analysis, const FamiliesByCause& causes) {
  const Scanner& scanner = *analysis.scanner;
  const std::vector<ShapeOfCause> shapes = ShapesOf(scanner, causes, run.Rows());
  const std::vector<Trial> trials = TrialsOf(causes, shapes);
  if (trials.empty()) return {};
  std::vector<BestShown> at;
  for (const ShapeOfCause& shape : shapes) at.push_back(shape.at);
  const Eigen::MatrixXd white = WhiteSignatures(run, analysis.noise, scanner.Families(), at);
  Eigen::MatrixXd data(white.rows(), std::ssize(trials));
  for (std::size_t j = 0; j < trials.size(); ++j)
    data.col(static_cast<Eigen::Index>(j)) = trials[j].times * shapes[trials[j].shape].smallest_SI *
                                             white.col(static_cast<Eigen::Index>(trials[j].shape));
  Projected projected = Project(*analysis.projector, {}, data);
  projected.power.array() += analysis.projector->DegreesOfFreedom();
  const Evidence evidence = scanner.Scan(projected, {});
  return ConfusableOf(shapes, trials, WeighedBy(scanner, evidence, causes));
}

}  // namespace

Isolability IsolabilityOf(const LinearRun& run, const Analysis& analysis) {
  const Scanner& scanner = *analysis.scanner;
  const FamiliesByCause causes = CausesOf(scanner);
  Isolability isolability;
  Eigen::VectorXd plausible(std::ssize(causes));
  std::vector<BestShown> best;
  for (std::size_t k = 0; k < causes.size(); ++k) {
    isolability.causes.push_back(causes[k].first);
    plausible[static_cast<Eigen::Index>(k)] = causes[k].first.plausible_SI;
    best.push_back(causes[k].second);
  }
  for (ShownCause& cause : isolability.causes) {
    if (!IsOfCatalogue(cause, run.bench)) cause.at_smallest.clear();
  }
  const Eigen::MatrixXd white = WhiteSignatures(run, analysis.noise, scanner.Families(), best);
  const Eigen::MatrixXd sized = white * plausible.asDiagonal();
  isolability.information = sized.transpose() * analysis.projector->Apply(sized);
  isolability.confusable = ConfusableOf(run, analysis, causes);
  return isolability;
}

void KeepSurelyTold(const Isolability& other, Isolability& isolability) {
  const auto index_of = [&isolability](const ShownCause& cause) {
    return std::ranges::find_if(isolability.causes, [&cause](const ShownCause& one) {
             return one.effect == cause.effect && one.where == cause.where;
           }) - isolability.causes.begin();
  };
  for (const Confusable& pair : other.confusable) {
    const auto present = static_cast<std::size_t>(index_of(other.causes[pair.present]));
    const auto blamed = static_cast<std::size_t>(index_of(other.causes[pair.blamed]));
    if (std::max(present, blamed) == isolability.causes.size()) continue;
    const auto known = std::ranges::find_if(isolability.confusable, [&](const Confusable& one) {
      return one.present == present && one.blamed == blamed;
    });
    if (known == isolability.confusable.end()) {
      isolability.confusable.push_back({present, blamed, 0.0, pair.surely_told_from});
    } else {
      known->surely_told_from = std::max(known->surely_told_from, pair.surely_told_from);
    }
  }
}

EffectSettings AsEffect(const ShownCause& cause, const std::string& bench) {
  EffectSettings effect;
  effect.name = cause.effect;
  effect.where = cause.where;
  const EffectEntry* const entry = FindEffect(cause.effect, bench);
  Require(entry != nullptr, "a cause that a run shows is in the bench's catalogue");
  for (const EffectParameter& p : entry->parameters) {
    if (p.BelongsTo(cause.where)) effect.parameters[p.name] = p.default_SI;
  }
  for (const ParameterEstimate& p : cause.at_smallest) effect.parameters[p.name] = p.value;
  return effect;
}

std::vector<std::vector<std::size_t>> NeverTold(const Isolability& isolability) {
  std::vector<std::size_t> set_of(isolability.causes.size());
  for (std::size_t k = 0; k < set_of.size(); ++k) set_of[k] = k;
  for (const Confusable& pair : isolability.confusable) {
    if (std::isfinite(pair.told_from)) continue;
    const auto [from, to] = std::minmax(set_of[pair.present], set_of[pair.blamed]);
    std::ranges::replace(set_of, std::size_t{to}, std::size_t{from});
  }
  std::map<std::size_t, std::vector<std::size_t>> sets;
  for (std::size_t k = 0; k < set_of.size(); ++k) sets[set_of[k]].push_back(k);
  std::vector<std::vector<std::size_t>> never;
  for (auto& [first, members] : sets) {
    if (members.size() > 1) never.push_back(std::move(members));
  }
  return never;
}

}  // namespace twinbench::diagnose
