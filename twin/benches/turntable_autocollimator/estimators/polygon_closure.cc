#include "twin/benches/turntable_autocollimator/estimators/polygon_closure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "twin/benches/turntable_autocollimator/estimators/orders_above.h"
#include "twin/core/distributions.h"
#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate::turntable {
namespace {

constexpr double kUnlikelyScatter = 0.001;

/// Distinct labels in ascending order, by running numbers.
class Numbered {
 public:
  template <class Label>
  Numbered(const std::vector<FaceReading>& readings, Label label) {
    for (const FaceReading& r : readings) number_.try_emplace(label(r), 0);
    int next = 0;
    for (auto& [name, number] : number_) number = next++;
  }
  int operator[](int name) const { return number_.at(name); }
  int Count() const { return static_cast<int>(number_.size()); }
  std::vector<int> Names() const {
    std::vector<int> names;
    for (const auto& [name, number] : number_) names.push_back(name);
    return names;
  }

 private:
  std::map<int, int> number_;
};

/// The columns of the least squares and what is told of them.
class ClosureDesign {
 public:
  ClosureDesign(const std::vector<FaceReading>& readings, int highest_order)
      : readings_(readings),
        clampings_(readings, [](const FaceReading& r) { return r.clamping; }),
        faces_(readings, [](const FaceReading& r) { return r.face; }),
        closing_(NullSpaceOf(Eigen::MatrixXd::Ones(1, faces_.Count()), 0.5)) {
    const Eigen::MatrixXd constants = Constants();
    columns_.resize(constants.rows(), constants.cols() + closing_.cols());
    columns_ << constants, FacesOfReadings() * closing_;
    of_constants_ = OrthonormalBasisOf(constants, kSingular);
    of_polygon_ = OrthonormalBasisOf(columns_, kSingular);
    if (of_polygon_.cols() < columns_.cols())
      throw InputError("readings", "clampings of the polygon have no face in common", "whole circles of faces");
    told_ = of_polygon_;
    for (int order = 1; order <= highest_order; ++order) Take(order);
  }

  const Eigen::MatrixXd& columns() const { return columns_; }
  const Eigen::MatrixXd& told() const { return told_; }
  const std::vector<int>& orders() const { return orders_; }
  const std::vector<HiddenOrder>& hidden() const { return hidden_; }
  const Numbered& faces() const { return faces_; }
  Eigen::Index FirstOfPolygon() const { return clampings_.Count(); }
  Eigen::Index FirstOfOrders() const { return clampings_.Count() + closing_.cols(); }
  /// Errors of the faces from their unknowns: columns that sum to zero.
  const Eigen::MatrixXd& closing() const { return closing_; }

 private:
  static constexpr double kSingular = 1e-9;

  Eigen::Index Count() const { return std::ssize(readings_); }

  Eigen::MatrixXd Constants() const {
    Eigen::MatrixXd constants = Eigen::MatrixXd::Zero(Count(), clampings_.Count());
    for (Eigen::Index i = 0; i < Count(); ++i) constants(i, clampings_[Of(i).clamping]) = 1.0;
    return constants;
  }

  Eigen::MatrixXd FacesOfReadings() const {
    Eigen::MatrixXd faces = Eigen::MatrixXd::Zero(Count(), faces_.Count());
    for (Eigen::Index i = 0; i < Count(); ++i) faces(i, faces_[Of(i).face]) = 1.0;
    return faces;
  }

  const FaceReading& Of(Eigen::Index i) const { return readings_[static_cast<std::size_t>(i)]; }

  /// What a basis leaves of the two waves, as squares: of the phase that it makes best, and of the one across.
  static Eigen::Vector2d Left(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& waves) {
    const Eigen::MatrixXd rest = waves - basis * (basis.transpose() * waves);
    return EigenvaluesOfSymmetric(rest.transpose() * rest);
  }

  /// Less than a thousandth of a wave.
  bool IsNothing(double squares) const { return squares < 1e-6 * static_cast<double>(Count()); }

  /// Of waves of which some phase is not told: who makes both, or else one that is seen at all.
  OrderHidden HiderOf(const Eigen::MatrixXd& waves) const {
    const Eigen::Vector2d by_constants = Left(of_constants_, waves), by_polygon = Left(of_polygon_, waves);
    for (const int phase : {1, 0}) {
      if (IsNothing(by_constants[phase])) return OrderHidden::kByConstants;
      if (IsNothing(by_polygon[phase])) return OrderHidden::kByPolygon;
      if (IsNothing(EigenvaluesOfSymmetric(waves.transpose() * waves)[0])) break;
    }
    return OrderHidden::kByLowerOrders;
  }

