#pragma once

#include <cmath>

#include "twin/benches/turntable_autocollimator/estimators/indexing.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

/// A turntable, a 360-tooth table and a rolled autocollimator written down in a few lines, independent of the
/// program.
namespace twinbench::separate::turntable {

using units::arcsec, units::deg;

/// Sum of a_k sin(k theta + alpha_k), k = 1, 2, ...
struct TrueCurve {
  std::vector<double> amplitude_rad, phase_rad;

  double At(double angle_rad) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < amplitude_rad.size(); ++k)
      sum += amplitude_rad[k] * std::sin(static_cast<double>(k + 1) * angle_rad + phase_rad[k]);
    return sum;
  }
};

/// Orders 1 to `orders`, about as 1 / order, scaled to a range over the circle (0.1 deg grid).
inline TrueCurve OrderRichCurve(int orders, double range_rad, Stream& stream) {
  TrueCurve curve;
  for (int k = 1; k <= orders; ++k) {
    curve.amplitude_rad.push_back((0.5 + stream.Uniform()) / k);
    curve.phase_rad.push_back(2.0 * units::kPi * stream.Uniform());
  }
  double least = 0.0, most = 0.0;
  for (int i = 0; i < 3600; ++i) {
    least = std::min(least, curve.At(i * 0.1 * deg));
    most = std::max(most, curve.At(i * 0.1 * deg));
  }
  for (double& a : curve.amplitude_rad) a *= range_rad / (most - least);
  return curve;
}

/// How the multi-tooth table sits on the turntable.
struct Seat {
  double shift_deg = 0.0;
  double tilt_rad = 0.0;
  double azimuth_rad = 0.0;  // of the tilt, against the turntable's zero
};

struct TrueBench {
  TrueCurve turntable;
  std::vector<double> tooth_rad = std::vector<double>(360, 0.0);
  double gamma_rad = 0.0;
  double u_x_rad = 0.0, u_y_rad = 0.0;

  double Tooth(double angle_deg) const {
    return tooth_rad[static_cast<std::size_t>((std::lround(angle_deg) % 360 + 360) % 360)];
  }
  /// What a perfect autocollimator without roll would show.
  double Index(double turntable_deg, double shift_deg) const {
    return turntable.At(turntable_deg * deg) + Tooth(shift_deg - turntable_deg);
  }
};

/// One stop. Constants of the set-up: 7 and -4 arcsec times its number.
inline TurntableStop ReadStop(const TrueBench& bench, const Seat& seat, int setup, double turntable_deg,
                              Stream& noise) {
  const double x = bench.Index(turntable_deg, seat.shift_deg) + 7.0 * arcsec * setup;
  const double y = seat.tilt_rad * std::cos(turntable_deg * deg - seat.azimuth_rad) - 4.0 * arcsec * setup;
  const double c = std::cos(bench.gamma_rad), s = std::sin(bench.gamma_rad);
  TurntableStop stop{.setup = setup, .turntable_rad = turntable_deg * deg,
                     .multitooth_rad = (seat.shift_deg - turntable_deg) * deg};
  stop.x_rad = c * x + s * y + bench.u_x_rad * noise.Normal();  // the crosshair's axes, turned by gamma
  stop.y_rad = c * y - s * x + bench.u_y_rad * noise.Normal();
  return stop;
}

/// Full circles of n positions, one set-up a seat.
inline std::vector<TurntableStop> ReadCircles(const TrueBench& bench, const std::vector<Seat>& seats, int n,
                                              Stream& noise, int passes = 1) {
  std::vector<TurntableStop> stops;
  for (std::size_t s = 0; s < seats.size(); ++s) {
    for (int pass = 0; pass < passes; ++pass) {
      for (int i = 0; i < n; ++i) {
        stops.push_back(ReadStop(bench, seats[s], static_cast<int>(s), i * 360.0 / n, noise));
        stops.back().pass = pass;
      }
    }
  }
  return stops;
}

/// The published instruments: 17.82 arcsec, teeth of 0.3 arcsec, roll 0.6 deg.
inline TrueBench PublishedBench(double u_rad, Stream& truth) {
  TrueBench bench{.turntable = OrderRichCurve(12, 17.82 * arcsec, truth), .gamma_rad = 0.6 * deg};
  for (double& t : bench.tooth_rad) t = 0.3 * arcsec * truth.Normal();
  bench.u_x_rad = bench.u_y_rad = u_rad;
  return bench;
}

/// Two tilts of 60 and 100 arcsec, the same teeth.
inline std::vector<Seat> TwoTilts() { return {{0.0, 60.0 * arcsec, 0.4}, {0.0, 100.0 * arcsec, 2.1}}; }

/// Circles read with the published instruments.
struct PublishedCircles {
  TrueBench bench;
  std::vector<TurntableStop> stops;
};
inline PublishedCircles ReadPublished(std::uint64_t seed, double u_rad, const std::vector<Seat>& seats = TwoTilts(),
                                      int n = 72, int passes = 1) {
  Stream stream(seed, "test.turntable");
  const TrueBench bench = PublishedBench(u_rad, stream);
  return {bench, ReadCircles(bench, seats, n, stream, passes)};
}

/// Circles without any error, noise or roll.
inline std::vector<TurntableStop> ReadIdeal(const std::vector<Seat>& seats, int n) {
  Stream none(1, "test.turntable");
  return ReadCircles({}, seats, n, none);
}

inline AutocollimatorNoise Stated(double u_rad) { return {u_rad, u_rad, 0}; }

}  // namespace twinbench::separate::turntable
