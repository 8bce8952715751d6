#pragma once

#include <gtest/gtest.h>

#include "tests/support/noise.h"
#include "twin/core/reading.h"

namespace twinbench {

/// A reading that follows from its number, so that the one that comes back can be checked.
inline Reading AnyReading(int number) {
  test::Noise normal(1.0, static_cast<std::uint64_t>(number));
  Reading r;
  r.reading = number;
  r.time = Time(Duration(1'000'000'000'000'000'001LL + number));  // 31 years: a double of seconds would lose these
  r.setup = number % 4;
  r.pass = number % 3;
  r.direction = number % 2 ? 1 : -1;
  r.position = number % 36;
  r.phase = static_cast<Phase>(number % kPhases);
  r.n_samples = number % 5 ? 100 : 0;
  for (double* value : {&r.target_rad, &r.reference_rad, &r.dwell_s, &r.temperature_degC, &r.autocollimator_yaw_rad,
                        &r.autocollimator_tilt_rad, &r.measured_rad, &r.velocity_rad_s})
    *value = normal();
  for (double& mean_V : r.mean_V) mean_V = normal();
  for (double& std_V : r.std_V) std_V = std::abs(normal());
  return r;
}

/// In every bit; what is not known must be so in both.
inline void ExpectSame(const Reading& a, const Reading& b) {
  const auto places = [](const Reading& r) {
    return std::tie(r.reading, r.setup, r.pass, r.direction, r.position, r.phase, r.status, r.n_samples, r.extra, r.quantities);
  };
  const auto numbers = [](const Reading& r) {
    std::vector<double> all = {
        r.target_rad, r.reference_rad, r.dwell_s, r.temperature_degC, r.autocollimator_yaw_rad,
        r.autocollimator_tilt_rad, r.measured_rad, r.velocity_rad_s, r.head_rad, r.interferometer_rad};
    all.insert(all.end(), r.mean_V.begin(), r.mean_V.end());
    all.insert(all.end(), r.std_V.begin(), r.std_V.end());
    return all;
  };
  EXPECT_EQ(places(a), places(b));
  EXPECT_EQ(a.time, b.time);
  for (std::size_t i = 0; i < numbers(a).size(); ++i) {
    const double x = numbers(a)[i], y = numbers(b)[i];
    EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << "reading " << a.reading << ": " << x << " and " << y;
  }
}

}  // namespace twinbench