  void Take(int order) {
    Eigen::MatrixXd waves(Count(), 2);
    for (Eigen::Index i = 0; i < Count(); ++i)
      waves.row(i) << std::cos(order * Of(i).angle_rad), std::sin(order * Of(i).angle_rad);
    if (IsNothing(Left(told_, waves)[0])) {
      hidden_.push_back({order, HiderOf(waves)});
      return;
    }
    orders_.push_back(order);
    columns_.conservativeResize(Eigen::NoChange, columns_.cols() + 2);
    columns_.rightCols(2) = waves;
    const Eigen::MatrixXd rest = waves - told_ * (told_.transpose() * waves);
    told_.conservativeResize(Eigen::NoChange, told_.cols() + 2);
    told_.rightCols(2) = OrthonormalBasisOf(rest, kSingular);
  }

  const std::vector<FaceReading>& readings_;
  Numbered clampings_, faces_;
  Eigen::MatrixXd closing_, columns_, of_constants_, of_polygon_, told_;
  std::vector<int> orders_;
  std::vector<HiddenOrder> hidden_;
};

HarmonicModel CurveOf(const ClosureDesign& design, const NormalSolution& solution, double variance_rad2,
                      int highest_order) {
  HarmonicModel curve;
  curve.highest_order = highest_order;
  curve.coefficients_rad = Eigen::VectorXd::Zero(2 * highest_order + 1);
  curve.cov_rad2 = Eigen::MatrixXd::Zero(2 * highest_order + 1, 2 * highest_order + 1);
  std::vector<Eigen::Index> from, to;
  for (std::size_t k = 0; k < design.orders().size(); ++k) {
    for (int part = 0; part < 2; ++part) {
      from.push_back(design.FirstOfOrders() + 2 * static_cast<Eigen::Index>(k) + part);
      to.push_back(2 * design.orders()[k] - 1 + part);
    }
  }
  curve.coefficients_rad(to) = solution.x(from);
  curve.cov_rad2(to, to) = variance_rad2 * solution.inverse(from, from);
  for (const int order : design.orders())
    curve.terms.push_back(TermOf(order, curve.coefficients_rad.segment<2>(2 * order - 1),
                                 curve.cov_rad2.block<2, 2>(2 * order - 1, 2 * order - 1)));
  return curve;
}

FaceSeries FacesOf(const ClosureDesign& design, const NormalSolution& solution, double variance_rad2, int faces) {
  const Eigen::MatrixXd& closing = design.closing();
  const Eigen::Index first = design.FirstOfPolygon(), count = closing.cols();
  return ByOwnAngle(
      design.faces().Names(), closing * solution.x.segment(first, count),
      variance_rad2 * closing * solution.inverse.block(first, first, count, count) * closing.transpose(), faces);
}

std::string ListedOrders(const std::vector<HiddenOrder>& hidden, OrderHidden by) {
  std::vector<int> orders;
  for (const HiddenOrder& h : hidden) {
    if (h.by == by) orders.push_back(h.order);
  }
  return fmt::format("{}", fmt::join(orders, ", "));
}

/// They repeat in all readings of an angle, and no number of these makes them less.
void CountOrdersAbove(const ClosureDesign& design, const std::vector<FaceReading>& readings, PolygonClosure& result) {
  if (result.noise.is_of_repeats && !(result.noise.scale > 1.0)) return;
  Eigen::VectorXd angle_rad(std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i) angle_rad[static_cast<Eigen::Index>(i)] = readings[i].angle_rad;
  const int last = MostHarmonics(static_cast<int>(DistinctAngles(readings).size()));
  const OrdersAbove above =
      FindOrdersAbove(design.told(), angle_rad, result.residual_rad, result.encoder.highest_order + 1, last);
  if (above.orders.empty()) return;
  result.encoder.u_unmodelled_rad = std::sqrt(above.variance_rad2);
  result.notes.push_back(fmt::format(
      "orders {} of the turntable's angle stand out of the residuals: they are in the uncertainty of the encoder's curve and not "
      "in the curve; if they are the encoder's, turntable_procedure.highest_order takes them in",
      fmt::join(above.orders, ", ")));
}

void AddClosureNotes(PolygonClosure& result) {
  for (const auto& [by, words] :
       {std::pair{OrderHidden::kByConstants, "are the same at all faces of a mounting: not separable from its constant"},
        std::pair{OrderHidden::kByPolygon, "are not separable from the polygon with these offsets; missing from the encoder's curve"},
        std::pair{OrderHidden::kByLowerOrders, "look like lower orders at the angles that were read"}}) {
    const std::string orders = ListedOrders(result.hidden, by);
    if (!orders.empty()) result.notes.push_back(fmt::format("orders {} of the encoder {}", orders, words));
  }
  if (result.noise.scale > 1.0)
    result.notes.push_back(fmt::format(
        "the residuals are {:.2f} times what repeats explain (steps of the encoder, orders above the highest): "
        "uncertainties are scaled",
        result.noise.scale));
}

}  // namespace

