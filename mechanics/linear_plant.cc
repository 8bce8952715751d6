#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "mechanics/drive_loads.h"
#include "mechanics/drives.h"
#include "mechanics/sag.h"

namespace twinbench::mechanics {
namespace {

// Longer moves are rare and would need much memory (1 MB a second): they are computed as they happen.
constexpr double kLongestKept_s = 2.0;

constexpr double kCreep = 5e-10;  // rad/s, m/s

/// State of the stack as a sum: responses of moves from rest, each known beforehand, and whatever does not fit that
/// form, which is advanced period by period.
class LinearPlant : public DrivenPlant {
 public:
  explicit LinearPlant(const StackParameters& p)
      : DrivenPlant(p), model_(p), rest_(p, model_), loaded_(HasLoads(p)), superposable_(!loaded_) {
    for (const TableParameters& table : p.table) {
      const bool rubs = table.friction.coulomb_Nm > 0.0 || table.friction.viscous_Nm_s > 0.0;
      if (rubs || table.scale.active()) superposable_ = false;
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
    if (commands().Ended(0, time) && commands().Ended(1, time)) driven_ = false;
    if (driven_) {
      rest_.Step(CommandAt(time));
    } else if (rest_alive_) {
      LetRestDecay(time);
    }
  }

  PeriodCommand CommandAt(Nanoseconds time) const {
    PeriodCommand command = commands().Period(time, period());
    if (!loaded_) return command;
    const ProfilePoint target = commands().At(0, time + period() / 2);
    const ProfilePoint reference = commands().At(1, time + period() / 2);
    const std::array<double, 2> azimuth_rad = AzimuthsAt(target.position_rad, reference.position_rad);
    command.load = Turned(DriveLoads(parameters(), {target.position_rad, reference.position_rad},
                                     {target.velocity_rad_s, reference.velocity_rad_s}),
                          {-azimuth_rad[0], -azimuth_rad[1]});
    return command;
  }

  /// Of the payload, in the laboratory and on the reference's body.
  std::array<double, 2> AzimuthsAt(double target_rad, double reference_rad) const {
    const double on_body_rad = reference_rad + parameters().payload.azimuth_rad;
    return {on_body_rad + parameters().geometry.reseat_rad + target_rad, on_body_rad};
  }

  void LetRestDecay(Nanoseconds time) {
    rest_.Step(superposable_ ? PeriodCommand{} : CommandAt(time));
    if (!superposable_) return;
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
    for (const Contribution& c : contributions_) AddTo(rest_, c);
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

  Vector12 Coordinates(Nanoseconds time, Nanoseconds since) const override {
    if (since > 0 && IsAlive()) return CoordinatesWithin(time, since);
    Vector12 deviation = rest_.state().head<kCoordinates>();
    for (const Contribution& c : contributions_) {
      deviation += c.response->At(c.tick, c.shapes).head<kCoordinates>();
    }
    return deviation;
  }

  bool IsAlive() const {
    return rest_alive_ || std::any_of(contributions_.begin(), contributions_.end(),
                                      [](const Contribution& c) { return c.tick < c.response->size(); });
  }

  Vector12 CoordinatesWithin(Nanoseconds time, Nanoseconds since) const {
    if (!propagator_) propagator_.emplace(parameters());
    LinearStack all = rest_;
    for (const Contribution& c : contributions_) AddTo(all, c);
    return all.Within(CommandAt(time), commands().Period(time, since), *propagator_, ToSeconds(since))
        .head<kCoordinates>();
  }

  static void AddTo(LinearStack& stack, const Contribution& c) {
    const MoveResponse::Row row = c.response->At(c.tick, c.shapes);
    stack.Add(row.head<2 * kCoordinates>(), row.tail<2>());
  }

  std::array<BearingPose, 2> Bearings(const Vector12& deviation, double target_rad,
                                      double reference_rad) const override {
    Vector12 q = constant_sag_ ? *constant_sag_ : StaticDeflection(parameters(), target_rad, reference_rad);
    const std::array<double, 2> azimuth_rad = AzimuthsAt(target_rad, reference_rad);
    AddTurned(deviation, 0, azimuth_rad[0], q);
    AddTurned(deviation, 1, azimuth_rad[1], q);
    return {BearingOf(q, 0), BearingOf(q, 1)};
  }

  /// Friction leaves a remainder that creeps on; what is slower than a ten thousandth of an arcsecond a second
  /// stands.
  bool CanRest() const override {
    return !rest_alive_ || (!superposable_ && rest_.state().tail<kCoordinates>().cwiseAbs().maxCoeff() < kCreep);
  }

  void Rest(std::int64_t periods) override {
    for (Contribution& c : contributions_) {
      c.tick = static_cast<int>(std::min<std::int64_t>(c.tick + periods, c.response->size()));
    }
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
  mutable std::optional<StackPropagator> propagator_;  // made when somebody first looks into a period
  LinearStack rest_;
  std::map<double, MoveResponse> responses_;  // by duration
  std::vector<Contribution> contributions_;
  std::optional<Vector12> constant_sag_;
  bool loaded_;
  bool superposable_;
  bool launching_ = false;
  bool driven_ = false;      // rest_ is told the commands of the running moves
  bool rest_alive_ = false;  // rest_ still decays
};

}  // namespace

std::unique_ptr<Plant> MakeLinearPlant(const StackParameters& parameters) {
  return std::make_unique<LinearPlant>(parameters);
}

}  // namespace twinbench::mechanics
