#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "twin/benches/freeform_five_axis/bench.h"
#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/displacement_results.h"
#include "twin/benches/freeform_five_axis/evaluated.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/freeform_five_axis/tables.h"

namespace twinbench::benches::freeform {
namespace {

using namespace estimators;

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

/// A fit by least squares takes a single wrong value for as good as the others.
std::string LoneWords(const std::optional<LoneValue>& lone) {
  if (!lone) return "";
  const std::array columns = {kQpdX_V.column, kQpdY_V.column, kCcd_px.column};
  return fmt::format("doubtful: {} of reading {} lies {:.3g} times the scatter of the others from the fit\n",
                     columns[static_cast<std::size_t>(lone->channel)], lone->reading, lone->times);
}

std::string SummaryOf(const Identification& found) {
  const auto of_machine = std::count(found.identified.begin(), found.identified.begin() + kOfMachine, true);
  return fmt::format(
      "{} of {} unknowns are in the readings; {} of the machine's {} each by itself\n"
      "residual rms    qpd {:.2f}, {:.2f} mV, ccd {:.4f} px; {} degrees of freedom\n"
      "{} directions are not observable (null space; separation.json, not_separable); the volumetric error does not need them\n{}{}",
      found.rank, found.unknowns.size(), of_machine, kOfMachine, found.residual_rms[0] / units::mV,
      found.residual_rms[1] / units::mV, found.residual_rms[2], found.dof, found.not_separable.size(),
      found.converged ? "" : "the fit has not settled\n", LoneWords(found.lone));
}

/// What the machine errs where it has not been measured, and how well that is known.
struct Unseen {
  std::vector<PoseRead> poses;
  VolumetricErrors errors;
  std::optional<MapBias> bias;  // published
};

Unseen UnseenOf(const FreeformSettings& bench, const std::vector<PoseRead>& seen, const Identification& found,
                Estimator estimator) {
  constexpr int kPoses = 200;
  const std::vector<PoseRead> poses = UnseenPoses(seen, bench, kPoses);
  if (estimator != Estimator::kPublished) return {poses, PredictErrors(bench, poses, found, estimator), {}};
  const PublishedMap map = PredictPublished(bench, poses, found, Identify(bench, seen));
  return {poses, map.errors, map.bias};
}

nlohmann::json VolumetricJson(const Unseen& unseen) {
  const VolumetricErrors& v = unseen.errors;
  return {{"poses", unseen.poses.size()},
          {"machine_rms", RmsLength(v.error_um)},
          {"machine_max", v.error_um.colwise().norm().maxCoeff()},
          {"u_compensated_rms", RmsLength(v.u_um)},
          {"u_compensated_max", v.u_um.colwise().norm().maxCoeff()}};
}

constexpr std::size_t kMapPoses = 100;
constexpr std::array kMapKeys = {"dx_um", "dy_um", "dz_um"};

/// Noise of quadrants and camera; of a published map what it is off by as well, for each of the first poses.
nlohmann::json MapParts(const Unseen& unseen) {
  if (!unseen.bias) return {{"noise", 1.0}};
  nlohmann::json parts;
  for (Eigen::Index c = 0; c < 3; ++c) {
    nlohmann::json& of = parts[kMapKeys[static_cast<std::size_t>(c)]];
    for (std::size_t p = 0; p < std::min(kMapPoses, unseen.poses.size()); ++p) {
      const double of_bias =
          std::pow(unseen.bias->rms_um[c] / unseen.errors.u_um(c, static_cast<Eigen::Index>(p)), 2);
      of["model"].push_back(of_bias);
      of["noise"].push_back(1.0 - of_bias);
    }
  }
  return parts;
}

/// The error of the tip at the first of the unseen poses, one by one, with its uncertainty.
nlohmann::json MapJson(const Unseen& unseen) {
  nlohmann::json map = {{"u_parts", MapParts(unseen)}};
  for (std::size_t p = 0; p < std::min(kMapPoses, unseen.poses.size()); ++p) {
    const auto& at = unseen.poses[p].at;
    const auto k = static_cast<Eigen::Index>(p);
    map["x_mm"].push_back(at[0] / units::mm);
    map["y_mm"].push_back(at[1] / units::mm);
    map["z_mm"].push_back(at[2] / units::mm);
    map["a_deg"].push_back(at[3] / units::deg);
    map["b_deg"].push_back(at[4] / units::deg);
    for (Eigen::Index c = 0; c < 3; ++c) {
      const std::string key = kMapKeys[static_cast<std::size_t>(c)];
      map[key].push_back(unseen.errors.error_um(c, k));
      map["u_" + key].push_back(unseen.errors.u_um(c, k));
    }
  }
  return map;
}

/// The same poses' components together.
uncertainty::Joint MapJoint(const Unseen& unseen) {
  const std::size_t poses = std::min(kMapPoses, unseen.poses.size());
  const Eigen::MatrixXd root = unseen.errors.root_um.topRows(3 * static_cast<Eigen::Index>(poses));
  uncertainty::Joint joint{"error_map", {}, root * root.transpose()};
  for (std::size_t p = 0; p < poses; ++p) {
    for (const char* key : kMapKeys) joint.names.push_back(fmt::format("error_map.{}[{}]", key, p));
  }
  return joint;
}

nlohmann::json BiasJson(const MapBias& bias) {
  nlohmann::json json;
  for (Eigen::Index c = 0; c < 3; ++c)
    json[kMapKeys[static_cast<std::size_t>(c)]] = {{"rms", bias.rms_um[c]},
                                                   {"u_noise", bias.u_noise_um[c]},
                                                   {"status", bias.IsBiased(c) ? "biased" : "within_noise"}};
  return json;
}

std::string BiasText(const MapBias& bias) {
  std::string text;
  for (Eigen::Index c = 0; c < 3; ++c) {
    if (bias.IsBiased(c))
      text += fmt::format(
          "published {} of the map: BIASED, {:.3g} rms from weighted least squares (exact model), where noise makes {:.2g}; "
          "included in its uncertainty\n",
          kMapKeys[static_cast<std::size_t>(c)], bias.rms_um[c], bias.u_noise_um[c]);
  }
  return text + "published coefficients and squareness: INVALID one by one, their errors go into each other\n";
}

/// Those that the readings decide by themselves.
nlohmann::json IdentifiedSquareness(const Identification& found) {
  nlohmann::json all = {{"u_parts", {{"noise", 1.0}}}};
  for (int k = 0; k < kSquarenesses; ++k) {
    const int unknown = SquarenessAt(k);
    if (!found.identified[static_cast<std::size_t>(unknown)]) continue;
    const std::string key = kSquarenessNames[static_cast<std::size_t>(k)] + std::string("_arcsec");
    all[key] = found.unknowns[unknown];
    all["u_" + key] = found.u[unknown];
  }
  return all;
}

/// The same on regular grids.
struct Mapped {
  std::vector<Grid> grids;
  std::vector<PoseRead> poses;  // of all of them
  VolumetricErrors errors;
};

Mapped MapOf(const FreeformSettings& bench, const std::vector<PoseRead>& seen, const Identification& found,
             Estimator estimator) {
  Mapped map{GridsOf(seen, bench, kGridNodes), {}, {}};
  map.poses = PosesOnGrids(map.grids);
  map.errors = PredictErrors(bench, map.poses, found, estimator);
  return map;
}

std::string MapWords(const Mapped& map) {
  std::string words =
      "on grids over X, Y and Z, before and after compensation (volumetric_grid.csv), um rms and at most:\n";
  Eigen::Index from = 0;
  for (const Grid& grid : map.grids) {
    const auto columns = Eigen::seqN(from, std::ssize(grid.poses));
    const Eigen::Matrix3Xd before = map.errors.error_um(Eigen::all, columns),
                           u = map.errors.u_um(Eigen::all, columns);
    words += fmt::format("  A {:5.2f} deg, B {:5.2f} deg   {:.2f}, {:.2f}   noise leaves {:.2f}, {:.2f}\n",
                         grid.a_rad / units::deg, grid.b_rad / units::deg, RmsLength(before),
                         before.colwise().norm().maxCoeff(), RmsLength(u), u.colwise().norm().maxCoeff());
    from += std::ssize(grid.poses);
  }
  return words;
}

std::string VolumetricWords(const Unseen& unseen) {
  return fmt::format(
      "at {} poses that were not measured the machine errs by {:.2f} um rms, rigid motion taken out;\n"
      "compensated with what was found, noise leaves {:.2f} um rms\n",
      unseen.poses.size(), RmsLength(unseen.errors.error_um), RmsLength(unseen.errors.u_um));
}

/// Of each channel.
std::vector<report::Misfit> MisfitsOf(const Identification& found) {
  if (found.dof <= 0) return {};
  return {{"qpd_x", found.residual_per_u[0]}, {"qpd_y", found.residual_per_u[1]}, {"ccd", found.residual_per_u[2]}};
}

}  // namespace

report::Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator) {
  const FreeformSettings& bench = FreeformOf(scenario);
  if (bench.ReadsDisplacements()) return EvaluateDisplacements(scenario, readings);
  const std::vector<PoseRead> seen = SeenPoses(scenario, readings);
  const Identification found = IdentifyBy(bench, seen, estimator);
  const Unseen unseen = UnseenOf(bench, seen, found, estimator);
  const Mapped map = MapOf(bench, seen, found, estimator);
  const nlohmann::json separation = SeparationJson(found);
  nlohmann::json results = {{"rank", separation.at("rank")},
                                  {"unknowns", separation.at("unknowns")},
                                  {"residual_rms", separation.at("residual_rms")},
                                  {"dof", separation.at("dof")},
                                  {"volumetric_um", VolumetricJson(unseen)},
                                  {"error_map", MapJson(unseen)},
                                  {"converged", found.converged}};
  if (unseen.bias)
    results["method_bias"] = BiasJson(*unseen.bias);
  else
    results["squareness"] = IdentifiedSquareness(found);
  const bool has_joint = !unseen.bias;
  const auto joints = [has_joint, unseen] {
    return has_joint ? std::vector<uncertainty::Joint>{MapJoint(unseen)} : std::vector<uncertainty::Joint>();
  };
  return {results,
          separation,
          "",
          SummaryOf(found) + VolumetricWords(unseen) + MapWords(map) + (unseen.bias ? BiasText(*unseen.bias) : ""),
          {{"volumetric.csv", VolumetricCsv(unseen.poses, unseen.errors)},
           {"volumetric_grid.csv", VolumetricCsv(map.poses, map.errors)},
           {"compensation.csv", CompensationCsv(bench, seen, found)}},
          joints,
          MisfitsOf(found),
          [bench, seen, found, estimator](const nlohmann::json& truth) { return ScoreOf(bench, seen, found, truth, estimator); }};
}

}  // namespace twinbench::benches::freeform
