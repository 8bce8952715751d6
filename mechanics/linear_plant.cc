#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "mechanics/drives.h"
#include "mechanics/sag.h"

namespace twinbench::mechanics {
namespace {

// Longer moves are rare and would need much memory (1 MB a second): they are computed as they happen.
constexpr double kLongestKept_s = 2.0;

/// State of the stack as a sum: responses of moves from rest, each known beforehand, and whatever does not fit that
/// form, which is advanced period by period.
class LinearPlant : public DrivenPlant {
 public:
  explicit LinearPlant(const StackParameters& p) : DrivenPlant(p), model_(p), rest_(p, model_) {
    for (const TableParameters& table : p.table) {
      if (table.friction.coulomb_Nm > 0.0 || table.friction.viscous_Nm_s > 0.0) superposable_ = false;
    }
    OnMount();
  }

 private:
  struct Contribution {
    const MoveResponse* response;
    MoveResponse::Shapes shapes;
    int tick;
  };

  void OnStart() override { launching_ = true; }

  void OnMount() override {
    constant_sag_.reset();
    if (SagIsConstant(parameters())) constant_sag_ = StaticDeflection(parameters(), 0.0, 0.0);
  }

  void Step(Nanoseconds time) override {
    if (launching_) Launch(time);
    for (Contribution& contribution : contributions_) ++contribution.tick;
    if (driven_) {
      rest_.Step(commands().Period(time, period()));
    } else if (rest_alive_) {
      LetRestDecay();
    }
  }

  void LetRestDecay() {
    rest_.Step(PeriodCommand{});
    if (rest_.state().cwiseAbs().maxCoeff() > 1e-14) return;  // rad, rad/s; 1e-14 rad is 2e-9 arcsec
    rest_ = LinearStack(parameters(), model_);
    rest_alive_ = false;
  }

  /// Decides how the moves that have just started are computed.
  void Launch(Nanoseconds time) {
    launching_ = false;
    std::erase_if(contributions_, [](const Contribution& c) { return c.tick >= c.response->size(); });
    if (const std::optional<double> duration_s = CommonDuration(time)) {
      const MoveResponse& response = ResponseFor(*duration_s);
      const MoveResponse::Shapes shapes = ShapesAt(time);
      if (WithinLimits(response.TorqueBound_Nm(shapes))) {
        driven_ = false;
        contributions_.push_back({&response, shapes, 0});
        return;
      }
    }
    for (const Contribution& c : contributions_) {
      const MoveResponse::Row row = c.response->At(c.tick, c.shapes);
      rest_.Add(row.head<2 * kCoordinates>(), row.tail<2>());
    }
    contributions_.clear();
    driven_ = rest_alive_ = true;
  }

  bool StartsAt(std::size_t axis, Nanoseconds time) const {
    return commands().start(axis) == time && !commands().Ended(axis, time);
  }

  /// Duration of the moves that start at `time`, if they are alike, nothing else moves and superposition holds.
  std::optional<double> CommonDuration(Nanoseconds time) const {
    if (!superposable_) return std::nullopt;
    std::optional<double> duration_s;
    for (std::size_t i = 0; i < 2; ++i) {
      if (commands().Ended(i, time)) continue;
      const double own_s = commands().profile(i).duration_s();
      if (!commands().profile(i).from_rest()) return std::nullopt;
      if (!StartsAt(i, time) || own_s > kLongestKept_s || own_s != duration_s.value_or(own_s)) return std::nullopt;
      duration_s = own_s;
    }
    return duration_s;
  }

  MoveResponse::Shapes ShapesAt(Nanoseconds time) const {
    const double t = StartsAt(0, time) ? commands().profile(0).travel_rad() : 0.0;
    const double r = StartsAt(1, time) ? commands().profile(1).travel_rad() : 0.0;
    return (MoveResponse::Shapes() << t, r, t * t, t * r, r * r).finished();
  }

  bool WithinLimits(const Eigen::Vector2d& torque_Nm) const {
    return torque_Nm[0] < parameters().table[0].torque_limit_Nm &&
           torque_Nm[1] < parameters().table[1].torque_limit_Nm;
  }

  const MoveResponse& ResponseFor(double duration_s) {
    const auto known = responses_.find(duration_s);
    if (known != responses_.end()) return known->second;
    return responses_.emplace(duration_s, MoveResponse(parameters(), model_, duration_s)).first->second;
  }

  Eigen::Vector2d Deviation_rad() const override {
    Eigen::Vector2d deviation(rest_.state()[SpinIndex(0)], rest_.state()[SpinIndex(1)]);
    for (const Contribution& c : contributions_) {
      for (int t = 0; t < 2; ++t) deviation[t] += c.response->At(c.tick, c.shapes, SpinIndex(t));
    }
    return deviation;
  }

  Vector12 Deviation() const {
    Vector12 deviation = rest_.state().head<kCoordinates>();
    for (const Contribution& c : contributions_) {
      deviation += c.response->At(c.tick, c.shapes).head<kCoordinates>();
    }
    return deviation;
  }

  std::array<BearingPose, 2> Bearings(double target_rad, double reference_rad) const override {
    Vector12 q = constant_sag_ ? *constant_sag_ : StaticDeflection(parameters(), target_rad, reference_rad);
    const Vector12 deviation = Deviation();
    const double on_body_rad = reference_rad + parameters().payload.azimuth_rad;
    const double in_lab_rad = on_body_rad + parameters().geometry.reseat_rad + target_rad;
    AddTurned(deviation, 0, in_lab_rad, q);
    AddTurned(deviation, 1, on_body_rad, q);
    return {BearingOf(q, 0), BearingOf(q, 1)};
  }

  /// Turns a bearing's deviation from the payload's axes into its stator's.
  static void AddTurned(const Vector12& deviation, int table, double azimuth_rad, Vector12& q) {
    const int i = kPerTable * table;
    const Eigen::Rotation2Dd turn(azimuth_rad);
    q.segment<2>(i) += turn * Eigen::Vector2d(deviation.segment<2>(i));
    q[i + 2] += deviation[i + 2];
    q.segment<2>(i + 3) += turn * Eigen::Vector2d(deviation.segment<2>(i + 3));
  }

  LinearModel model_;
  LinearStack rest_;
  std::map<double, MoveResponse> responses_;  // by duration
  std::vector<Contribution> contributions_;
  std::optional<Vector12> constant_sag_;
  bool superposable_ = true;
  bool launching_ = false;
  bool driven_ = false;      // rest_ is told the commands of the running moves
  bool rest_alive_ = false;  // rest_ still decays
};

}  // namespace

std::unique_ptr<Plant> MakeLinearPlant(const StackParameters& parameters) {
  return std::make_unique<LinearPlant>(parameters);
}

}  // namespace twinbench::mechanics
