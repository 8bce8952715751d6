#include "tests/core/input_error.h"
#include "tests/support/angle_benches.h"
#include "tests/support/kept_text.h"
#include "twin/benches/expected.h"
#include "twin/benches/turntable_autocollimator/settings.h"

namespace twinbench::plausible {
namespace {

using testing::HasSubstr, testing::IsEmpty, testing::Not;

/// A device beside its reference, half a turn forth and back.
std::vector<Reading> Readings(int count = 200) {
  std::vector<Reading> readings;
  for (int i = 0; i < count; ++i) {
    const bool back = i >= count / 2;
    Reading r{.reading = i, .time = Time(FromSeconds(i)), .pass = back ? 1 : 0, .direction = back ? -1 : 1,
              .position = back ? count - 1 - i : i};
    r.reference_rad = r.position * 1.8 * units::deg;
    r.measured_rad = r.reference_rad + 1e-4 * std::sin(17.0 * i);
    readings.push_back(r);
  }
  return readings;
}

Scenario Angles() { return ParseScenario("bench = \"encoder_comparison\"\n", "test", ""); }

std::string Lines(const std::vector<Reading>& readings, const Scenario& scenario = Angles()) {
  const std::string lines = InLines(Check(readings, scenario));
  return lines.substr(0, lines.find_last_not_of('\n') + 1);
}

TEST(Plausible, SaysNothingOfGoodReadings) {
  EXPECT_THAT(Lines(Readings()), IsEmpty());
}

constexpr double k9_rad = 9.0 * units::deg;

/// What was done to a reading of them all.
using Change = void (*)(Reading&);
std::vector<Reading> Changed(Change change) {
  std::vector<Reading> readings = Readings();
  std::ranges::for_each(readings, change);
  return readings;
}

TEST(Plausible, SaysWhatIsWrongWithReadings) {
  const Change changes[] = {
      [](Reading& r) { r.measured_rad = 0.0; },        // a dead channel
      [](Reading& r) { r.position = 0; },              // all the same
      [](Reading& r) { r.direction = -r.direction; },  // which the angles contradict
      [](Reading& r) { r.measured_rad = std::round(r.measured_rad / k9_rad) * k9_rad; },  // coarse steps
      [](Reading& r) { r.time = Time{}; },                                                // a clock that stands
      [](Reading& r) { r.reference_rad *= r.reading == 150 ? 1e15 : 1.0; },  // where nothing turns to in a second
  };
  for (const Change change : changes) EXPECT_KEPT(Lines(Changed(change)));
  EXPECT_KEPT(
      MessageOf([] { RefuseFatal(Check(Changed([](Reading& r) { r.measured_rad = 0.0; }), Angles()), "run"); }));
  const auto at_60_000_a_minute = [](Reading& r) { r.reference_rad = r.reading * 1000.0 * units::turn; };
  EXPECT_THAT(Lines(Changed(at_60_000_a_minute)), testing::Not(HasSubstr("turns from where it was")));

  std::vector<Reading> stuck = Readings();
  for (int i = 60; i < 95; ++i) stuck[i].measured_rad = stuck[60].measured_rad;
  EXPECT_THAT(Lines(stuck), HasSubstr("doubtful: measured_deg stands still"));
  EXPECT_THAT(Lines(stuck), HasSubstr("for 35 readings, up to reading 94"));
  EXPECT_KEPT(Lines({}));
  EXPECT_KEPT(Lines(Readings(2)));
}

/// Angles of two shafts that are geared 90 to 1, some rows lost.
/// @param way_deg   Of the faster one, from row to row.
/// @param step_deg  In which it is counted.
std::vector<Reading> Geared(double way_deg, double step_deg) {
  std::vector<Reading> readings;
  for (int i = 0; i < 400; ++i) {
    if (i % 5 == 3 || i % 7 == 2) continue;
    readings.push_back({.reading = i, .time = Time(FromSeconds(i)), .direction = 1, .position = i,
                        .reference_rad = std::round(i * way_deg / step_deg) * step_deg * units::deg,
                        .measured_rad = i * way_deg / 90.0 * units::deg + 10.0 * units::arcsec * std::sin(17.0 * i),
                        .head_rad = 0.0});
  }
  return readings;
}

TEST(Plausible, DoesNotTakeTheDistanceOfRowsForAResolution) {
  const Scenario train = ParseScenario("bench = \"hob_transmission\"\n", "test", "");
  EXPECT_THAT(Lines(Geared(45.0, 45.0), train), Not(HasSubstr("comes in steps")));
  EXPECT_THAT(Lines(Geared(5.0, 45.0), train), HasSubstr("hob_encoder_deg comes in steps of 45"));
}

/// Four detector channels about a volt.
std::vector<Reading> Voltages() {
  std::vector<Reading> readings;
  for (int i = 0; i < 72; ++i) {
    Reading r{.reading = i, .time = Time(FromSeconds(i)), .position = i, .target_rad = i * 5.0 * units::deg};
    r.reference_rad = -r.target_rad;
    for (int c = 0; c < kChannels; ++c) r.mean_V[c] = std::sin(3.0 * i + c);
    readings.push_back(r);
  }
  return readings;
}

/// A servo that is 20 readings behind its command is late, and its readings are in order.
TEST(Plausible, DoubtsADeviceThatComesLaterAndRefusesOneThatNeverComes) {
  std::vector<Reading> late = Readings(), other = Readings();
  const auto wave = [](int i) { return std::sin(2.0 * units::kPi * i / 80.0); };
  for (int i = 0; i < 200; ++i) {
    Reading &servo = late[static_cast<std::size_t>(i)], &stranger = other[static_cast<std::size_t>(i)];
    servo.reference_rad = stranger.reference_rad = wave(i);
    servo.measured_rad = wave(i - 20) + 1e-4 * std::sin(17.0 * i);
    stranger.measured_rad = std::sin(2.9 * i * i);
  }
  const auto lines = [](const std::vector<Reading>& readings) {
    return InLines(Check(readings, Angles(), {{.column = "measured_deg", .nominal = [](const Reading& r) { return r.reference_rad; }, .is_angle = true}}));
  };
  EXPECT_THAT(lines(late), HasSubstr("doubtful: measured_deg goes with the angles or places of its readings about 20 readings later"));
  EXPECT_THAT(lines(late), Not(HasSubstr("cannot be")));
  EXPECT_THAT(lines(other), HasSubstr("cannot be: measured_deg does not go with"));
}

/// Closed forms in all their digits: what they differ by from the curve through their neighbours is the last bit.
TEST(Plausible, SaysNothingOfAScatterThatIsTheLastDigits) {
  for (const double noise_rad : {2e-15, 1e-6}) {
    std::vector<Reading> readings = Readings();
    for (Reading& r : readings) {
      r.measured_rad = r.reference_rad + 1e-3 + noise_rad * std::sin(17.0 * r.reading * r.reading) + (r.reading == 60 ? 1e-3 : 0.0);
    }
    const std::string said = InLines(Check(readings, Angles(), {{.column = "measured_deg", .nominal = [](const Reading& r) { return r.reference_rad; }, .is_angle = true}}));
    EXPECT_EQ(said.find("times its scatter") != said.npos, noise_rad == 1e-6) << said;
  }
}

TEST(Plausible, RefusesVoltsThatTheCardCannotGive) {
  const Scenario scenario = ParseScenario("bench = \"rotary_4dof\"\n", "test", "");
  EXPECT_THAT(Lines(Voltages(), scenario), IsEmpty());
  std::vector<Reading> one = Voltages(), in_mV = Voltages();
  one[7].mean_V[1] = 1e308;
  EXPECT_KEPT(Lines(one, scenario));
  for (Reading& r : in_mV) r.mean_V[0] *= 1000.0;
  EXPECT_THAT(Lines(in_mV, scenario), HasSubstr("is it in mV?"));
}

TEST(Plausible, PutsWhatCannotBeFirst) {
  const auto both = Changed([](Reading& r) { r.direction = -r.direction, r.position = 0; });
  const std::vector<Finding> findings = Check(both, Angles());
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_TRUE(findings[0].fatal);
  EXPECT_FALSE(findings[1].fatal);
}

using Rows = std::vector<Reading>;

/// The shipped scenarios of the benches, the larger ones shortened.
const std::vector<Scenario>& Benches() {
  static const std::vector<Scenario> scenarios = [] {
    std::vector<Scenario> all;
    const std::pair<const char*, std::vector<std::string>> benches[] = {
        {"rotary_4dof", {"mechanics.fidelity=\"kinematic\"", "mechanics.vibration=\"none\""}},
        {"turntable_autocollimator", {}},
        {"encoder_comparison", {}},
        {"hob_transmission", {"hob_procedure.samples_per_turn=180"}},
        {"circular_motion", {"circular_procedure.points=60"}},
        {"freeform_five_axis", {"freeform_procedure.poses=30"}}};
    for (const auto& [name, set] : benches) all.push_back(LoadScenario(test::ScenarioPath(std::string(name) + ".toml"), set));
    return all;
  }();
  return scenarios;
}

const Rows& Good(std::size_t bench) {
  static std::vector<Rows> runs(Benches().size());
  if (runs[bench].empty()) runs[bench] = test::ReadingsOf(Benches()[bench]);
  return runs[bench];
}

/// What is shown, but the scatter of samples: an outsider changes what he takes for the values.
std::vector<const ReadingColumn*> Values(const Scenario& scenario) {
  std::vector<const ReadingColumn*> columns;
  for (const ReadingColumn& column : FormatOf(scenario.bench).columns) {
    const bool is_same_clock =
        column.name == "table_encoder_deg" || column.name.starts_with("grid_") || column.name.starts_with("interfero");
    if (column.IsShown() && column.number && !column.name.ends_with("_std_V") && column.name != "qpd_sum_V" && !is_same_clock)
      columns.push_back(&column);
  }
  return columns;
}

Rows EachValue(Rows readings, const Scenario& scenario, const std::function<double(double)>& change) {
  for (Reading& r : readings)
    for (const ReadingColumn* column : Values(scenario)) column->number(r) = change(column->number(r));
  return readings;
}

Rows EachAngle(Rows readings, const Scenario& scenario, double times) {
  for (const ReadingColumn& column : FormatOf(scenario.bench).columns) {
    if (column.role != ColumnRole::kRequired || !column.number || !column.name.ends_with("_deg") || column.name == "head_deg")
      continue;
    for (Reading& r : readings) column.number(r) *= times, r.extra.clear();
  }
  return readings;
}

Rows Shuffled(const Rows& readings, const Scenario& scenario) {
  Rows shuffled = readings;
  Stream stream(1, "test.shuffle");
  for (std::size_t i = readings.size(); i-- > 1;)
    for (const ReadingColumn* column : Values(scenario))
      std::swap(column->number(shuffled[i]),
                column->number(shuffled[static_cast<std::size_t>(stream.Uniform() * static_cast<double>(i))]));
  return shuffled;
}

/// By one, in what is shown alone.
Rows Late(const Rows& readings, const Scenario& scenario) {
  Rows late = readings;
  for (std::size_t i = 1; i < late.size(); ++i)
    for (const ReadingColumn* column : Values(scenario)) {
      Reading before = readings[i - 1];
      column->number(late[i]) = column->number(before);
    }
  return late;
}

Rows Twice(const Rows& readings) {
  Rows twice;
  for (const Reading& r : readings) twice.insert(twice.end(), 2, r);
  for (std::size_t i = 0; i < twice.size(); ++i) twice[i].reading = static_cast<int>(i);
  return twice;
}

Rows EverySecond(const Rows& readings) {
  Rows half;
  for (std::size_t i = 0; i < readings.size(); i += 2) half.push_back(readings[i]);
  return half;
}

Rows FirstHalf(const Rows& readings) { return {readings.begin(), readings.begin() + std::ssize(readings) / 2}; }

Rows EachTime(Rows readings, double times) {
  for (Reading& r : readings) r.time = Time(FromSeconds(times * ToSeconds(r.time)));
  return readings;
}

/// A channel shows a value to the last digit from the third of the readings on.
Rows Stuck(Rows readings, const Scenario& scenario) {
  const ReadingColumn& column = *Values(scenario).front();
  Reading last = readings[readings.size() / 3];
  for (std::size_t i = readings.size() / 3; i < readings.size(); ++i)
    if (std::isfinite(column.number(readings[i]))) column.number(readings[i]) = column.number(last);
  return readings;
}

/// The axis stands at its third stop, and its controller counts on.
Rows Standing(Rows readings) {
  for (std::size_t i = 3; i < readings.size(); ++i)
    readings[i].reference_rad = readings[3].reference_rad,
    readings[i].measured_rad = readings[3].measured_rad + 1e-6 * static_cast<double>(i % 5);
  return readings;
}

/// The first finding of each kind, without the numbers, which are the twin's.
std::string Said(const Rows& readings, const Scenario& scenario) {
  const std::vector<Finding> findings = DoubtsAbout(readings, scenario);
  return findings.empty() ? "-" : (findings[0].fatal ? "cannot be: " : "doubtful: ") + findings[0].line;
}

TEST(Mangled, ReadingsOfAnyBenchAreRefusedOrSaidAndGoodOnesAreNot) {
  using Mangling = std::function<Rows(const Rows&, const Scenario&)>;
  const std::pair<const char*, Mangling> changes[] = {
      {"good", [](const Rows& r, const Scenario&) { return r; }},
      {"all zero",
       [](const Rows& r, const Scenario& s) { return EachValue(r, s, [](double x) { return 0.0 * x; }); }},
      {"a thousandth",
       [](const Rows& r, const Scenario& s) { return EachValue(r, s, [](double x) { return 1e-3 * x; }); }},
      {"a thousand times",
       [](const Rows& r, const Scenario& s) { return EachValue(r, s, [](double x) { return 1e3 * x; }); }},
      {"negative", [](const Rows& r, const Scenario& s) { return EachValue(r, s, [](double x) { return -x; }); }},
      {"stuck", Stuck}, {"shuffled", Shuffled}, {"late by one", Late}, {"twice", [](const Rows& r, const Scenario&) { return Twice(r); }},
      {"every second", [](const Rows& r, const Scenario&) { return EverySecond(r); }},
      {"the first half", [](const Rows& r, const Scenario&) { return FirstHalf(r); }},
      {"times in ms", [](const Rows& r, const Scenario&) { return EachTime(r, 1e3); }},
      {"times in h", [](const Rows& r, const Scenario&) { return EachTime(r, 1.0 / units::hour); }},
      {"angles in mdeg", [](const Rows& r, const Scenario& s) { return EachAngle(r, s, 1e3); }},
      {"angles in rad", [](const Rows& r, const Scenario& s) { return EachAngle(r, s, units::deg); }}};
  for (const auto& [what, change] : changes) {
    std::string said;
    for (std::size_t bench = 0; bench < Benches().size(); ++bench)
      said += Benches()[bench].bench + ": " + Said(change(Good(bench), Benches()[bench]), Benches()[bench]) + "\n";
    EXPECT_KEPT(std::string(what) + "\n" + said);
  }
}

/// Fifteen times the noise is a digit or a speck of dust, and six is chance; where a place was read three times and
/// more.
TEST(Mangled, OneValueThatIsUnlikeAllOthersOfItsPlaceIsDoubted) {
  for (const auto& [bench, column, noise] :
       {std::tuple(0, "psd_a_x_V", 0.6e-3), std::tuple(4, "bar_um", 0.25e-6)}) {
    const Scenario& scenario = Benches()[static_cast<std::size_t>(bench)];
    const auto& columns = FormatOf(scenario.bench).columns;
    const ReadingColumn& shown = *std::ranges::find(columns, column, &ReadingColumn::name);
    const std::size_t count = Good(static_cast<std::size_t>(bench)).size();
    for (const std::size_t at : {count / 2 + 5, 2 * count / 3}) {
      Rows far = Good(static_cast<std::size_t>(bench)), near = far;
      if (!std::isfinite(shown.number(far[at]))) continue;
      shown.number(far[at]) += 18.0 * noise, shown.number(near[at]) += 3.0 * noise;
      EXPECT_THAT(Said(far, scenario), HasSubstr("from all others of its place")) << column << " " << at;
      EXPECT_EQ(Said(near, scenario), "-") << column << " " << at;
    }
  }
}

TEST(Mangled, ValuesThatAreOthersToTheLastDigitAreDoubted) {
  for (const int bench : {0, 1, 4, 5}) {
    const Scenario& scenario = Benches()[static_cast<std::size_t>(bench)];
    Rows copied = Good(static_cast<std::size_t>(bench));
    const auto from = copied.begin() + std::ssize(copied) / 8, to = copied.begin() + std::ssize(copied) / 2;
    for (const ReadingColumn* column : Values(scenario))
      for (int i = 0; i < 24; ++i) column->number(to[i]) = column->number(from[i]);
    EXPECT_THAT(InLines(DoubtsAbout(copied, scenario)), HasSubstr("to the last digit: was it copied?")) << scenario.bench;
  }
}

/// Rows so near to each other that a recording has one position of several lie on their way: a reversal is no speck of dust.
TEST(Mangled, WhatJumpsFromOneRowOfAPositionToTheNextIsNotDoubted) {
  std::vector<Reading> readings = Readings();
  for (Reading& r : readings) {
    r.measured_rad = r.reference_rad + 1e-5 * std::sin(17.0 * r.reading) + (r.reading > 31 && r.pass == 0 ? 4e-3 : 0.0);
    if (r.reading == 31) r.measured_rad += 2.5e-3;
    r.position /= 3;
  }
  EXPECT_THAT(Lines(readings), Not(HasSubstr("of its place")));
}

/// Nobody plans a recording: neither a scenario that was made up for it, nor one that knows the device only.
TEST(Mangled, AComparisonAtOtherAnglesThanPlannedMayHaveAnyNumberOfReadings) {
  const Scenario& planned = Benches()[2];
  const auto turned = [&](double step_rad) {
    Rows readings = FirstHalf(Good(2));
    for (Reading& r : readings)
      r.reference_rad = r.position * step_rad, r.measured_rad = r.reference_rad + 1e-5 * (r.reading % 7);
    return readings;
  };
  EXPECT_THAT(Said(turned(5.0 * units::deg), planned), HasSubstr("of the 576 readings"));
  EXPECT_THAT(Said(turned(4.0 * units::deg), planned), Not(HasSubstr("readings that")));
  Scenario made_up = planned;
  made_up.title = "imported from mine.csv";
  EXPECT_THAT(Said(turned(5.0 * units::deg), made_up), Not(HasSubstr("readings that")));
}

/// Its index errors would be the tilt of the mounting, exit code 0.
TEST(Mangled, AnAutocollimatorWhoseAxesAreExchangedIsRefusedAndOneOfOtherSignsDoubted) {
  const Scenario designs[] = {Benches()[1], LoadScenario(test::ScenarioPath("turntable_polygon.toml"))};
  for (const Scenario& scenario : designs) {
    const Rows good = test::ReadingsOf(scenario);
    Rows exchanged = good, reversed = good;
    for (Reading& r : exchanged) std::swap(r.autocollimator_yaw_rad, r.autocollimator_tilt_rad);
    for (Reading& r : reversed) r.autocollimator_yaw_rad *= -1.0, r.autocollimator_tilt_rad *= -1.0;
    EXPECT_EQ(Said(good, scenario), "-");
    EXPECT_THAT(Said(exchanged, scenario), HasSubstr("cannot be: autocollimator_x_arcsec shows what the scenario says of"));
    EXPECT_THAT(InLines(DoubtsAbout(reversed, scenario)), HasSubstr("doubtful: autocollimator_y_arcsec goes the other way"));
  }
}

TEST(Mangled, AnAutocollimatorThatIsLateByOneIsDoubtedWhereAllPassesGoOneWay) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("turntable_autocollimator.toml"), {"turntable_procedure.passes=[1]"});
  const Rows good = test::ReadingsOf(scenario);
  EXPECT_EQ(Said(good, scenario), "-");
  EXPECT_THAT(Said(Late(good, scenario), scenario), HasSubstr("answer one reading late"));
}

