#include <numeric>

#include "tests/import/importing.h"
#include "twin/core/stream.h"
#include "twin/import/column_functions.h"

// Logs of the two shafts of a gear train as people have them: other ratios, senses, units, names, times and turns.
namespace twinbench::imports {
namespace {

using testing::Contains, testing::HasSubstr, testing::Not;

struct Train {
  int input_turns = 31, output_turns = 16;
  double amplitude_arcsec = 34.0;  // once per turn of the output
  double Ratio() const { return static_cast<double>(input_turns) / output_turns; }
  double Output_deg(double input_deg) const {
    const double even_deg = input_deg / Ratio();
    return even_deg + amplitude_arcsec / 3600.0 * std::cos((even_deg + 57.0) * units::deg);
  }
};

/// @param row  Of the input's and the output's angle in deg.
std::string Log(const Train& train, const std::function<std::string(int k, double input_deg, double output_deg)>& row,
                int rows = 396, int rows_a_turn = 180) {
  std::string text;
  for (int k = 0; k < rows; ++k) {
    const double input_deg = train.Ratio() * 360.0 * k / rows_a_turn;
    text += row(k, input_deg, train.Output_deg(input_deg));
  }
  return text;
}

/// @param form  Of 0 the time in s, 1 and 2 both angles in deg.
std::string Log(const Train& train, const std::string& form, double sense = 1.0) {
  return Log(train, [&](int k, double in, double out) { return fmt::format(fmt::runtime(form), 0.005 * k, sense * in, out); });
}
const std::string kTimed = "{:.4f},{:.7f},{:.7f}\n";

class TwoEncoders : public Importing {
 protected:
  /// The readings are the log's, and their transmission error is the train's.
  static void Expect(const Imported& taken, const Train& train, std::size_t readings) {
    EXPECT_EQ(taken.bench, "hob_transmission");
    EXPECT_THAT(taken.story, HasSubstr("taken as --map two_encoders"));
    EXPECT_THAT(taken.set, Contains(fmt::format("transmission.gear_teeth={}", train.input_turns)));
    EXPECT_THAT(taken.set, Contains(fmt::format("transmission.hob_starts={}", train.output_turns)));
    ASSERT_EQ(taken.readings.size(), readings) << taken.story;
    const Reading& first = taken.readings.front();
    for (const Reading& r : taken.readings) {
      const double even_rad = r.reference_rad / train.Ratio(), wave_rad = train.amplitude_arcsec * units::arcsec;
      const double expected_rad = wave_rad * (std::cos(even_rad + 57.0 * units::deg) - std::cos(57.0 * units::deg));
      ASSERT_NEAR(r.measured_rad - first.measured_rad - even_rad, expected_rad, 0.1 * units::arcsec) << r.reading;
    }
  }
};

TEST_F(TwoEncoders, AreGuessedByTheNamesOfTheirShafts) {
  const Train train;
  const Imported taken = Take("time_s,input_deg,output_deg\n" + Log(train, kTimed));
  Expect(taken, train, 396);
  EXPECT_EQ(taken.readings.front().direction, 1);
  EXPECT_THAT(taken.story, HasSubstr("taken as one of 1.9375 turns of the input to one of the output"));
  EXPECT_THAT(taken.story, Not(HasSubstr("against each other")));
}

/// One row that is far off is no order, and is said with its place; a bump that every turn of the table shows is of the gears.
TEST_F(TwoEncoders, LeaveASingleRowOut) {
  constexpr int kTurns = 3, kRowsOfATurn = 400, kFarRow = 523, kBumpRow = 77;
  Stream noise(3, "counts");
  std::string text = "input_deg,output_deg\n";
  for (int k = 0; k < kTurns * kRowsOfATurn; ++k) {
    const double output_deg = 360.0 * k / kRowsOfATurn;
    const double error_arcsec = 9.0 * std::cos(output_deg * units::deg) + 0.2 * noise.Normal() + (k == kFarRow ? 75.0 : 0.0) +
                                (k % kRowsOfATurn == kBumpRow ? 20.0 : 0.0);
    text += fmt::format("{:.7f},{:.7f}\n", 25.0 * output_deg, output_deg + error_arcsec / 3600.0);
  }
  const Imported taken = Take(text);
  const report::Evaluation evaluation = Evaluated(taken);
  ASSERT_EQ(evaluation.results.at("far").size(), 1U);
  EXPECT_EQ(evaluation.results.at("far").at(0).at("reading"), kFarRow);
  EXPECT_NEAR(evaluation.results.at("far").at(0).at("off_arcsec").get<double>(), 75.0, 1.5);  // five of 0.24 arcsec, and of the wave
  EXPECT_THAT(evaluation.summary, HasSubstr("doubtful: reading 523 (table at 470."));
}

/// An order of one turn of the output has a slope over it.
TEST_F(TwoEncoders, HaveTheRatioOfSmallNumbersInASingleTurn) {
  for (const int phase_deg : {0, 90, 265}) {
    const Train train{60, 1, 40.0};
    const Imported taken = Take("motor [deg],table [deg]\n" + Log(train, [&](int, double in, double) {
                                  const double even_deg = in / 60.0;
                                  return fmt::format("{:.7f},{:.7f}\n", in, even_deg + 40.0 / 3600.0 * std::cos((even_deg + phase_deg) * units::deg));
                                }, 361, 360));
    EXPECT_THAT(taken.set, Contains("transmission.gear_teeth=60")) << phase_deg;
    EXPECT_THAT(taken.set, Contains("transmission.hob_starts=1")) << phase_deg;
  }
}

TEST_F(TwoEncoders, MayStartAgainAtATurnInRadWithoutTimes) {
  const Train train{20, 1, 120.0};
  const auto wrapped = [](double deg) { return deg - 360.0 * std::floor(deg / 360.0); };
  const Imported taken = Take("Antrieb [rad];Abtrieb [rad]\n" + Log(
                                  train,
                                  [&](int, double in, double out) {
                                    return fmt::format("{:.9f};{:.9f}\n", wrapped(in) * units::deg, wrapped(out) * units::deg);
                                  },
                                  2232, 720));
  Expect(taken, train, 2232);
}

TEST_F(TwoEncoders, MayTurnAgainstEachOther) {
  const Train train{50, 17, 60.0};
  const Imported taken = Take("t [s]\tpinion [deg]\twheel [deg]\n" + Log(train, "{:.4f}\t{:.7f}\t{:.7f}\n", -1.0));
  Expect(taken, train, 396);
  EXPECT_THAT(taken.story, HasSubstr("turn against each other"));
}

TEST_F(TwoEncoders, HaveTheRatioThatALineStates) {
  const Train train{60, 1, 5.0};
  Expect(Take("# gear ratio: 60\nmotor_deg,load_deg\n" + Log(train, "{1:.7f},{2:.7f}\n")), train, 396);
}

/// Swung to and fro the output turns slowest where it stands in the gap, for many rows, and its noise goes to and fro itself.
TEST_F(TwoEncoders, ShowThePlayThatIsCrossedSlowly) {
  constexpr int kSwung = 2400;
  constexpr double kGap_deg = 0.06;
  Stream noise(5, "counts");
  std::string text = "time_s,motor_deg,load_deg\n";
  double dragged_deg = -0.5 * kGap_deg;
  for (int k = 0; k < kSwung; ++k) {
    const double wheel_deg = 180.0 * std::sin(units::turn * k / kSwung);
    dragged_deg = std::clamp(dragged_deg, wheel_deg - 0.5 * kGap_deg, wheel_deg + 0.5 * kGap_deg);
    text += fmt::format("{:.3f},{:.4f},{:.5f}\n", 0.025 * k, 80.0 * wheel_deg, dragged_deg + 0.003 * noise.Normal());
  }
  const Imported taken = Take(text);
  EXPECT_EQ(taken.readings.back().pass, 2);
  const diagnose::Diagnosis found = Diagnosed(taken);
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes.front().effect, "backlash");
  EXPECT_NEAR(found.causes.front().parameters.front().value / units::deg, kGap_deg, 0.001);
  EXPECT_TRUE(found.unknown.signature.empty()) << found.unknown.signature;
}

TEST_F(TwoEncoders, OfARatioOfOneAreAComparison) {
  const Train train{1, 1, 60.0};
  const Imported taken = Take("time_s,input_deg,output_deg\n" + Log(train, kTimed));
  EXPECT_EQ(taken.bench, "encoder_comparison");
}

TEST(WholeTurns, AreThoseOfTheTrainWhateverItsErrors) {
  for (const Train& train : {Train{31, 16, 3000.0}, Train{44, 2, 500.0}, Train{97, 89, 20.0}, Train{3, 1, 3600.0}, Train{121, 1, 1000.0}}) {
    std::vector<double> input_deg, output_deg;
    for (int k = 0; k < 900; ++k) {
      input_deg.push_back(train.Ratio() * k);
      output_deg.push_back(train.Output_deg(input_deg.back()));
    }
    const int shared = std::gcd(train.input_turns, train.output_turns);
    const OfColumns whole_turns = ColumnsFunction("whole_turns");
    EXPECT_THAT(whole_turns(input_deg, output_deg, ""), testing::ElementsAre(train.input_turns / shared));
    EXPECT_THAT(whole_turns(output_deg, input_deg, ""), testing::ElementsAre(train.output_turns / shared));
  }
}

/// Within a little more than two turns a degree is more than lies between one ratio of small numbers and the next.
TEST(WholeTurns, AreThoseOfTheTrainThoughAToothSlips) {
  const Train train;
  for (const double resolution_deg : {1e-6, 0.1}) {
    std::vector<double> input_deg, output_deg;
    for (int k = 0; k < 396; ++k) {
      const double slipped_deg = k > 150 ? 1.0 : 0.0;
      input_deg.push_back(train.Ratio() * 2.0 * k);
      output_deg.push_back(resolution_deg * std::round((train.Output_deg(input_deg.back()) + slipped_deg) / resolution_deg));
    }
    EXPECT_THAT(ColumnsFunction("whole_turns")(input_deg, output_deg, ""), testing::ElementsAre(31)) << resolution_deg;
  }
}

TEST(WholeTurns, OfCoarseCountsAreWhatAllStepsTogetherSay) {
  std::vector<double> input_deg, output_deg;
  for (int k = 0; k < 900; ++k) {
    input_deg.push_back(2.001 * k);
    output_deg.push_back(std::floor(2.001 * k / 60.0 / 0.02) * 0.02);
  }
  EXPECT_THAT(ColumnsFunction("whole_turns")(input_deg, output_deg, ""), testing::ElementsAre(60));
}

/// Counts of which a line above the rows says how many make a turn, and a ratio as a fraction, either way round.
TEST_F(TwoEncoders, MayBeCountsWithAStatedFraction) {
  const Train train{29, 2, 40.0};
  const auto log = [&](const std::string& above, double in_counts, double out_counts) {
    return above + Log(train, [&](int, double in, double out) {
             return fmt::format("{:.0f},{:.0f}\n", in / 360.0 * in_counts, out / 360.0 * out_counts);
           }, 1980, 180);
  };
  Expect(Take(log("input encoder: 10000000 counts/rev\noutput encoder: 129600000 counts/rev\nratio: 29/2\nmotor,table\n", 1e7, 1.296e8)), train, 1980);
  Expect(Take(log("EncIn(counts),EncOut(counts)\n# EncIn 10000000 counts/rev, EncOut 129600000 counts/rev\n", 1e7, 1.296e8)), train, 1980);
  Expect(Take(log("# i = 2:29\n# both encoders 2^24 counts per rev\nch1_in,ch2_out\n", std::exp2(24), std::exp2(24))), train, 1980);
  EXPECT_THAT(MessageOf([&] { Take(log("ratio: 31\nboth 2^24 counts per rev\nmotor,table\n", std::exp2(24), std::exp2(24))); }), HasSubstr("states a ratio of 31"));
}

}  // namespace
}  // namespace twinbench::imports
