#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "twin/benches/freeform_five_axis/bench.h"
#include "twin/benches/freeform_five_axis/estimators/published.h"
#include "twin/benches/freeform_five_axis/estimators/volumetric.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/core/stream.h"
#include "twin/report/json_units.h"

namespace twinbench::benches::freeform {
namespace {

using namespace estimators;

Identification Identified(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator) {
  constexpr std::size_t kFewest = 12;
  const std::vector<PoseRead> poses = PosesOf(readings, FreeformOf(scenario));
  if (poses.size() < kFewest)
    throw InputError("readings", fmt::format("{} of {} have a value", poses.size(), readings.size()),
                     fmt::format("at least {}", kFewest));
  return estimator == Estimator::kPublished ? IdentifyPublished(FreeformOf(scenario), poses)
                                            : Identify(FreeformOf(scenario), poses);
}

nlohmann::json ErrorsJson(const Identification& found) {
  nlohmann::json errors;
  for (int axis = 0; axis < kMachineAxes; ++axis) {
    for (int error = 0; error < kBodyErrors; ++error) {
      nlohmann::json& one = errors[std::string(kAxisNames[static_cast<std::size_t>(axis)]) + "." +
                                   kBodyErrorNames[static_cast<std::size_t>(error)]];
      one["unit"] = IsRotation(error) ? "arcsec" : "um";
      for (int term = 0; term < kCubicTerms; ++term) {
        const int k = CubicAt(axis, error, term);
        one["coefficients"].push_back(found.unknowns[k]);
        one["u"].push_back(found.u[k]);
        one["identified"].push_back(static_cast<bool>(found.identified[static_cast<std::size_t>(k)]));
      }
    }
  }
  return errors;
}

nlohmann::json SquarenessJson(const Identification& found) {
  nlohmann::json all;
  for (int k = 0; k < kSquarenesses; ++k) {
    const int unknown = SquarenessAt(k);
    all[kSquarenessNames[static_cast<std::size_t>(k)]] = {
        {"value", found.unknowns[unknown]},
        {"u", found.u[unknown]},
        {"identified", static_cast<bool>(found.identified[static_cast<std::size_t>(unknown)])}};
  }
  return all;
}

nlohmann::json MountingsJson(const Identification& found) {
  nlohmann::json all = nlohmann::json::array();
  for (int setup = 0; setup < found.setups; ++setup) {
    nlohmann::json one = {{"setup", setup}};
    for (int error = 0; error < kBodyErrors; ++error) {
      const int k = MountingAt(setup, error);
      one[std::string(kBodyErrorNames[static_cast<std::size_t>(error)]) + (IsRotation(error) ? "_arcsec" : "_um")] =
          {{"value", found.unknowns[k]}, {"u", found.u[k]}};
    }
    all.push_back(one);
  }
  return all;
}

nlohmann::json SeparationJson(const Identification& found) {
  nlohmann::json lost = nlohmann::json::array();
  for (const NotSeparable& one : found.not_separable) lost.push_back({{"what", one.what}, {"why", one.why}});
  return {
      {"errors", ErrorsJson(found)},
      {"squareness", SquarenessJson(found)},
      {"mountings", MountingsJson(found)},
      {"rank", found.rank},
      {"unknowns", found.unknowns.size()},
      {"singular_values", std::vector<double>(found.singular_values.begin(), found.singular_values.end())},
      {"not_separable", lost},
      {"residual_rms",
       {{"qpd_x_V", found.residual_rms[0]}, {"qpd_y_V", found.residual_rms[1]}, {"ccd_px", found.residual_rms[2]}}},
      {"dof", found.dof}};
}

std::string SummaryOf(const Identification& found) {
  const auto of_machine = std::count(found.identified.begin(), found.identified.begin() + kOfMachine, true);
  return fmt::format(
      "{} of {} unknowns are in the readings; {} of the machine's {} each by itself\n"
      "residual rms    qpd {:.2f}, {:.2f} mV, ccd {:.4f} px; {} degrees of freedom\n"
      "{} directions are left open (separation.json, not_separable); the volumetric error does not need them\n{}",
      found.rank, found.unknowns.size(), of_machine, kOfMachine, found.residual_rms[0] / units::mV,
      found.residual_rms[1] / units::mV, found.residual_rms[2], found.dof, found.not_separable.size(),
      found.converged ? "" : "the fit has not settled\n");
}

/// The machine of a truth, as unknowns.
Eigen::VectorXd TruthOf(const nlohmann::json& truth, const Identification& found) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(found.unknowns.size());
  const nlohmann::json& machine = truth.at("machine");
  for (int axis = 0; axis < kMachineAxes; ++axis) {
    for (int error = 0; error < kBodyErrors; ++error) {
      const std::string name = std::string(kAxisNames[static_cast<std::size_t>(axis)]) + "." +
                               kBodyErrorNames[static_cast<std::size_t>(error)];
      for (int term = 0; term < kCubicTerms; ++term)
        x[CubicAt(axis, error, term)] =
            machine.at("errors").at(name).at("coefficients").at(static_cast<std::size_t>(term)).get<double>();
    }
  }
  for (int k = 0; k < kSquarenesses; ++k)
    x[SquarenessAt(k)] =
        machine.at("squareness_arcsec").at(kSquarenessNames[static_cast<std::size_t>(k)]).get<double>();
  return x;
}

/// Poses that the run had not, anywhere where it had been.
std::vector<PoseRead> UnseenPoses(const std::vector<PoseRead>& seen, const FreeformSettings& bench) {
  constexpr int kPoses = 200;
  Stream random(1, "score.unseen_poses");  // the same for every run
  std::vector<PoseRead> poses(kPoses);
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    const auto [low, high] = std::ranges::minmax(seen, {}, [axis](const PoseRead& p) { return p.at[axis]; });
    for (PoseRead& pose : poses) {
      pose.at[axis] = low.at[axis] + random.Uniform() * (high.at[axis] - low.at[axis]);
      pose.t[axis] = (pose.at[axis] - bench.machine.centre[axis]) / bench.machine.half[axis];
    }
  }
  return poses;
}

