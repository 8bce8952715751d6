#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "twin/investigate/investigation.h"

namespace twinbench::investigate {

/// Measures until it is told what is there, or until there is nothing more to be had: takes runs
/// (investigation.cc), chooses the next one (next_run.cc) and weighs what it says (weigh_run.cc).
class Loop {
 public:
  Loop(const Scenario& scenario, const InvestigationOptions& options, const Means& means,
       const Laboratory& laboratory);
  Investigation Run();

 private:
  static constexpr const char* kOutliers = "outliers";  // in every catalogue

  Told ToldBy(const Belief& belief, double unlisted) const;
  bool HasRival(const Belief& belief) const;
  bool IsDone();
  bool IsNothingFound() const;
  bool MayBeFaint() const;
  bool MayHappenAgain() const;
  bool IsNewsOfOneRun() const;
  double WorthSoFar() const;
  double Faint() const;
  double RunsToShowFaint() const;
  bool IsMostlyUnlisted() const;
  void Take(Step& step, const Scenario& scenario);
  void Note(Step step, double entropy_before);
  void TakeFirst();
  void Begin();
  static bool HoldsOutliers(const diagnose::DiagnosisRun& found);
  std::optional<diagnose::DiagnosisRun> DiagnosisOf(const std::vector<Reading>& readings, const Scenario& scenario,
                                                    std::string& refusal) const;
  void RefuseGoalsOutOfReach(const Scenario& scenario,
                             const std::function<std::vector<Reading>(const Scenario&)>& readings_of);
  bool End(Ended ended);

  bool TakeNext();
  bool TakeConfirmed(const Advice& chosen, std::string reason, const std::vector<Advice>& advice);
  bool TakeToDiagnose(std::vector<Advice> advice);
  std::vector<Advice>::const_iterator Exploring(const std::vector<Advice>& advice);
  bool IsOnlyUnlistedLeft() const;
  std::vector<Advice>::const_iterator LookingCloser(const std::vector<Advice>& advice) const;
  bool IsUseful(const Advice& a) const;
  bool ArePromisesVain() const;
  bool IsAnyLeftOut(double left_min) const;
  std::string ReasonFor(const Advice& best, const std::vector<Advice>& advice) const;
  std::string ReasonToLook() const;

  static Hypothesis OutliersIn(Hypothesis hypothesis);
  static std::vector<Weighed> InsteadOf(const Hypothesis& best, std::vector<Weighed> others);
  void StrikeOutliersOfLast();
  void NoteTold();
  void TakeAndWeigh(Step step);
  static bool IsNew(const std::string& name, std::vector<std::string>& noted);
  void DoubtAName();
  void AskOthers();
  void DoubtAWave();
  const std::optional<diagnose::DiagnosisRun>& LastAlone(const Hypothesis& best);
  void Compare();
  std::vector<Reading> WithThoseLike(const TakenRun& run, const Hypothesis& best) const;
  bool IsOfAnotherKind() const;
  Hypothesis AsMany(const Hypothesis& hypothesis) const;

  bool AreCausesTold() const { return ToldBy(result_.belief, options_.conclusive) != Told::kTied; }
  bool ShouldRepeat() const { return MayHappenAgain() || IsNewsOfOneRun(); }
  bool WasAnyDiagnosed() const { return not_diagnosed_.empty(); }

  const Scenario& scenario_;
  const InvestigationOptions& options_;
  const Means& means_;
  const Laboratory& laboratory_;
  std::optional<Certainty> certainty_;
  std::optional<Plans> plans_;  // once they are needed: each is a run of the twin
  std::vector<TakenRun> runs_;
  std::string not_diagnosed_;                     // why none of the runs so far could be
  std::vector<std::string> told_by_diagnosis_;    // names whose rivals and doubles a diagnosis was asked for
  std::vector<std::string> held_against_others_;  // of the whole catalogue
  struct {
    std::size_t runs = 0;
    bool is_mean = false;
    std::optional<diagnose::DiagnosisRun> found;
  } alone_;  // LastAlone
  Overtones overtones_;
  double unlisted_before_ = std::numeric_limits<double>::infinity();  // the last run that was made for it alone
  Investigation result_;
};

}  // namespace twinbench::investigate
