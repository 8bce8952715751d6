#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/support/noise.h"
#include "tests/support/thresholds.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/core/reading_clock.h"
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
    Reading r{.reading = static_cast<int>(readings.size()),
              .time = Time(FromSeconds(time_s)),
              .pass = pass,
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
  /// Of the wave of this order, whatever its name is.
  double SizeOfOrder(int order) const {
    if (order == 1) return Value("eccentricity", "amplitude");
    if (order == 2) return Value("ellipticity", "amplitude");
    for (const Cause& cause : run.diagnosis.causes) {
      const auto of = [&cause](const char* name) {
        return *std::ranges::find(cause.parameters, name, &ParameterEstimate::name);
      };
      if (cause.effect == "periodic" && of("order").value == order)
        return of("amplitude").value / of("amplitude").to_SI;
    }
    return kNaN;
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

inline Answer Ask(const Record& record) { return {record}; }

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

/// `order` periods in a turn.
struct Wave {
  int order;
  double size_deg, phase_deg;
};

inline double Sum(const std::vector<Wave>& waves, double angle_deg) {
  double sum = 0.0;
  for (const Wave& w : waves) sum += w.size_deg * std::cos((w.order * angle_deg + w.phase_deg) * units::deg);
  return sum;
}

/// Where and when a reading is taken.
struct Place {
  double deg, t_s;
  int stop, direction, pass;
};

/// Stops from `from_deg` on, there and back in turn.
struct Course {
  double from_deg, step_deg;
  int stops, passes = 1;
  double every_s = 0.0;  // 0: no clock, one after the other
  const char* kind = "stops";
};

/// @param shows_deg  What the device shows at a place.
template <class Shows>
Record Listed(const Course& course, Shows shows_deg) {
  Record record{course.kind};
  for (int k = 0; k < course.passes * course.stops; ++k) {
    const int pass = k / course.stops, at = k % course.stops, direction = pass % 2 == 0 ? 1 : -1;
    const int stop = direction > 0 ? at : course.stops - 1 - at;
    const Place place{course.from_deg + course.step_deg * stop, (course.every_s > 0.0 ? course.every_s : 1.0) * k,
                      stop, direction, pass};
    record.Add(place.t_s, place.deg, shows_deg(place), direction, pass);
    if (course.every_s == 0.0) record.readings.back().extra[kClockColumn] = kNoClock;
  }
  return record;
}

using Error = std::function<double(const Place& at)>;

inline Error Of(const std::vector<Wave>& waves) {
  return [=](const Place& at) { return Sum(waves, at.deg); };
}
inline Error ByDirection(double size_deg) {
  return [=](const Place& at) { return size_deg * at.direction; };
}
inline Error operator+(const Error& one, const Error& other) {
  return [=](const Place& at) { return one(at) + other(at); };
}

inline Record Listed(const Course& course, double noise_deg, unsigned seed, const Error& error_deg) {
  Noise noise(noise_deg, seed);
  return Listed(course, [&](const Place& at) { return at.deg + error_deg(at) + noise(); });
}

/// Stops of 6 deg, two turns there and back twice, shown in whole steps.
inline Record Stops(double noise_deg, double step_deg, unsigned seed, const Error& error_deg) {
  Noise noise(noise_deg, seed);
  return Listed({0.4, 6.0, 120, 4, 5.0}, [&](const Place& at) {
    const double shown_deg = at.deg + error_deg(at) + noise();
    return step_deg > 0.0 ? step_deg * std::round(shown_deg / step_deg) : shown_deg;
  });
}

/// Read in motion, whose direction and passes are those of the reference.
/// @param at_deg  Of the reference, by the time.
template <class At, class Shows>
Record Chirped(double first_s, double end_s, double every_s, At at_deg, Shows shows_deg) {
  Record record;
  int direction = 1, pass = 0;
  for (double t_s = first_s; t_s < end_s; t_s += every_s) {
    const int now = at_deg(t_s + 1e-4) > at_deg(t_s - 1e-4) ? 1 : -1;
    pass += now == direction ? 0 : 1;
    direction = now;
    record.Add(t_s, at_deg(t_s), shows_deg(t_s), direction, pass);
  }
  return record;
}

/// What is asked of an answer.
using Check = std::function<void(const Answer&)>;

inline Check Is(Verdict v) {
  return [=](const Answer& a) { EXPECT_EQ(a.run.diagnosis.verdict, v); };
}
inline Check IsNot(Verdict v) {
  return [=](const Answer& a) { EXPECT_NE(a.run.diagnosis.verdict, v); };
}
inline Check HasCauses(std::size_t n) {
  return [=](const Answer& a) { EXPECT_EQ(a.run.diagnosis.causes.size(), n); };
}
inline Check HasUnnamed(bool has) {
  return [=](const Answer& a) { EXPECT_EQ(HasUnmodelled(a.run.diagnosis), has); };
}
inline Check Named(const std::string& effect, double from = 0.8) {
  return [=](const Answer& a) { EXPECT_TRUE(a.Names(effect, from)) << effect; };
}
inline Check NotNamed(const std::vector<std::string>& effects, double from = 0.1) {
  return [=](const Answer& a) {
    for (const std::string& effect : effects) EXPECT_FALSE(a.Names(effect, from)) << effect;
  };
}
inline Check NoneFrom(double probability) {
  return [=](const Answer& a) {
    for (const Cause& cause : a.run.diagnosis.causes) EXPECT_LT(cause.probability, probability) << cause.effect;
  };
}
inline Check Says(const testing::Matcher<std::string>& words) {
  return [=](const Answer& a) { EXPECT_THAT(a.run.diagnosis.unknown.signature, words); };
}
inline Check Notes(const std::string& words) {
  return [=](const Answer& a) { EXPECT_THAT(a.run.diagnosis.notes, testing::Contains(testing::HasSubstr(words))); };
}
/// Within `within` and so many of its uncertainties.
inline Check Size(const std::string& effect, const std::string& parameter, double value, double within,
                  double of_u = 0.0) {
  return [=](const Answer& a) {
    const double u = of_u > 0.0 ? of_u * a.Uncertainty(effect, parameter) : 0.0;
    EXPECT_NEAR(a.Value(effect, parameter), value, within + u) << effect;
  };
}
/// Whatever its sign.
inline Check Play(double width_deg, double within_deg) {
  return [=](const Answer& a) { EXPECT_NEAR(std::abs(a.Value("backlash", "width")), width_deg, within_deg); };
}
inline Check Order(int order, double size_deg, double within_deg) {
  return [=](const Answer& a) { EXPECT_NEAR(a.SizeOfOrder(order), size_deg, within_deg) << order; };
}
/// Named, in its size, and so sharply that it is worth something.
inline Check Found(const std::string& effect, const std::string& parameter, double value, double u = 1e9) {
  return [=](const Answer& a) {
    Named(effect)(a);
    Size(effect, parameter, value, 0.0, 4.0)(a);
    EXPECT_LT(a.Uncertainty(effect, parameter), u) << effect;
  };
}
/// The file that was written says it all.
inline const Check kSilentAgain = [](const Answer& a) {
  EXPECT_EQ(a.Again().verdict, Verdict::kNone) << a.Words();
};

/// A recording and its answer.
struct Row {
  std::string name;
  std::function<Record(unsigned seed)> record;
  std::vector<Check> checks;
  std::vector<unsigned> seeds = {1};
};
using Rows = std::vector<Row>;

inline Row OfCourse(const std::string& name, const Course& course, double noise_deg, const Error& error_deg,
                    const std::vector<Check>& checks, const std::vector<unsigned>& seeds = {1}) {
  return {name, [=](unsigned seed) { return Listed(course, noise_deg, seed, error_deg); }, checks, seeds};
}

inline void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }
inline std::string NameOfRow(const testing::TestParamInfo<Row>& row) { return row.param.name; }

/// Its one test is in encoder_dominant_test.cc; the rows of every file are instances.
class EncoderAnswer : public testing::TestWithParam<Row> {};

}  // namespace twinbench::diagnose::encoder::lab
