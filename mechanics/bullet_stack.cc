#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <cmath>

#include "mechanics/drive_loads.h"
#include "mechanics/matrices.h"
#include "mechanics/stack.h"

// A float build of Bullet would add 0.02 arcsec of noise, and mixing the two corrupts memory.
static_assert(sizeof(btScalar) == 8, "link bullet-float64");

namespace twinbench::mechanics {
namespace {

const btQuaternion kNoTurn(0.0, 0.0, 0.0, 1.0);

btVector3 ToBullet(const Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

btQuaternion ToBullet(const Matrix3& rotation) {
  const Eigen::Quaterniond q(rotation);
  return {q.x(), q.y(), q.z(), q.w()};
}

Pose FromBullet(const btTransform& transform) {
  const btMatrix3x3& m = transform.getBasis();
  Pose pose = Pose::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) pose.linear()(r, c) = m[r][c];
    pose.translation()[r] = transform.getOrigin()[r];
  }
  return pose;
}

}  // namespace

/// The multibody: per table three prismatic and two revolute massless links of the bearing, then the rotor; the
/// housing and the payload as fixed links. It never joins a Bullet world: no contacts, solver, sleeping or damping.
struct StackDynamics::Bullet {
  explicit Bullet(const StackParameters& p)
      : gravity_m_s2(p.gravity_m_s2),
        body(p.payload.mass_kg > 0.0 ? 14 : 13, 0.0, btVector3(0, 0, 0), true, false) {
    body.setLinearDamping(0.0);
    body.setAngularDamping(0.0);
    body.setMaxCoordinateVelocity(1e6);
    const ChainGeometry& g = p.geometry;
    AddTable(0, -1, -g.p_RG_m - Vector3(0.0, 0.0, g.reference_height_m), p.table[0].rotor);
    AddHousing(g, p);
    const Vector3 housing_com(0.0, 0.0, p.housing.height_m);
    AddTable(1, kHousingLink, -housing_com, p.table[1].rotor);
    if (p.payload.mass_kg > 0.0) AddPayload(p);
    body.finalizeMultiDof();
  }

  static constexpr int kHousingLink = 6;
  static constexpr int kPayloadLink = 13;
  static int Link(int coordinate) { return coordinate < kPerTable ? coordinate : coordinate + 1; }

  /// `pivot` is the table's origin seen from the parent link's centre of mass.
  void AddTable(int table, int parent, const Vector3& pivot, const SymmetricBody& rotor) {
    const int first = Link(kPerTable * table);
    const btVector3 none(0, 0, 0);
    const btVector3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; ++i) {
      body.setupPrismatic(first + i, 0.0, none, i == 0 ? parent : first + i - 1, kNoTurn, axes[i],
                          i == 0 ? ToBullet(pivot) : none, none, true);
    }
    for (int i = 0; i < 2; ++i) {
      body.setupRevolute(first + 3 + i, 0.0, none, first + 2 + i, kNoTurn, axes[i], none, none, true);
    }
    const double across = rotor.transverse_inertia_kg_m2;
    rotor_com_m[table] = rotor.height_m;
    body.setupRevolute(first + kSpin, rotor.mass_kg, {across, across, rotor.axial_inertia_kg_m2}, first + kSpin - 1,
                       kNoTurn, axes[2], none, {0.0, 0.0, rotor.height_m}, true);
  }

  void AddHousing(const ChainGeometry& g, const StackParameters& p) {
    const Pose X_TS = BodyOnTarget(g);
    const Vector3 pivot = X_TS.translation() - Vector3(0.0, 0.0, p.table[0].rotor.height_m);
    const double across = p.housing.transverse_inertia_kg_m2;
    body.setupFixed(kHousingLink, p.housing.mass_kg, {across, across, p.housing.axial_inertia_kg_m2}, kSpin,
                    ToBullet(Matrix3(X_TS.linear().transpose())), ToBullet(pivot), {0.0, 0.0, p.housing.height_m});
  }

  void AddPayload(const StackParameters& p) {
    const double inertia = p.payload.inertia_kg_m2;
    const Vector3 p_RP(p.payload.radius_m * std::cos(p.payload.azimuth_rad),
                       p.payload.radius_m * std::sin(p.payload.azimuth_rad),
                       p.payload.height_m - p.table[1].rotor.height_m);
    body.setupFixed(kPayloadLink, p.payload.mass_kg, {inertia, inertia, inertia}, Link(SpinIndex(1)), kNoTurn,
                    ToBullet(p_RP), {0.0, 0.0, 0.0});
  }

  void Set(const Vector12& q, const Vector12& qd) {
    for (int i = 0; i < kCoordinates; ++i) {
      body.setJointPos(Link(i), q[i]);
      body.setJointVel(Link(i), qd[i]);
    }
  }

  void AddWeight() {
    for (int l = 0; l < body.getNumLinks(); ++l) {
      const double mass_kg = body.getLinkMass(l);
      if (mass_kg > 0.0) body.addLinkForce(l, {0.0, 0.0, -gravity_m_s2 * mass_kg});
    }
  }

  /// Runs the articulated-body algorithm with a step of zero, which leaves the state alone. The accelerations stand
  /// in Bullet's scratch memory behind its dofs and the base's six; a test pins that layout.
  Vector12 Solve(const Vector12& force, bool weight) {
    for (int i = 0; i < kCoordinates; ++i) body.addJointTorque(Link(i), force[i]);
    if (weight) AddWeight();
    body.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0.0, numbers, vectors, matrices, false, false, false);
    body.clearForcesAndTorques();
    return Eigen::Map<const Vector12>(&numbers[body.getNumDofs() + 6]);
  }

  double gravity_m_s2;
  double rotor_com_m[2] = {0.0, 0.0};
  btMultiBody body;
  btAlignedObjectArray<btScalar> numbers;
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btMatrix3x3> matrices;
};

