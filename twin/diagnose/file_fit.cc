#include "twin/diagnose/file_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "twin/diagnose/accepted_columns.h"
#include "twin/diagnose/at.h"
#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr int kMostRounds = 5;

Projector ProjectorOf(const DiagnosisRun& found) {
  return {found.noise.Whiten(found.run, found.run.nuisance.jacobian), found.run.nuisance};
}

/// The catalogue's parameters at these amplitudes; their uncertainties are not looked at.
std::vector<ParameterEstimate> ParametersAt(const Accepted& accepted, const Eigen::VectorXd& amplitudes) {
  const Family& family = accepted.family;
  const Eigen::Index count = amplitudes.size() + accepted.shape.size();
  if (family.parameters) return family.parameters(accepted.shape, amplitudes, Eigen::MatrixXd::Zero(count, count));
  std::vector<ParameterEstimate> parameters;
  for (std::size_t k = 0; k < family.amplitudes.size(); ++k) {
    const Amplitude& a = family.amplitudes[k];
    parameters.push_back(
        {a.name, a.unit, a.to_SI, amplitudes[static_cast<Eigen::Index>(k)], kNaN, a.lower, a.upper});
  }
  return parameters;
}

ParameterEstimate* Find(Cause& cause, const std::string& name) {
  const auto found = std::ranges::find(cause.parameters, name, &ParameterEstimate::name);
  return found == cause.parameters.end() ? nullptr : &*found;
}

/// The cause that these parameters were told of; null if there is none.
Cause* ToldOf(const Accepted& accepted, std::vector<Cause>& causes) {
  const std::vector<ParameterEstimate> parameters = ParametersAt(accepted, accepted.amplitudes);
  const auto same = [&](Cause& cause) {
    if (cause.effect != accepted.family.effect || cause.where != accepted.family.where) return false;
    return std::ranges::all_of(parameters, [&cause](const ParameterEstimate& p) {
      const ParameterEstimate* told = Find(cause, p.name);
      return told && std::abs(told->value - p.value) <= 1e-9 * std::max(std::abs(told->value), std::abs(p.value));
    });
  };
  const auto found = std::ranges::find_if(causes, same);
  return found == causes.end() ? nullptr : &*found;
}

/// Moves the amplitudes and what is told of them. Structure without a name is written as it is accepted.
void Move(const Eigen::VectorXd& by, DiagnosisRun& found) {
  Eigen::Index column = 0;
  for (Accepted& accepted : found.accepted) {
    const Eigen::VectorXd moved = accepted.amplitudes + by.segment(column, accepted.columns.cols());
    column += accepted.columns.cols();
    if (accepted.family.kind == Kind::kUnknown) {
      if (accepted.readings.empty()) accepted.amplitudes = moved;
      continue;
    }
    Cause* const cause = ToldOf(accepted, found.diagnosis.causes);
    if (!cause) continue;
    for (const ParameterEstimate& p : ParametersAt(accepted, moved)) Find(*cause, p.name)->value = p.value;
    accepted.amplitudes = moved;
  }
}

/// A diagnosis on its way, what its file takes away and what that leaves.
struct Tried {
  DiagnosisRun found;
  Eigen::VectorXd removed;
  double left;
};

/// One round: as far as the signatures say, or less far where the twin bends. @return true if the file explains
/// more.
bool MoveOnce(const RemovedBy& removed_by, DiagnosisRun& found, Eigen::VectorXd& removed) {
  const Projector projector = ProjectorOf(found);
  const Columns columns = ColumnsOf(found.accepted, found.run.Rows());
  const Eigen::MatrixXd left = found.run.residual - removed;
  const Eigen::VectorXd by = FitAmplitudes(projector, found.noise.Whiten(found.run, columns.S),
                                           found.noise.Whiten(found.run, left), columns.prior_precision);
  const double before = PowerLeft(found, removed), foreseen = PowerLeft(found, removed + columns.S * by);
  std::optional<Tried> best;
  for (const double share : {1.0, 0.5, 0.25}) {
    Tried tried{found, {}, 0.0};
    Move(share * by, tried.found);
    tried.removed = removed_by(tried.found);
    tried.left = PowerLeft(tried.found, tried.removed);
    if (best && tried.left > best->left) break;
    best = std::move(tried);
    constexpr double kAsForeseen = 0.75;
    if (before - best->left > kAsForeseen * (before - foreseen)) break;
  }
  const double noise = std::max(1.0, best->left / projector.DegreesOfFreedom());
  if (!(best->left < before - noise)) return false;
  found = std::move(best->found);
  removed = std::move(best->removed);
  return true;
}

/// Its sizes are all within what is not called a size.
bool IsNothing(const Accepted& accepted, std::vector<Cause>& causes) {
  Cause* const cause = ToldOf(accepted, causes);
  if (!cause || accepted.family.parameters) return false;
  return std::ranges::all_of(accepted.family.amplitudes, [cause](const Amplitude& a) {
    const ParameterEstimate* p = Find(*cause, a.name);
    return p && std::isfinite(p->u) && std::abs(p->value) < tuning::kHeadline * p->u;
  });
}

/// Without what has become nothing. @return true if there was something and it is not missed.
bool LeaveOutOne(const RemovedBy& removed_by, DiagnosisRun& found, Eigen::VectorXd& removed) {
  for (std::size_t k = 0; k < found.accepted.size() && found.accepted.size() > 1; ++k) {
    if (!IsNothing(found.accepted[k], found.diagnosis.causes)) continue;
    DiagnosisRun without = found;
    const Cause* const told = ToldOf(found.accepted[k], found.diagnosis.causes);
    without.diagnosis.causes.erase(without.diagnosis.causes.begin() + (told - found.diagnosis.causes.data()));
    without.accepted.erase(without.accepted.begin() + static_cast<std::ptrdiff_t>(k));
    Eigen::VectorXd now = removed_by(without);
    while (MoveOnce(removed_by, without, now)) {
    }
    const double before = PowerLeft(found, removed), after = PowerLeft(found, now);
    const double noise = std::max(1.0, before / ProjectorOf(found).DegreesOfFreedom());
    if (after - before > tuning::kHeadline * tuning::kHeadline * noise) continue;
    found = std::move(without);
    removed = now;
    return true;
  }
  return false;
}

}  // namespace

double PowerLeft(const DiagnosisRun& found, const Eigen::VectorXd& removed) {
  const Eigen::MatrixXd left = found.run.residual - removed;
  return ProjectorOf(found).Apply(found.noise.Whiten(found.run, left)).squaredNorm();
}

void FitThroughFile(const RemovedBy& removed_by, DiagnosisRun& found, Eigen::VectorXd& removed) {
  for (int round = 0; round < kMostRounds; ++round) {
    if (!MoveOnce(removed_by, found, removed)) break;
  }
  while (LeaveOutOne(removed_by, found, removed)) {
  }
}

}  // namespace twinbench::diagnose
