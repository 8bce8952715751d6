#include "optics/scene.h"

#include <gmock/gmock.h>

#include <random>

#include "optics/kernels.h"

namespace twinbench::optics {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

constexpr double kSame_m = 1e-12;  // 1e-9 mm, the accuracy demanded of every path through a scene

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vector3d Cube(double half) { return {Uniform(-half, half), Uniform(-half, half), Uniform(-half, half)}; }
  Vector3d Unit() { return (Cube(1.0) + Vector3d(0, 0, 1e-9)).normalized(); }
  Isometry3d Pose(double half) {
    Isometry3d X(Eigen::AngleAxisd(Uniform(0.0, 3.1), Unit()));
    X.translation() = Cube(half);
    return X;
  }

 private:
  std::mt19937_64 random_;
};

/// Planes and curved mirrors of all kinds, anywhere, also through each other.
Scene RandomScene(Dice& dice, int surfaces, const std::string& embree_options = "") {
  Scene scene(embree_options);
  for (int i = 0; i < surfaces; ++i) {
    const Isometry3d X = dice.Pose(0.2);
    const double size = dice.Uniform(0.01, 0.1);
    if (i % 4 == 0) scene.AddSurface(RectangularPlane(X, size, 2.0 * size));
    if (i % 4 == 1) scene.AddSurface(CircularPlane(X, size));
    if (i % 4 == 2) scene.AddSurface(Sphere(X, i % 8 < 4 ? 0.2 : -0.15, size));
    if (i % 4 == 3) scene.AddSurface(Paraboloid(X, 0.1, size));
  }
  scene.Commit();
  return scene;
}

RayBatch RaysAt(Dice& dice, const Scene& scene, int count) {
  RayBatch rays;
  for (int i = 0; i < count; ++i) {
    const Surface& s = scene.surfaces()[static_cast<std::size_t>(i) % scene.surfaces().size()];
    const Vector3d from = dice.Cube(0.4);
    const Vector3d to = s.X_WS * Vector3d(dice.Uniform(-0.1, 0.1), dice.Uniform(-0.1, 0.1), 0.0);
    rays.Add({from, (to - from).normalized()});
  }
  return rays;
}

/// Rays that pass an aperture's edge at `miss_m` or less, inside or outside.
RayBatch RaysAtEdges(Dice& dice, const Scene& scene, int count, double miss_m) {
  RayBatch rays;
  for (int i = 0; i < count; ++i) {
    const Surface& s = scene.surfaces()[static_cast<std::size_t>(i) % scene.surfaces().size()];
    const double off = dice.Uniform(-miss_m, miss_m);
    double x = s.half_x_m + off, y = dice.Uniform(-s.half_y_m, s.half_y_m);
    if (std::isfinite(s.radius_m)) {
      const double angle = dice.Uniform(0.0, 6.2);
      x = (s.radius_m + off) * std::cos(angle);
      y = (s.radius_m + off) * std::sin(angle);
    }
    const Vector3d to = Point(s, x, y);
    const Vector3d from = to + 0.3 * (Normal(s, x, y) + 0.5 * dice.Cube(1.0)).normalized();
    rays.Add({from, (to - from).normalized()});
  }
  return rays;
}

int ExpectSame(const HitBatch& a, const HitBatch& b) {
  int hits = 0;
  for (std::size_t i = 0; i < a.surface.size(); ++i) {
    EXPECT_EQ(a.surface[i], b.surface[i]) << "ray " << i << " t " << a.t_m[i] << " " << b.t_m[i];
    if (a.surface[i] < 0 || a.surface[i] != b.surface[i]) continue;
    ++hits;
    EXPECT_NEAR(a.t_m[i], b.t_m[i], kSame_m);
    EXPECT_NEAR(a.x_m[i], b.x_m[i], kSame_m);
    EXPECT_NEAR(a.y_m[i], b.y_m[i], kSame_m);
  }
  return hits;
}