ReadingNoise NoiseOfNulledFaces(const std::vector<FaceReading>& readings) {
  std::map<std::tuple<int, int, int>, std::vector<double>> repeats;
  for (const FaceReading& r : readings) repeats[{r.clamping, r.face, r.direction}].push_back(r.value_rad);
  double squares_rad2 = 0.0, dof = 0.0;
  for (const auto& [where, values] : repeats) {
    const Eigen::Map<const Eigen::ArrayXd> v(values.data(), std::ssize(values));
    squares_rad2 += (v - v.mean()).square().sum();
    dof += static_cast<double>(values.size()) - 1.0;
  }
  if (dof == 0.0) return {};
  return {std::sqrt(squares_rad2 / dof), dof, true, 1.0};
}

ReadingNoise JudgedNoise(ReadingNoise noise, double squares_rad2, double dof) {
  if (!(dof > kLeastDof)) return noise;
  if (!noise.is_of_repeats) return {std::sqrt(squares_rad2 / dof), dof, false, 1.0};
  // Repeats that steps of the encoder have made all alike say nothing of noise.
  if (noise.u_rad == 0.0) {
    const double of_means = std::max(1.0, dof - noise.dof);
    return {std::sqrt(squares_rad2 / of_means), of_means, false, 1.0};
  }
  const double chi2 = squares_rad2 / (noise.u_rad * noise.u_rad);
  if (ChiSquaredExceedance(chi2, dof) < kUnlikelyScatter) noise.scale = std::sqrt(chi2 / dof);
  // What all repeats of a face in a clamping have in common is thinned out by what they scatter; means are not.
  const double chi2_of_means = std::max(0.0, chi2 - noise.dof), dof_of_means = dof - noise.dof;
  if (dof_of_means > kLeastDof && ChiSquaredExceedance(chi2_of_means, dof_of_means) < kUnlikelyScatter)
    noise.scale = std::max(noise.scale, std::sqrt(chi2_of_means / dof_of_means));
  return noise;
}

PolygonClosure ClosePolygon(const std::vector<FaceReading>& readings, int faces, int highest_order) {
  if (readings.empty()) throw InputError("readings", "no face was read", "a full circle of a polygon");
  const ClosureDesign design(readings, highest_order);
  Eigen::VectorXd value_rad(std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i) value_rad[static_cast<Eigen::Index>(i)] = readings[i].value_rad;
  const Eigen::MatrixXd& a = design.columns();
  const NormalSolution solution = SolveNormal(a.transpose() * a, a.transpose() * value_rad);
  PolygonClosure result;
  result.hidden = design.hidden();
  result.residual_rad = value_rad - a * solution.x;
  result.residual_rms_rad = std::sqrt(result.residual_rad.squaredNorm() / static_cast<double>(readings.size()));
  result.dof = static_cast<double>(a.rows() - a.cols());
  result.noise = JudgedNoise(NoiseOfNulledFaces(readings), result.residual_rad.squaredNorm(), result.dof);
  const double variance_rad2 = std::pow(result.noise.scale * result.noise.u_rad, 2);
  result.encoder = CurveOf(design, solution, variance_rad2, highest_order);
  result.encoder.residual_rms_rad = result.residual_rms_rad;
  CountOrdersAbove(design, readings, result);
  if (!design.orders().empty()) result.turntable = CurveAt(result.encoder, DistinctAngles(readings));
  const FaceSeries polygon = FacesOf(design, solution, variance_rad2, faces);
  result.polygon = polygon.errors;
  result.face = polygon.face;
  AddClosureNotes(result);
  return result;
}

}  // namespace twinbench::separate::turntable