TEST(Mangled, ANulledFaceIsDoubtedInAnotherUnitAndATableOfFacesIsNot) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("turntable_polygon.toml"), {});
  const Rows good = test::ReadingsOf(scenario);
  Rows far = good, of_table = good;
  for (Reading& r : far) r.autocollimator_yaw_rad *= 1e3;
  const TurntableProcedureSettings& procedure = TurntableOf(scenario).turntable_procedure;
  for (Reading& r : of_table) {
    r.autocollimator_yaw_rad *= 1e3;
    r.target_rad = procedure.Of(procedure.polygon_offsets_rad, r.setup) - r.reference_rad + (r.position == 0 ? units::turn : 0.0);
    r.extra.clear();
  }
  EXPECT_EQ(Said(good, scenario), "-");
  EXPECT_THAT(Said(far, scenario), HasSubstr("as far from zero as it is brought"));
  EXPECT_THAT(Said(of_table, scenario), Not(HasSubstr("as far from zero")));
}

TEST(Mangled, WhatANulledFaceHasLeftIsDoubtedWhereTheTurntableDoesNotStandBesideIt) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("turntable_polygon.toml"), {});
  const Rows good = test::ReadingsOf(scenario);
  const auto said = [&](const std::function<double(std::size_t)>& x) {
    Rows mangled = good;
    for (std::size_t i = 0; i < good.size(); ++i) mangled[i].autocollimator_yaw_rad = x(i);
    return Said(mangled, scenario);
  };
  const auto x = [&](std::size_t i) { return good[i % good.size()].autocollimator_yaw_rad; };
  EXPECT_EQ(said([&](std::size_t i) { return x(i); }), "-");
  for (const auto& mangled : std::vector<std::function<double(std::size_t)>>{
           [&](std::size_t i) { return x(7919 * i); }, [&](std::size_t i) { return 1e-3 * x(i); }, [&](std::size_t i) { return -x(i); }})
    EXPECT_THAT(said(mangled), HasSubstr("as far as its axis from one reading of a place to the next"));
}