HitBatch HitsOf(const Scene& scene, const RayBatch& rays) {
  HitBatch hits;
  scene.Intersect(rays, hits);
  return hits;
}

HitBatch AnalyticHitsOf(const Scene& scene, const RayBatch& rays) {
  HitBatch hits;
  scene.IntersectAnalytic(rays, hits);
  return hits;
}

std::ptrdiff_t CountOf(int surface, const HitBatch& hits) { return std::ranges::count(hits.surface, surface); }

void ExpectEveryPathAgrees(const Scene& scene, const RayBatch& rays, int least_hits) {
  EXPECT_GE(ExpectSame(HitsOf(scene, rays), AnalyticHitsOf(scene, rays)), least_hits);
}

TEST(Scene, EmbreeAndAnalyticPathsAgreeInRandomScenesAndAtApertureEdges) {
  for (const int surfaces : {1, 3, 5, 8, 20}) {
    Dice dice(static_cast<unsigned>(surfaces));
    const Scene scene = RandomScene(dice, surfaces);
    ExpectEveryPathAgrees(scene, RaysAt(dice, scene, 5003), 50);
  }
  for (const double miss_m : {10e-6, 0.1e-6, 1e-9}) {
    Dice dice(7);
    const Scene scene = RandomScene(dice, 12);
    ExpectEveryPathAgrees(scene, RaysAtEdges(dice, scene, 8000, miss_m), 3000);
  }
}

TEST(Scene, TellsSurfacesApartThatFloatCannot) {
  // Two plates 10 nm apart, and one that crosses both.
  Scene scene;
  Isometry3d X = Isometry3d::Identity();
  scene.AddSurface(RectangularPlane(X, 0.1, 0.1));
  X.translation().z() = 10e-9;
  scene.AddSurface(RectangularPlane(X, 0.1, 0.1));
  scene.AddSurface(RectangularPlane(Isometry3d(Eigen::AngleAxisd(0.3, Vector3d::UnitX())), 0.1, 0.1));
  scene.Commit();
  Dice dice(8);
  RayBatch rays;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d to(dice.Uniform(-0.04, 0.04), dice.Uniform(-1e-7, 1e-7), 0.0);
    rays.Add({{0, 0, i % 2 ? 0.3 : -0.3}, (to - Vector3d(0, 0, i % 2 ? 0.3 : -0.3)).normalized()});
  }
  ExpectEveryPathAgrees(scene, rays, 4000);
}

TEST(Scene, NoRaySlipsThroughTheDiagonalOfAProxy) {
  Scene scene;
  scene.AddSurface(RectangularPlane(Isometry3d(Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized())), 0.1, 0.06));
  scene.Commit();
  const Surface& s = scene.surfaces()[0];
  Dice dice(9);
  RayBatch rays;
  for (int i = 0; i < 100000; ++i) {
    const double along = dice.Uniform(-0.99, 0.99), off = dice.Uniform(-30e-9, 30e-9);
    const Vector3d to = s.X_WS * Vector3d(0.05 * along, 0.03 * along + off, 0.0);
    const Vector3d from = s.X_WS * Vector3d(0.02, 0.01, 0.3);
    rays.Add({from, (to - from).normalized()});
  }
  EXPECT_EQ(CountOf(0, HitsOf(scene, rays)), 100000);
}