/// Tip in the X slide's frame, um: 3 x poses.
Eigen::Matrix3Xd Tips_um(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                         const Eigen::VectorXd& x) {
  Eigen::Matrix3Xd tips(3, std::ssize(poses));
  for (std::size_t p = 0; p < poses.size(); ++p)
    tips.col(static_cast<Eigen::Index>(p)) = Tip_m(bench, poses[p], InputsAt(poses[p], x)) / units::um;
  return tips;
}

/// Deviation over u of the unknowns that the readings decide, rms.
double PullsOf(const Identification& found, const Eigen::VectorXd& truth) {
  double sum = 0.0;
  int count = 0;
  for (int k = 0; k < kOfMachine; ++k) {
    if (!found.identified[static_cast<std::size_t>(k)]) continue;
    sum += std::pow((found.unknowns[k] - truth[k]) / found.u[k], 2);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kNaN;
}

}  // namespace

report::Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator) {
  const Identification found = Identified(scenario, readings, estimator);
  const nlohmann::json separation = SeparationJson(found);
  const nlohmann::json results = {{"rank", separation.at("rank")},
                                  {"unknowns", separation.at("unknowns")},
                                  {"residual_rms", separation.at("residual_rms")},
                                  {"dof", separation.at("dof")},
                                  {"converged", found.converged}};
  return {results, separation, "", SummaryOf(found)};
}

report::ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings,
                           const nlohmann::json& truth, Estimator estimator) {
  const FreeformSettings& bench = FreeformOf(scenario);
  const Identification found = Identified(scenario, readings, estimator);
  const Eigen::VectorXd true_x = TruthOf(truth, found);
  const std::vector<PoseRead> unseen = UnseenPoses(PosesOf(readings, bench), bench);
  const Eigen::Matrix3Xd nominal = Tips_um(bench, unseen, Eigen::VectorXd::Zero(true_x.size()));
  const Eigen::Matrix3Xd actual = Tips_um(bench, unseen, true_x);
  const auto norms = [&](const Eigen::Matrix3Xd& off) -> Eigen::RowVectorXd {
    return WithoutRigidMotion(nominal, off).colwise().norm();
  };
  const Eigen::RowVectorXd before = norms(actual - nominal);
  // Each estimator predicts by its own equations.
  const Eigen::Matrix3Xd predicted = estimator == Estimator::kPublished
                                         ? Eigen::Matrix3Xd(nominal + PublishedErrors_um(unseen, found.unknowns))
                                         : Tips_um(bench, unseen, found.unknowns);
  const Eigen::RowVectorXd after = norms(predicted - actual);
  const auto rms = [](const Eigen::RowVectorXd& v) { return v.norm() / std::sqrt(static_cast<double>(v.size())); };
  const double pulls = PullsOf(found, true_x);
  return {
      {{"volumetric_um", {{"machine_rms", rms(before)}, {"left_rms", rms(after)}, {"left_max", after.maxCoeff()}}},
       {"identified_pull_rms", report::In(1.0, pulls)},
       {"poses", unseen.size()}},
      fmt::format("volumetric error at {} poses that the run had not, best rigid motion taken out\n"
                  "of the machine         {:.3f} um rms\nleft by the estimate   {:.3f} um rms, {:.3f} um at most\n"
                  "what is identified by itself is off by {:.2f} of its uncertainty, rms\n",
                  unseen.size(), rms(before), rms(after), after.maxCoeff(), pulls),
      ""};
}

}  // namespace twinbench::benches::freeform
