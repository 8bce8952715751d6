#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/twin_fit.h"

namespace twinbench::diagnose::encoder {

/// A search that takes what is large into the twin, one cause after the other, until nothing large is left
/// (large_search.cc), and weighs all of them anew beside the rest (large_review.cc).
class LargeSearch {
 public:
  /// @param targets  Whose errors are free; may be none.
  LargeSearch(const std::vector<Reading>& readings, const Scenario& scenario, const DiagnoseOptions& options,
              const model::FollowMaker& follow, const Eigen::MatrixXd& targets);

  /// @param most_left  Power that the large causes may leave, or the rest is not looked into.
  std::optional<LargeCauses> Go(double most_left = std::numeric_limits<double>::infinity());

 private:
  /// Large causes fitted with what stands beside them free: columns of that, and what both leave.
  struct Beside {
    AskedAgain asked;
    Eigen::MatrixXd columns;
    Eigen::VectorXd left;
  };

  /// An angle device may well have an error of many orders. As long as something large is found, the first few are
  /// enough: what a large cause leaves to first order is explained by shapes that are gone once the twin has it.
  static constexpr int kMostCauses = 8, kFewCauses = 3, kMostOrders = 32;

  AnalysisOptions For(int most_causes) const;
  void Begin();
  void TakeLoopInWalk();
  void TakeSignals();
  void TakeLag();
  void TakeOtherLag();
  void TakeBlock(std::vector<LargeCause> block);
  void TakeLarge();
  bool TakeNext();
  bool TakeOneOfTwoWaves();
  bool Take(const LargeCause& next);
  bool WouldBeDropped(const AskedAgain& asked, std::vector<LargeCause> causes) const;
  bool IsOtherFunctionOfSpeed(const LargeCause& next, const AskedAgain& asked) const;
  bool IsClearlyLess(double power, const Eigen::VectorXd& left) const;
  bool TakeSum(std::size_t k, const LargeCause& more);
  bool SearchOn();
  std::vector<std::string> Excluded(const std::vector<LargeCause>& causes) const;
  void Accept(const AskedAgain& asked, std::vector<LargeCause> causes, int most_causes);
  EncoderRun RunWith(const std::vector<EffectSettings>& effects) const;
  std::unique_ptr<Searched> SearchWith(const AskedAgain& asked, const std::vector<LargeCause>& causes,
                                       const AnalysisOptions& how) const;

  void Review();
  void WeighWritten();
  void LeaveToLarge();
  double LeastExplained() const;
  Eigen::VectorXd Left(const Eigen::VectorXd& beside) const;
  bool IsChance(const Term& term, const Eigen::VectorXd& left) const;
  SecondOrder Bent() const;
  void DropNeedless();
  std::vector<double> Strengths(const std::vector<LargeCause>& causes) const;
  std::vector<double> Strengths(const std::vector<LargeCause>& causes, const Eigen::VectorXd& rows) const;
  void SearchPlain();
  void EndTies();
  void JudgeUnsure();
  std::vector<Cause> InPlaceOf(std::size_t k) const;
  std::vector<Term*> NamedTerms();
  Beside AskBeside(const std::vector<LargeCause>& causes);
  double MemoryOfLoop(const Eigen::VectorXd& shown, const Eigen::VectorXd& left, double memory) const;
  void MoveBesideTheRest();
  std::vector<EffectSettings> OthersLike(const EffectSettings& effect) const;
  bool TakeOther();
  bool Straighten();
  bool TakeInstead(std::vector<LargeCause> causes);
  Eigen::VectorXd LeftByTerms(const Cause* but = nullptr) const;
  void TellWhatEachShows();
  void TellWhatNamesLeave();

  /// An effect of the scenario that a diagnosis wrote, and the power that it explains.
  struct Written {
    EffectSettings effect;
    double explained;
  };

  const std::vector<Reading>& readings_;
  const Scenario& scenario_;
  const DiagnoseOptions& options_;
  const model::FollowMaker& follow_;
  AnalysisOptions how_;
  NullCalibration null_;
  LargeCauses large_;
  int most_searched_ = kFewCauses;  // causes that the last search might take
  std::optional<TwinFit> fit_;
  std::vector<Written> written_;
  Eigen::MatrixXd slopes_;  // of the large causes, as the last search left them free
  double power_ = 0.0;
};

}  // namespace twinbench::diagnose::encoder