TEST(Mangled, WhatANulledFaceHasLeftIsNoSingleValueWithinItsDeadband) {
  const std::vector<std::string> wide = {"autocollimator.deadband_arcsec=0.3", "encoder.noise_arcsec=0.1"};
  const Scenario scenario = LoadScenario(test::ScenarioPath("turntable_polygon.toml"), wide);
  EXPECT_EQ(Said(test::ReadingsOf(scenario), scenario), "-");
}

/// As a controller shows an axis that comes to one place again and again: its own last digits are no other place.
TEST(Plausible, AnAxisThatOnlyStandsAtOnePlaceIsNotElsewhere) {
  std::vector<Reading> readings = Readings(12);
  for (Reading& r : readings) {
    r.reference_rad = 0.0;
    r.extra["reference_encoder_before_deg"] = r.reading % 4 == 1 ? "0.0003" : r.reading % 2 == 0 ? "0.0001" : "0.0000";
  }
  EXPECT_THAT(Lines(readings), Not(HasSubstr("at another place")));
  readings[7].extra["reference_encoder_before_deg"] = "30.0";
  EXPECT_THAT(Lines(readings), HasSubstr("reading 7 is the first of them"));
}

TEST(Mangled, AShaftThatStandsWhileItsEncoderCountsIsRefused) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("encoder_comparison.toml"));
  EXPECT_KEPT(Said(Standing(test::RunBench(scenario).readings), scenario));
}

}  // namespace
}  // namespace twinbench::plausible