TEST(Scene, RaysThatStartOnASurfaceDoNotMeetItAgain) {
  Dice dice(10);
  const Scene scene = RandomScene(dice, 6);
  RayBatch rays;
  for (int i = 0; i < 3000; ++i) {
    const Surface& s = scene.surfaces()[static_cast<std::size_t>(i) % 4 == 1 ? 1 : 0];  // planes
    const Vector3d from = s.X_WS * Vector3d(0.3 * s.half_x_m, dice.Uniform(-0.5, 0.5) * s.half_y_m, 0.0);
    rays.Add({from, (s.X_WS.linear().col(2) + 0.8 * dice.Cube(1.0)).normalized()});
  }
  const HitBatch hits = HitsOf(scene, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_NE(hits.surface[i], i % 4 == 1 ? 1 : 0);
  ExpectEveryPathAgrees(scene, rays, 1);
}

TEST(Scene, AMeshBlocksWhatIsBehindIt) {
  Scene scene;
  scene.AddSurface(RectangularPlane(Isometry3d::Identity(), 0.2, 0.2));
  Isometry3d X_WM = Isometry3d::Identity();
  X_WM.translation() = Vector3d(0.05, 0, 0.1);
  const int box = scene.AddMesh(BoxMesh({-0.02, -0.02, -0.01}, {0.02, 0.02, 0.01}), X_WM);
  scene.Commit();
  RayBatch rays;
  rays.Add({{0.05, 0.0, 0.3}, {0, 0, -1}});   // onto the box
  rays.Add({{-0.05, 0.0, 0.3}, {0, 0, -1}});  // beside it
  rays.Add({{0.05, 0.0, 0.05}, {0, 0, -1}});  // starts below it
  const HitBatch hits = HitsOf(scene, rays);
  EXPECT_THAT(hits.surface, testing::ElementsAre(kFixture, 0, 0));
  EXPECT_NEAR(hits.t_m[0], 0.19, 1e-7);  // float
  ExpectEveryPathAgrees(scene, rays, 2);
  EXPECT_TRUE(scene.Occluded({0.05, 0, 0.3}, {0.05, 0, 0.0}));
  EXPECT_FALSE(scene.Occluded({0.05, 0, 0.3}, {0.05, 0, 0.12}));

  X_WM.translation() = Vector3d(-0.05, 0, 0.1);
  scene.SetMeshPose(box, X_WM);
  EXPECT_THROW(HitsOf(scene, rays), std::logic_error);  // not committed
  scene.Commit();
  EXPECT_THAT(HitsOf(scene, rays).surface, testing::ElementsAre(0, kFixture, 0));
}

TEST(Scene, ANewPoseIsAsGoodAsANewSceneAndAScatteredOrderChangesNothing) {
  Dice dice(12);
  Scene moved = RandomScene(dice, 9);
  Scene fresh;
  for (int i = 0; i < 9; ++i) {
    Surface s = moved.surfaces()[static_cast<std::size_t>(i)];
    s.X_WS = dice.Pose(0.2);
    moved.SetSurfacePose(i, s.X_WS);
    fresh.AddSurface(s);
  }
  moved.Commit();
  fresh.Commit();
  const RayBatch rays = RaysAt(dice, fresh, 3000);
  HitBatch a = HitsOf(moved, rays);
  const HitBatch b = HitsOf(fresh, rays);
  EXPECT_EQ(a.surface, b.surface);
  EXPECT_EQ(a.t_m, b.t_m);
  moved.Intersect(rays, a, RayOrder::kScattered);
  EXPECT_EQ(a.surface, b.surface);
  ExpectEveryPathAgrees(moved, rays, 500);
}

/// Every ray of a batch has the bits that it has alone: no contraction, one formula. @return how many met a
/// fixture.
int ExpectBitsOfOneRay(const RayBatch& rays, const HitBatch& hits,
                       const std::function<NearestHit(const Ray&)>& alone) {
  int fixtures = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const NearestHit one = alone(rays.At(i));
    EXPECT_EQ(one.index, hits.surface[i]) << "ray " << i;
    fixtures += one.index == kFixture;
    if (one.index < 0 || one.index != hits.surface[i]) continue;
    EXPECT_EQ(one.hit.t_m, hits.t_m[i]) << "ray " << i;
    EXPECT_EQ(one.hit.x_m, hits.x_m[i]) << "ray " << i;
    EXPECT_EQ(one.hit.y_m, hits.y_m[i]) << "ray " << i;
  }
  return fixtures;
}

std::function<NearestHit(const Ray&)> NearestOf(const Scene& scene) {
  std::vector<Frame> frames;
  for (const Surface& surface : scene.surfaces()) frames.push_back(MakeFrame(surface));
  return [frames](const Ray& ray) { return Nearest(frames, ray, Scene::t_min_m); };
}

