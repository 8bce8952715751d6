#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/polygon_series.h"

/// Encoder and polygon apart by circle closure.
namespace twinbench::separate::turntable {

/// Why an order of the encoder's error is not told.
enum class OrderHidden {
  kByConstants,    // it is the same at all faces of a clamping
  kByPolygon,      // it is the same in all clampings at each face
  kByLowerOrders,  // the angles that were read do not tell it from lower orders
};

struct HiddenOrder {
  int order = 0;
  OrderHidden by = OrderHidden::kByConstants;
};

/// Standard uncertainty of one reading.
struct ReadingNoise {
  double u_rad = kNaN;
  double dof = 0.0;
  bool is_of_repeats = false;  // else of the residuals
  double scale = 1.0;          // the residuals' on the repeats' (Birge), where they exceed it beyond chance
};

struct PolygonClosure {
  HarmonicModel encoder;            // error of the turntable; orders that are not told are zero
  std::vector<HiddenOrder> hidden;  // up to the highest order asked for
  AngleSeries turntable;  // that curve at every angle at which a face was nulled; empty if no order is told
  AngleSeries polygon;    // errors of the faces, by their own angle on the polygon; zero mean
  std::vector<int> face;  // their numbers
  ReadingNoise noise;
  Eigen::VectorXd residual_rad;  // one a reading
  double residual_rms_rad = kNaN;
  double dof = kNaN;  // of the residuals
  std::vector<std::string> notes;
};

/// Least squares of value = E(angle) + P(face) + g(clamping), E a sum of orders 1 to `highest_order`, the mean of P
/// zero, all readings of equal weight.
///
/// An order whose waves the constants, the faces and the lower orders can make is left out and named: multiples of
/// the number of faces whatever the clampings are, multiples of c where c clampings stand evenly round the circle.
/// What there is of it enters what it looks like.
///
/// @param faces  Of the polygon, read or not.
/// @throws InputError if there is no reading, or clampings that have no face in common.
///
/// Uncertainty: scatter of repeats (same clamping, face, direction), or of the residuals where these exceed it
/// (p < 0.001) or nothing was read twice; 2 M / N of its square for M orders of N readings spread evenly. Not
/// included: what is the same in every clamping as the encoder's error is, such as the roll of the crosshair times
/// a tilt of the polygon and the flatness of its faces times its eccentricity. Orders above the highest that stand out of
/// the residuals are in the curve's (FindOrdersAbove), not in those of the orders. Reference:
/// docs/theory.md 5.4; Kinnane et al., Metrologia 52 (2015) 244 (the procedure); Estler, J. Res. NIST 103 (1998)
/// 141 (dual closure).
PolygonClosure ClosePolygon(const std::vector<FaceReading>& readings, int faces, int highest_order);

/// Scatter of readings of the same clamping, face and direction.
ReadingNoise NoiseOfNulledFaces(const std::vector<FaceReading>& readings);

/// Repeats tell the noise unless the residuals exceed it beyond chance (p < 0.001); without repeats these are all
/// there is.
ReadingNoise JudgedNoise(ReadingNoise of_repeats, double squares_rad2, double dof);

}  // namespace twinbench::separate::turntable
