#include "tests/diagnose/encoder_record.h"
#include "tests/support/night.h"
#include "twin/diagnose/part_of_readings.h"

// One machine read in several ways: what is wrong with it does not hang on how often, or where, it was read.
namespace twinbench::diagnose {
namespace {

using units::deg;

struct Sampling {
  std::string name;
  int readings;
  double turns = 1.0;   // of a pass
  double uneven = 0.0;  // of a step: readings lie so far beside their even places
};

/// Passes + - - + at 10 deg/s with white noise of 0.002 deg.
template <class Error>
encoder::lab::Record ReadAs(const Sampling& sampling, Error error_deg) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise_deg(0.0, 0.002);
  std::uniform_real_distribution<double> beside(-0.5, 0.5);
  constexpr double kSpeed_deg_s = 10.0;
  const int in_pass = sampling.readings / 4;
  const double length_deg = 360.0 * sampling.turns, step_deg = length_deg / in_pass;
  encoder::lab::Record record;
  int pass = 0;
  for (const int direction : {1, -1, -1, 1}) {
    for (int k = 0; k < in_pass; ++k) {
      const double way_deg = (k + 0.5 + sampling.uneven * beside(random)) * step_deg;
      const double time_s = (pass * (length_deg + 20.0) + way_deg) / kSpeed_deg_s;
      const double angle_deg = direction > 0 ? way_deg : length_deg - way_deg;
      const double off_deg = error_deg(angle_deg * deg, direction, time_s) + noise_deg(random);
      record.Add(time_s, angle_deg, angle_deg + off_deg, direction, pass);
      record.readings.back().position = k;
      record.readings.back().velocity_rad_s = direction * kSpeed_deg_s * deg;
    }
    ++pass;
  }
  return record;
}

/// Effects that are named, alone or in a tie.
template <class Error>
std::set<std::string> NamedIn(const Sampling& sampling, Error error_deg) {
  const encoder::lab::Record record = ReadAs(sampling, error_deg);
  const Diagnosis d = Diagnosed(record, record.Believed()).diagnosis;
  EXPECT_NE(d.verdict, Verdict::kUnknown) << sampling.name << ": " << d.unknown.signature;
  std::set<std::string> named;
  for (const Cause& cause : d.causes) named.insert(cause.effect);
  return named;
}

std::vector<Sampling> Samplings() {
  std::vector<Sampling> all = {
      {"a few", 360}, {"many", 1000}, {"uneven", 1000, 1.0, 0.9}, {"several turns", 1000, 3.3, 0.9}};
  if (test::IsNight()) all.insert(all.end(), {{"more", 2000}, {"very many", 10000}});
  return all;
}

TEST(DiagnoseSampling, NothingIsNamedInNoiseHoweverItIsSampled) {
  for (const Sampling& sampling : Samplings())
    EXPECT_TRUE(NamedIn(sampling, [](double, int, double) { return 0.0; }).empty()) << sampling.name;
}

TEST(DiagnoseSampling, ASmallCauseIsNamedHoweverItIsSampled) {
  const auto error_deg = [](double angle_rad, int, double) { return 0.005 * std::cos(7.0 * angle_rad + 0.4); };
  for (const Sampling& sampling : Samplings())
    EXPECT_EQ(NamedIn(sampling, error_deg), std::set<std::string>{"periodic"}) << sampling.name;
}

/// Sine and cosine off centre and cut off, as the device's angle.
double CutOff_deg(double angle_rad) {
  const double sine = std::clamp(std::sin(angle_rad) + 0.03, -0.8, 0.8);
  const double cosine = std::clamp(std::cos(angle_rad) + 0.01, -0.8, 0.8);
  return std::remainder(std::atan2(sine, cosine) - angle_rad, units::turn) / deg;
}

TEST(DiagnoseSampling, FaultsThatAreOneToFirstOrderAreTold) {
  // An offset is an eccentricity but for what it does to the places where signals are cut off.
  const auto error_deg = [](double angle_rad, int, double) {
    return CutOff_deg(angle_rad) + 0.1 * std::cos(7.0 * angle_rad + 0.4);
  };
  EXPECT_EQ(NamedIn({"many", 2000}, error_deg),
            (std::set<std::string>{"periodic", "signal_clipping", "signal_offset"}));
}

TEST(DiagnoseSampling, APartOfTheReadingsHasNeighboursAndTurningPoints) {
  const auto none = [](double, int, double) { return 0.0; };
  const std::vector<Reading> few = ReadAs({"few", 4000}, none).readings,
                             many = ReadAs({"many", 20000}, none).readings;
  EXPECT_EQ(PartOf(few).size(), few.size());
  const std::vector<Reading> part = PartOf(many);
  EXPECT_NEAR(static_cast<double>(part.size()), 4000.0, 4 * 16.0);  // a group more or less in each pass
  std::size_t neighbours = 0, turns = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (i == 0 || part[i].pass != part[i - 1].pass) {
      EXPECT_EQ(part[i].position, 0);
      ++turns;
    } else {
      neighbours += part[i].reading == part[i - 1].reading + 1;
    }
  }
  EXPECT_EQ(turns, 4U);
  EXPECT_GT(static_cast<double>(neighbours), 0.9 * static_cast<double>(part.size()));
}

TEST(DiagnoseSampling, LargeCausesAreNamedHoweverTheyAreSampled) {
  const auto error_deg = [](double angle_rad, int direction, double time_s) {
    return 0.3 * std::cos(7.0 * angle_rad + 0.4) + 0.1 * std::cos(2.0 * angle_rad) + 5e-4 * time_s -
           0.05 * direction;
  };
  for (const Sampling& sampling : Samplings()) {
    const std::set<std::string> named = NamedIn(sampling, error_deg);
    EXPECT_TRUE(named.contains("periodic") && named.contains("drift")) << sampling.name;
  }
}

}  // namespace
}  // namespace twinbench::diagnose
