#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/support/noise.h"
#include "tests/support/thresholds.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/core/units.h"
#include "twin/diagnose/extend.h"

/// Comparisons made by hand and asked about, for instruments by closed forms that share nothing with the twin.
namespace twinbench::diagnose::encoder::lab {

using twinbench::test::Noise, twinbench::test::Seeds;

/// A comparison in the making, all in deg and s.
struct Record {
  std::string kind = "sweep";  // what the scenario says of it
  std::vector<Reading> readings = {};

  void Add(double time_s, double reference_deg, double measured_deg, int direction, int pass) {
    Reading r{.reading = static_cast<int>(readings.size()), .time = Time(FromSeconds(time_s)), .pass = pass,
              .direction = direction};
    r.position = r.reading;
    r.reference_rad = reference_deg * units::deg;
    r.measured_rad = measured_deg * units::deg;
    readings.push_back(r);
  }
  Scenario Believed() const {
    Scenario scenario;
    scenario.bench = kEncoderBench;
    EncoderOf(scenario).encoder_procedure.kind = kind;
    return scenario;
  }
};

inline DiagnosisRun Diagnosed(const Record& record, const Scenario& believed) {
  DiagnoseOptions options;
  options.null_runs = 100;  // of what is far beyond any threshold
  options.cache_folder = twinbench::test::ThresholdsFolder();
  return Diagnose(record.readings, believed, options);
}

struct Answer {
  Record record;
  DiagnosisRun run = Diagnosed(record, record.Believed());
  mutable std::optional<Diagnosis> again = {};

  /// Of the same readings, with the file that was written.
  const Diagnosis& Again() const {
    if (!again) again = Diagnosed(record, Extend(record.Believed(), run, "test")).diagnosis;
    return *again;
  }
  const Cause* Find(const std::string& effect) const {
    const auto found = std::ranges::find(run.diagnosis.causes, effect, &Cause::effect);
    return found == run.diagnosis.causes.end() ? nullptr : &*found;
  }
  const ParameterEstimate* Find(const std::string& effect, const std::string& parameter) const {
    const Cause* const cause = Find(effect);
    if (!cause) return nullptr;
    const auto found = std::ranges::find(cause->parameters, parameter, &ParameterEstimate::name);
    return found == cause->parameters.end() ? nullptr : &*found;
  }
  /// In the unit of the catalogue.
  double Value(const std::string& effect, const std::string& parameter) const {
    const ParameterEstimate* const p = Find(effect, parameter);
    return p ? p->value / p->to_SI : kNaN;
  }
  double Uncertainty(const std::string& effect, const std::string& parameter) const {
    const ParameterEstimate* const p = Find(effect, parameter);
    return p ? p->u / p->to_SI : kNaN;
  }
  bool Names(const std::string& effect, double from = 0.8) const {
    const Cause* const cause = Find(effect);
    return cause && cause->probability >= from;
  }
  static std::string WordsOf(const Diagnosis& d) {
    std::string words = VerdictName(d.verdict);
    for (const Cause& c : d.causes) words += fmt::format(" [{} {:.2f}]", c.effect, c.probability);
    return words + " " + d.unknown.signature;
  }
  std::string Words() const { return WordsOf(run.diagnosis) + (again ? " | again: " + WordsOf(*again) : ""); }
};

inline Answer Ask(const Record& record) {
  return {record};
}

/// What must be found, and how sharply for it to be worth something.
struct Expected {
  const char *effect, *parameter;
  double value, sharp = 1e9;
};

/// Each is named, in its size; and the file that is written says it all.
inline void ExpectFound(const Answer& answer, const std::vector<Expected>& all) {
  SCOPED_TRACE(answer.Words());
  for (const Expected& e : all) {
    EXPECT_TRUE(answer.Names(e.effect)) << e.effect;
    const double u = answer.Uncertainty(e.effect, e.parameter);
    EXPECT_NEAR(answer.Value(e.effect, e.parameter), e.value, 4.0 * u) << e.effect;
    EXPECT_LT(u, e.sharp) << e.effect;
  }
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
}

/// To and fro, as a hand wheel is turned: there and back over `range_deg` in `period_s`.
struct Swing {
  double range_deg, period_s, from_deg = 0.0;
  double At(double t_s) const {
    return from_deg + 0.5 * range_deg * (1.0 - std::cos(2.0 * units::kPi * t_s / period_s));
  }
  int Direction(double t_s) const { return std::sin(2.0 * units::kPi * t_s / period_s) >= 0.0 ? 1 : -1; }
  int Pass(double t_s) const { return static_cast<int>(2.0 * t_s / period_s); }
};

/// Read every `every_s` from `first_s` on, with what the device shows at a time.
template <class Shows>
Record Swung(const Swing& swing, double first_s, double end_s, double every_s, double noise_deg, unsigned seed,
             Shows shows_deg) {
  Noise noise(noise_deg, seed);
  Record record;
  for (double t_s = first_s; t_s < end_s; t_s += every_s)
    record.Add(t_s, swing.At(t_s), shows_deg(t_s) + noise(), swing.Direction(t_s), swing.Pass(t_s));
  return record;
}

/// Stops of 6 deg, two turns there and back twice; the error is a function of time and angle.
template <class Error>
Record Stops(double noise_deg, double step_deg, unsigned seed, Error error_deg) {
  Noise noise(noise_deg, seed);
  Record record{"stops"};
  for (int pass = 0; pass < 4; ++pass) {
    for (int k = 0; k < 120; ++k) {
      const double reference_deg = 0.4 + 6.0 * (pass % 2 == 0 ? k : 119 - k);
      const double time_s = 5.0 * static_cast<double>(record.readings.size());
      double measured_deg = reference_deg + error_deg(time_s, reference_deg) + noise();
      if (step_deg > 0.0) measured_deg = step_deg * std::round(measured_deg / step_deg);
      record.Add(time_s, reference_deg, measured_deg, pass % 2 == 0 ? 1 : -1, pass);
    }
  }
  return record;
}

}  // namespace twinbench::diagnose::encoder::lab
