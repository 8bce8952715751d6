#include "twin/benches/turntable_autocollimator/estimators/polygon_means.h"

#include <cmath>
#include <map>

#include "twin/core/errors.h"
#include "twin/separate/mean.h"

namespace twinbench::separate::turntable {
namespace {

/// Takes the means of a label's values out of all values.
/// @return the means.
template <class Label>
std::map<int, double> TakeOutMeans(const std::vector<FaceReading>& readings, Label label,
                                   Eigen::VectorXd& value_rad) {
  std::map<int, Mean> running;
  for (std::size_t i = 0; i < readings.size(); ++i)
    running[label(readings[i])].Add(value_rad[static_cast<Eigen::Index>(i)]);
  std::map<int, double> means;
  for (const auto& [name, mean] : running) means[name] = mean.Value();
  for (std::size_t i = 0; i < readings.size(); ++i)
    value_rad[static_cast<Eigen::Index>(i)] -= means.at(label(readings[i]));
  return means;
}

/// Each order by itself: 2 / N times the sum of the values times its waves.
HarmonicModel SummedWaves(const std::vector<FaceReading>& readings, const Eigen::VectorXd& value_rad,
                          int highest_order) {
  HarmonicModel curve;
  curve.highest_order = highest_order;
  curve.coefficients_rad = Eigen::VectorXd::Zero(2 * highest_order + 1);
  for (std::size_t i = 0; i < readings.size(); ++i)
    curve.coefficients_rad += HarmonicBasis(readings[i].angle_rad, highest_order).transpose() *
                              value_rad[static_cast<Eigen::Index>(i)] * 2.0 / static_cast<double>(readings.size());
  curve.coefficients_rad[0] = 0.0;
  return curve;
}

Eigen::VectorXd RestOf(const std::vector<FaceReading>& readings, const HarmonicModel& curve,
                       Eigen::VectorXd value_rad) {
  for (std::size_t i = 0; i < readings.size(); ++i)
    value_rad[static_cast<Eigen::Index>(i)] -=
        HarmonicBasis(readings[i].angle_rad, curve.highest_order).dot(curve.coefficients_rad);
  return value_rad;
}

/// As if all waves were orthogonal.
void StateUncertainties(double u_reading_rad, Eigen::Index readings, HarmonicModel& curve) {
  const double variance_rad2 = 2.0 * u_reading_rad * u_reading_rad / static_cast<double>(readings);
  curve.cov_rad2 =
      variance_rad2 * Eigen::MatrixXd::Identity(curve.coefficients_rad.size(), curve.coefficients_rad.size());
  curve.cov_rad2(0, 0) = 0.0;
  for (int k = 1; k <= curve.highest_order; ++k)
    curve.terms.push_back(
        TermOf(k, curve.coefficients_rad.segment<2>(2 * k - 1), curve.cov_rad2.block<2, 2>(2 * k - 1, 2 * k - 1)));
}

/// Means over c clampings of n faces: s^2 (1 - 1 / n) / readings of a face.
FaceSeries MeansOfFaces(const std::map<int, double>& means, double u_reading_rad, std::size_t readings, int faces) {
  std::vector<int> names;
  Eigen::VectorXd value_rad(std::ssize(means));
  for (const auto& [face, mean_rad] : means) {
    value_rad[static_cast<Eigen::Index>(names.size())] = mean_rad;
    names.push_back(face);
  }
  const auto n = static_cast<double>(means.size());
  value_rad.array() -= value_rad.mean();
  const Eigen::MatrixXd centring = Eigen::MatrixXd::Identity(value_rad.size(), value_rad.size()).array() - 1.0 / n;
  return ByOwnAngle(names, value_rad, u_reading_rad * u_reading_rad * n / static_cast<double>(readings) * centring,
                    faces);
}

}  // namespace

PolygonClosure ClosePolygonByMeans(const std::vector<FaceReading>& readings, int faces, int highest_order) {
  if (readings.empty()) throw InputError("readings", "no face was read", "a full circle of a polygon");
  Eigen::VectorXd value_rad(std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i) value_rad[static_cast<Eigen::Index>(i)] = readings[i].value_rad;
  const auto constants = TakeOutMeans(
      readings, [](const FaceReading& r) { return r.clamping; }, value_rad);
  const auto of_faces = TakeOutMeans(
      readings, [](const FaceReading& r) { return r.face; }, value_rad);
  PolygonClosure result;
  result.encoder = SummedWaves(readings, value_rad, highest_order);
  result.residual_rad = RestOf(readings, result.encoder, value_rad);
  result.dof = static_cast<double>(readings.size()) - static_cast<double>(constants.size() + of_faces.size()) +
               1.0 - 2.0 * highest_order;
  result.noise = JudgedNoise(NoiseOfNulledFaces(readings), result.residual_rad.squaredNorm(), result.dof);
  const double u_rad = result.noise.scale * result.noise.u_rad;
  result.residual_rms_rad = std::sqrt(result.residual_rad.squaredNorm() / static_cast<double>(readings.size()));
  result.encoder.residual_rms_rad = result.residual_rms_rad;
  StateUncertainties(u_rad, std::ssize(readings), result.encoder);
  result.turntable = CurveAt(result.encoder, DistinctAngles(readings));
  const FaceSeries polygon = MeansOfFaces(of_faces, u_rad, readings.size(), faces);
  result.polygon = polygon.errors;
  result.face = polygon.face;
  return result;
}

double ClosureBias_rad(const AngleSeries& estimate, const AngleSeries& rigorous) {
  return std::sqrt((estimate.value_rad - rigorous.value_rad).squaredNorm() /
                   static_cast<double>(estimate.value_rad.size()));
}

}  // namespace twinbench::separate::turntable