StackDynamics::StackDynamics(const StackParameters& parameters)
    : parameters_((Check(parameters), parameters)),
      stiffness_(BearingStiffness(parameters)),
      damping_(BearingDamping(parameters)),
      preload_(BearingPreload(parameters)),
      loaded_(HasLoads(parameters)),
      bullet_(std::make_unique<Bullet>(parameters)) {}

StackDynamics::~StackDynamics() = default;
StackDynamics::StackDynamics(StackDynamics&&) noexcept = default;
StackDynamics& StackDynamics::operator=(StackDynamics&&) noexcept = default;

Vector12 StackDynamics::Accelerate(const Vector12& q, const Vector12& qd, const Eigen::Vector2d& torque_Nm) {
  Vector12 force = preload_ - stiffness_.cwiseProduct(q) - damping_.cwiseProduct(qd);
  force[SpinIndex(0)] = torque_Nm[0];
  force[SpinIndex(1)] = torque_Nm[1];
  if (loaded_) {
    force += DriveLoads(parameters_, {q[SpinIndex(0)], q[SpinIndex(1)]}, {qd[SpinIndex(0)], qd[SpinIndex(1)]});
  }
  bullet_->Set(q, qd);
  return bullet_->Solve(force, true);
}

Vector12 StackDynamics::AccelerateFreely(const Vector12& q, const Vector12& qd, const Vector12& force) {
  bullet_->Set(q, qd);
  return bullet_->Solve(force, false);
}

Matrix12 StackDynamics::InverseMass(const Vector12& q) {
  AccelerateFreely(q, Vector12::Zero(), Vector12::Zero());  // fills the articulated inertias that the deltas need
  Matrix12 inverse;
  for (int i = 0; i < kCoordinates; ++i) {
    double force[6 + kCoordinates] = {};
    double answer[6 + kCoordinates] = {};
    force[6 + i] = 1.0;
    bullet_->body.calcAccelerationDeltasMultiDof(force, answer, bullet_->numbers, bullet_->vectors);
    inverse.col(i) = Eigen::Map<const Vector12>(answer + 6);
  }
  return 0.5 * (inverse + inverse.transpose());
}

void StackDynamics::Step(double h, const Eigen::Vector2d& torque_Nm, Vector12& q, Vector12& qd) {
  const Vector12 a1 = Accelerate(q, qd, torque_Nm);
  const Vector12 v2 = qd + 0.5 * h * a1;
  const Vector12 a2 = Accelerate(q + 0.5 * h * qd, v2, torque_Nm);
  const Vector12 v3 = qd + 0.5 * h * a2;
  const Vector12 a3 = Accelerate(q + 0.5 * h * v2, v3, torque_Nm);
  const Vector12 v4 = qd + h * a3;
  const Vector12 a4 = Accelerate(q + h * v3, v4, torque_Nm);
  q += h / 6.0 * (qd + 2.0 * v2 + 2.0 * v3 + v4);
  qd += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
}

Pose StackDynamics::BulletRotorPose(const Vector12& q, int table) {
  bullet_->Set(q, Vector12::Zero());
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> origins;
  bullet_->body.forwardKinematics(turns, origins);
  const Pose com = FromBullet(bullet_->body.getLink(Bullet::Link(SpinIndex(table))).m_cachedWorldTransform);
  return com * Eigen::Translation3d(0.0, 0.0, -bullet_->rotor_com_m[table]);
}

double StackDynamics::Energy(const Vector12& q, const Vector12& qd) {
  const auto potential = [this](const Vector12& at) {
    BulletRotorPose(at, 0);
    double sum = 0.0;
    for (int l = 0; l < bullet_->body.getNumLinks(); ++l) {
      sum += bullet_->body.getLinkMass(l) * bullet_->body.getLink(l).m_cachedWorldTransform.getOrigin().z();
    }
    return parameters_.gravity_m_s2 * sum;
  };
  const double weight = potential(q) - potential(Vector12::Zero());
  const double springs = 0.5 * q.dot(stiffness_.cwiseProduct(q)) - preload_.dot(q);
  return weight + springs + 0.5 * qd.dot(InverseOf(InverseMass(q)) * qd);
}

}  // namespace twinbench::mechanics
