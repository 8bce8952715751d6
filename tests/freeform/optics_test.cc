#include <gtest/gtest.h>

#include <cmath>

#include "optics/scene.h"
#include "tests/freeform/freeform_run.h"
#include "twin/core/errors.h"

// The probe's closed form against the traced scene, and heights that no formula gives.
namespace twinbench::freeform_test {
namespace {

/// One cell, its vertex at the origin. The beam may meet it beyond the middle between two cells.
optics::Scene SceneOfCell(double radius_m) {
  constexpr double kAperture_m = 0.030;
  optics::Scene scene;
  scene.AddSurface(optics::Paraboloid(Pose::Identity(), 0.5 * radius_m, kAperture_m));
  scene.Commit();
  return scene;
}

/// A reading's beam in the frame of its cell, and what the closed form says of it.
struct Beam {
  optics::Ray ray;
  sim::ProbeSpot spot;
  Matrix3 R_FT;
  double start_m = kNaN;  // of the ray, from the tip along the beam
};

Beam BeamOf(const Reading& r, const sim::DrawnBench& bench, const FreeformSettings& settings) {
  constexpr double kBack_m = 0.002;  // the ray starts over the surface, wherever the tip is
  const Pose X_FT = ToolOverArtefact(r, bench, settings);
  const sim::ArtefactCell cell = CellAt(r);
  const Vector3 vertex_F(cell.i * settings.artefact.pitch_m, cell.j * settings.artefact.pitch_m, 0.0);
  Beam beam{{}, sim::Look(settings.artefact, cell, X_FT), X_FT.linear()};
  beam.start_m = std::min(0.0, beam.spot.distance_m) - kBack_m;
  beam.ray.direction = -X_FT.linear().col(2);
  beam.ray.origin_m = X_FT.translation() - vertex_F + beam.start_m * beam.ray.direction;
  return beam;
}

TEST(FreeformOptics, TheTracedSceneAgreesWithTheClosedFormToANanometre) {
  const FreeformSettings settings;
  const sim::DrawnBench bench = OracleBench();
  const std::vector<Reading> readings = OracleRun();
  for (const int parity : {0, 1}) {
    const optics::Scene scene = SceneOfCell(settings.artefact.vertex_radius_m[static_cast<std::size_t>(parity)]);
    std::vector<Beam> beams;
    optics::RayBatch rays;
    for (const Reading& r : readings) {
      if (std::abs(static_cast<int>(kCellI(r) + kCellJ(r))) % 2 != parity) continue;
      beams.push_back(BeamOf(r, bench, settings));
      rays.Add(beams.back().ray);
    }
    ASSERT_GT(beams.size(), 100u);
    optics::HitBatch hits;
    hits.Resize(rays.size());
    scene.Intersect(rays, hits, optics::RayOrder::kScattered);
    for (std::size_t k = 0; k < beams.size(); ++k) {
      const Beam& beam = beams[k];
      ASSERT_EQ(hits.surface[k], 0) << k;
      EXPECT_NEAR(hits.t_m[k] + beam.start_m, beam.spot.distance_m, 1e-9);
      EXPECT_NEAR(hits.x_m[k], beam.spot.hit_F.x(), 1e-9);
      EXPECT_NEAR(hits.y_m[k], beam.spot.hit_F.y(), 1e-9);
      const Vector3 normal = optics::Normal(scene.surfaces().front(), hits.x_m[k], hits.y_m[k]);
      const Vector3 d = beam.ray.direction, reflected = d - 2.0 * d.dot(normal) * normal;
      EXPECT_LT((beam.R_FT.transpose() * reflected - beam.spot.reflected_T).norm(), 1e-10);
    }
  }
}

TEST(FreeformOptics, HeightsComeBackFromTheirFile) {
  const auto tilted = [](double x_m, double y_m) { return 20.0 * x_m - 50.0 * y_m + 1.0; };
  const optics::HeightMap map = optics::ReadHeightMap(WriteHeights("form.exr", tilted));
  for (const auto& [x_m, y_m] : {std::pair{0.0, 0.0}, std::pair{0.0123, -0.0456}, std::pair{-0.1, 0.1}}) {
    const optics::HeightAt at = optics::Interpolate(map, x_m, y_m);
    EXPECT_NEAR(at.height_m / units::um, tilted(x_m, y_m), 1e-5);  // floats in the file
    EXPECT_NEAR(at.slope.x(), 20.0 * units::um, 1e-9);
    EXPECT_NEAR(at.slope.y(), -50.0 * units::um, 1e-9);
  }
}

/// What the scenario with a map shows, without noise and errors, on the course of its procedure.
std::vector<Reading> ShownWith(const std::string& file) {
  const std::string artefact = "[artefact]\nmounting_um = 0.0\nform_error = \"" + file + "\"\n";
  return RunOf(FreeformScenario("noise_free = true\n" + artefact + "[freeform_procedure]\nposes = 30\n"), {});
}

TEST(FreeformOptics, AnArrayThatIsHigherAllOverIsAMountingThatIsHigher) {
  const std::vector<Reading> high = ShownWith(WriteHeights("high.exr", [](double, double) { return 5.0; }));
  const Scenario scenario = FreeformScenario("noise_free = true\n[freeform_procedure]\nposes = 30\n");
  sim::DrawnBench lifted;
  lifted.mountings.assign(4, {0.0, 0.0, 5.0 * units::um, 0.0, 0.0, 0.0});
  const std::vector<Reading> same = RunOf(scenario, lifted);
  for (std::size_t k = 0; k < high.size(); ++k) {
    EXPECT_NEAR(kCcd_px(high[k]), kCcd_px(same[k]), 1e-5);  // floats in the file: 5 um to 0.5 pm
    EXPECT_NEAR(kQpdX_V(high[k]), kQpdX_V(same[k]), 1e-6);
  }
}

TEST(FreeformOptics, AFormErrorThatTheScenarioHasIsNoSurprise) {
  const std::string path =
      WriteHeights("wave.exr", [](double x_m, double y_m) { return std::sin(60.0 * x_m) * std::cos(40.0 * y_m); });
  const std::string more = "[artefact]\nform_error = \"" + path + "\"\n[freeform_procedure]\nposes = 50\n";
  const Scenario scenario = FreeformScenario(more);
  EXPECT_EQ(DiagnosisOf(RunOf(scenario), scenario).verdict, diagnose::Verdict::kNone);
}

TEST(FreeformOptics, AMapThatIsNotThereIsAnError) {
  EXPECT_THROW(ShownWith("/nowhere/form.exr"), InputError);
}

}  // namespace
}  // namespace twinbench::freeform_test