TEST(Scene, OneRayAndManyRaysGiveTheSameBits) {
  Dice dice(14);
  Scene scene = RandomScene(dice, 12);
  const RayBatch without = RaysAt(dice, scene, 1000);
  ExpectBitsOfOneRay(without, AnalyticHitsOf(scene, without), NearestOf(scene));
  scene.AddMesh(BoxMesh({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}), dice.Pose(0.1));
  scene.Commit();
  int fixtures = 0;
  for (const RayBatch& rays : {RaysAt(dice, scene, 2000), RaysAtEdges(dice, scene, 2000, 1e-7)})
    fixtures += ExpectBitsOfOneRay(rays, HitsOf(scene, rays), [&](const Ray& ray) { return scene.First(ray); });
  EXPECT_GT(fixtures, 50);
}

/// Planes that stand apart, as a bench has them: beams on them take the path that settles many packets at once.
Scene Ring(int planes, const std::string& embree_options = "") {
  Scene scene(embree_options);
  for (int i = 0; i < planes; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / planes;
    scene.AddSurface(
        RectangularPlane(Isometry3d(Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * Eigen::Translation3d(0.2, 0, 0) *
                                    Eigen::AngleAxisd(-1.3, Vector3d::UnitY())),
                         0.025, 0.025));
  }
  scene.Commit();
  return scene;
}

/// Beams on the planes of a ring one after the other, wide enough that each is clipped.
RayBatch BeamsOnto(Dice& dice, const Scene& scene, int count) {
  RayBatch rays;
  for (int i = 0; i < count; ++i) {
    const std::size_t plane =
        static_cast<std::size_t>(i) * scene.surfaces().size() / static_cast<std::size_t>(count);
    const Isometry3d& X = scene.surfaces()[plane].X_WS;
    // One ray in twenty aims at the edge or beyond it.
    const double reach = i % 20 == 0 ? 0.015 : 0.010;
    const Vector3d to = X * Vector3d(dice.Uniform(-reach, reach), dice.Uniform(-reach, reach), 0.0);
    const Vector3d from = dice.Cube(1e-3);
    rays.Add({from, (to - from).normalized()});
  }
  return rays;
}

TEST(Scene, BeamsOntoPlanesApartHaveTheBitsOfOneRayAlsoWhereTheyChangeThePlaneWithinAPacket) {
  const Scene scene = Ring(7);
  for (const std::size_t length : {800u, 3u, 5u, 21u, 37u}) {  // of one beam; packets have 8 or 16 rays
    Dice dice(length == 800u ? 15 : 19);
    const RayBatch beams = BeamsOnto(dice, scene, 7 * static_cast<int>(length) + (length == 800u ? 5 : 0));
    RayBatch rays;
    for (std::size_t i = 0; i < (length == 800u ? 1 : 20) * beams.size(); ++i) rays.Add(beams.At(i % beams.size()));
    const HitBatch hits = HitsOf(scene, rays);
    ExpectBitsOfOneRay(rays, hits, NearestOf(scene));
    EXPECT_GT(CountOf(kNothing, hits), length == 800u ? 20 : -1);  // some passed the edges
  }
}

TEST(RayBatch, KeepsItsArraysOnCacheLinesAndLargeOnesApartInThePages) {
  RayBatch rays;
  rays.Resize(1 << 14);
  const RayBatch copy = rays;
  std::set<std::uintptr_t> places;
  for (const Column<double>* array : {&copy.ox, &copy.oy, &copy.oz, &copy.dx, &copy.dy, &copy.dz}) {
    const auto address = reinterpret_cast<std::uintptr_t>(array->data());
    EXPECT_EQ(address % 64, 0u);
    places.insert(address % 4096);
  }
  EXPECT_EQ(places.size(), 6u);
}

