#include <random>
#include <set>

#include "tests/support/night.h"
#include "tests/tools/program_here.h"

namespace twinbench::test {
namespace {

using std::chrono::duration, std::chrono::steady_clock;

/// Runs that are killed in the middle.
class KilledRun : public ProgramHere {
 protected:
  KilledRun() {
    static duration<double> lasts{};
    BeginWith("kill", [this] {
      // 2 * 13 + 2 * 13 + 4 * 36 * 16 = 2356 readings, one transaction each; so few positions are soon separated.
      std::string passes = "1";
      for (int k = 1; k < 16; ++k) passes += k % 2 == 1 ? ", -1" : ", 1";
      Write("long.toml", "bench = \"rotary_4dof\"\n[mechanics]\nfidelity = \"kinematic\"\n[procedure]\npositions = 36\npasses = [" +
                             passes + "]\n");
      const auto start = steady_clock::now();
      Succeed({"run", "long.toml", "-o", "undisturbed"});
      lasts = steady_clock::now() - start;
    });
    duration_ = lasts;
    readings_ = ReadingsOf("undisturbed");
  }

  /// Kills a run after so many of the ten lines of progress that it writes, and some moments later.
  void KillAfterTenths(int tenths, const std::string& name) {
    Process run(At(""), {"run", "long.toml", "-o", name});
    run.Await(tenths);
    std::this_thread::sleep_for(std::uniform_real_distribution<>(0.0, 0.05)(random_) * duration_);
    if (run.Runs()) run.Kill();
  }

  /// @return how many lines `text` has, all of them whole lines at the beginning of the undisturbed readings.
  std::ptrdiff_t ExpectPrefix(const std::string& text) const {
    EXPECT_TRUE(text.ends_with('\n'));
    const std::ptrdiff_t lines = std::count(text.begin(), text.end(), '\n');
    // Columns of what came along with readings - where encoders stood - are there from the first reading on.
    const std::size_t compared = lines == 1 ? text.size() - 1 : text.size();
    EXPECT_EQ(text.substr(0, compared), readings_.substr(0, compared));
    return lines;
  }

  duration<double> duration_{};
  std::string readings_;
  std::mt19937_64 random_{2007};
};

TEST_F(KilledRun, HoldsAPrefixOfTheUndisturbedRunByteForByte) {
  int cut_short = 0;
  std::set<std::ptrdiff_t> lengths;
  const int moments = ByNight(10, 5);
  for (int moment = 0; moment < moments; ++moment) {
    const std::string name = "killed" + std::to_string(moment);
    KillAfterTenths(1 + moment % 7, name);
    const std::ptrdiff_t lines = ExpectPrefix(Succeed({"export", name}));
    lengths.insert(lines);
    if (lines < std::count(readings_.begin(), readings_.end(), '\n')) ++cut_short;
  }
  // On a busy machine a kill may come late, but not most of them.
  EXPECT_GT(cut_short, moments / 2) << "the kills came too late to show anything";
  EXPECT_GT(std::ssize(lengths), moments / 2);
}

TEST_F(KilledRun, AtItsVeryStartHasNoRecordOrAGoodOne) {
  for (int moment = 0; moment < 10; ++moment) {
    const std::string name = "killed" + std::to_string(moment);
    {
      const Process run(At(""), {"run", "long.toml", "-o", name});
      std::this_thread::sleep_for(std::chrono::milliseconds(2 * moment));  // at its end it is killed
    }
    const Outcome outcome = Call({"export", name});
    if (outcome.exit_code == 0) {
      ExpectPrefix(outcome.out);
    } else {
      // A record appears whole or not at all; without one that is said in one line, as bad input.
      EXPECT_FALSE(Exists(name + "/record.sqlite"));
      EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
      EXPECT_THAT(outcome.err, testing::HasSubstr(name));
    }
  }
}

TEST_F(KilledRun, CanStillBeEvaluatedAsFarAsItGotAndIsNotOverwrittenByTheNext) {
  KillAfterTenths(7, "killed");
  const Outcome outcome = Call({"separate", "killed", "--json", "-"});
  EXPECT_TRUE(outcome.exit_code == 0 || outcome.err.find("; expected ") != std::string::npos) << outcome.err;
  EXPECT_TRUE(Exists("killed/scenario.toml"));
  Refusal({"run", "long.toml", "-o", "killed"});
}

}  // namespace
}  // namespace twinbench::test
