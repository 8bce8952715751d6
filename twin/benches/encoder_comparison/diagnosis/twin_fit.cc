#include "twin/benches/encoder_comparison/diagnosis/twin_fit.h"

#include <algorithm>
#include <utility>

#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/benches/encoder_comparison/format.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {

bool IsHeld(const EffectSettings& effect) {
  return Deviations(effect) > tuning::kHeadline;
}

std::vector<EffectSettings> EffectsWithout(std::size_t k, const std::vector<EffectSettings>& effects) {
  std::vector<EffectSettings> others = effects;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
  return others;
}

void LeaveFree(const AskedAgain& asked, Nuisance& nuisance) {
  const Eigen::Index had = nuisance.jacobian.cols(), count = asked.slopes.cols();
  Eigen::MatrixXd all(nuisance.jacobian.rows(), had + count);
  all << nuisance.jacobian.toDense(), asked.slopes;
  nuisance.jacobian = all.sparseView();
  nuisance.prior_precision.conservativeResize(had + count);
  nuisance.prior_precision.tail(count) = asked.sd.cwiseAbs2().cwiseInverse();
}

TwinFit::TwinFit(const LargeCauses& large, const Scenario& scenario, const model::FollowMaker& follow)
    : large_(large), scenario_(scenario), follow_(follow) {
  const LinearRun& plain = Run().run;
  const NoiseModel noise{plain.sigma, {}};
  projector_ = std::make_unique<Projector>(noise.Whiten(plain, plain.nuisance.jacobian), plain.nuisance);
  const ErrorOfTwin nothing = FollowTwin(Run(), scenario_, follow_, Run().offset_rad);
  nothing_ = nothing.error_rad;
  offset_rad_ = nothing.offset_rad;
}

Scenario TwinFit::With(const std::vector<EffectSettings>& effects) const {
  Scenario scenario = scenario_;
  scenario.effects.insert(scenario.effects.end(), effects.begin(), effects.end());
  return scenario;
}

Eigen::VectorXd TwinFit::Shown(const std::vector<EffectSettings>& effects) const {
  constexpr double kSame = 1e-4;  // of the noise of a reading
  const double same_rad = std::max(kSameOffset_rad, kSame * Run().run.sigma.minCoeff());
  ErrorOfTwin followed = FollowTwin(Run(), With(effects), follow_, offset_rad_, same_rad);
  // Of parameters that are impossible together the twin shows nothing, and where it stood then is no place to begin.
  if (followed.offset_rad.allFinite()) offset_rad_ = std::move(followed.offset_rad);
  return followed.error_rad - nothing_;
}

Eigen::VectorXd TwinFit::WhiteOf(const Eigen::VectorXd& rows) const {
  const Eigen::MatrixXd white = Run().run.sigma.cwiseInverse().asDiagonal() * rows;
  return Project(*projector_, {}, white).rows.col(0);
}

double TwinFit::Memory(const Eigen::VectorXd& rows) const {
  return MemoryOf(WhiteOf(rows), Run().run.schedule.pass);
}

double TwinFit::PowerWithout(std::size_t k, const AskedAgain& asked) const {
  return PowerOf(Run().run.residual - Shown(EffectsWithout(k, asked.effects)));
}

AskedAgain TwinFit::Ask(const std::vector<LargeCause>& causes, const Eigen::VectorXd& rows,
                        const Projector& projector) const {
  return AskAgain([this](const auto& effects) { return Shown(effects); }, EffectsOf(causes), MovableOf(causes),
                  benches::encoder::Format().effects, rows, Run().run.sigma, projector);
}

AskedAgain TwinFit::Ask(const std::vector<LargeCause>& causes, const Eigen::VectorXd& rows) const {
  return Ask(causes, rows, *projector_);
}

AskedAgain TwinFit::Ask(const std::vector<LargeCause>& causes, const Eigen::VectorXd& rows,
                        const Nuisance& beside) const {
  const LinearRun& plain = Run().run;
  const NoiseModel noise{plain.sigma, {}};
  return Ask(causes, rows, Projector(noise.Whiten(plain, beside.jacobian), beside));
}

FittedCauses TwinFit::Fit(std::vector<LargeCause> causes) const {
  for (;;) {
    AskedAgain asked = Ask(causes);
    const std::size_t before = causes.size();
    TakeOver(asked, causes);
    std::erase_if(causes, [](const LargeCause& cause) { return !IsHeld(cause.effect); });
    if (causes.size() < before) continue;
    const double power = PowerOf(asked.left);
    return {std::move(causes), std::move(asked), power};
  }
}

}  // namespace twinbench::diagnose::encoder