TEST(Scene, ABeamSeesTheFixtureThatCutsIntoIt) {
  Dice dice(16);
  Scene scene = Ring(5);
  scene.AddMesh(BoxMesh({0.1, -0.002, -0.002}, {0.11, 0.1, 0.1}), Isometry3d::Identity());
  scene.Commit();
  const RayBatch rays = BeamsOnto(dice, scene, 4000);
  ExpectEveryPathAgrees(scene, rays, 100);
  EXPECT_GT(CountOf(kFixture, HitsOf(scene, rays)), 100);
}

TEST(Scene, NoNaNRayHoldsUpItsPacket) {
  Dice dice(17);
  const Scene scene = Ring(3);
  RayBatch rays = BeamsOnto(dice, scene, 480);
  for (std::size_t i = 7; i < rays.size(); i += 40) rays.dx[i] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(HitsOf(scene, rays).surface, AnalyticHitsOf(scene, rays).surface);
  EXPECT_EQ(HitsOf(scene, rays).surface[7], kNothing);
}

/// Rays along the axes, to and fro in one tile, some that pass exactly along a plane.
RayBatch AxisParallel(Dice& dice, int count) {
  RayBatch rays;
  for (int i = 0; i < count; ++i) {
    Vector3d from = dice.Cube(0.02), direction = Vector3d::Zero();
    if (i % 5 == 0) from = Vector3d(0.0, 0.0, 0.0);
    direction(i % 3) = i % 2 == 0 ? 1.0 : -1.0;
    rays.Add({from, direction});
  }
  return rays;
}

TEST(Scene, MeetsItsPlanesWithRaysAlongTheAxes) {
  Scene scene;
  for (int i = 0; i < 6; ++i) {
    const Vector3d axis = Vector3d::Unit(i % 3) * (i < 3 ? 1.0 : -1.0);
    Isometry3d X(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis));
    X.translation() = 0.1 * axis;
    scene.AddSurface(RectangularPlane(X, 0.03, 0.03));
  }
  scene.Commit();
  Dice dice(18);
  ExpectEveryPathAgrees(scene, AxisParallel(dice, 5003), 2000);
}

/// Embree as older processors run it: packets of 8 instead of 16 among other things.
class SceneOnOldProcessors : public testing::TestWithParam<const char*> {};

TEST_P(SceneOnOldProcessors, GivesTheSameBits) {
  for (const unsigned seed : {20u, 21u}) {
    Dice dice(seed), same_dice(seed);
    const Scene native = seed == 20u ? Ring(9) : RandomScene(dice, 9);
    const Scene old = seed == 20u ? Ring(9, GetParam()) : RandomScene(same_dice, 9, GetParam());
    EXPECT_EQ(old.packet_width(), 8);
    const RayBatch rays = seed == 20u ? BeamsOnto(dice, native, 5003) : RaysAt(dice, native, 5003);
    const HitBatch a = HitsOf(native, rays), b = HitsOf(old, rays);
    EXPECT_EQ(a.surface, b.surface);
    EXPECT_EQ(a.t_m, b.t_m);
    ExpectEveryPathAgrees(old, rays, 500);
  }
}
INSTANTIATE_TEST_SUITE_P(MaxIsa, SceneOnOldProcessors, testing::Values("max_isa=avx2", "max_isa=sse4.2"));

TEST(Scene, RefusesABrokenMesh) {
  Scene scene;
  EXPECT_THROW(scene.AddMesh({{{0, 0, 0}}, {{0, 1, 2}}}, Isometry3d::Identity()), std::invalid_argument);
}

TEST(Scene, MeetsNothingWhereItIsEmptyOrWithARayThatIsNotFinite) {
  Dice dice(12);
  Scene empty;
  empty.Commit();
  RayBatch rays;
  rays.Add({});
  EXPECT_EQ(HitsOf(empty, rays).surface[0], kNothing);
  const Scene scene = RandomScene(dice, 4);
  EXPECT_EQ(scene.First({Vector3d::Zero(), Vector3d::Constant(std::nan(""))}).index, kNothing);
}

}  // namespace
}  // namespace twinbench::optics
