#include "twin/benches/freeform_five_axis/twin/traced_probe.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/freeform/freeform_run.h"

// The probe as light against the closed form of the format, the independent implementation, and geometry.
namespace twinbench::freeform_test {
namespace {

constexpr double kAgreed_V = 1e-6, kAgreed_px = 1e-6;

double Most(const sim::ProbeSignals& a, const sim::ProbeSignals& b) {
  return std::max({std::abs(a.qpd_x_V - b.qpd_x_V), std::abs(a.qpd_y_V - b.qpd_y_V),
                   std::abs(a.qpd_sum_V - b.qpd_sum_V), std::abs(a.ccd_px - b.ccd_px)});
}

TEST(FreeformLight, ReadsThePosesOfTheOracleByTracedRays) {
  sim::FreeformTwin twin(FreeformScenario(), OracleBench());
  std::uint64_t rays = 0;
  const std::vector<Reading> readings = OracleRun();
  ASSERT_EQ(readings.size(), 480u);
  for (const Reading& r : readings) {
    const sim::ProbeSignals shown = twin.Show(r, 0.0);
    EXPECT_NEAR(shown.qpd_x_V, kQpdX_V(r), kAgreed_V);
    EXPECT_NEAR(shown.qpd_y_V, kQpdY_V(r), kAgreed_V);
    EXPECT_NEAR(shown.qpd_sum_V, kQpdSum_V(r), kAgreed_V);
    EXPECT_NEAR(shown.ccd_px, kCcd_px(r), kAgreed_px);
    // Two lenses, splitter, plate, beyond it nothing, the paraboloid; plate, splitter, lens, detector;
    // the camera's lens and line: at least a dozen questions to Embree for every reading.
    EXPECT_GE(twin.light().rays(), rays + 12);
    rays = twin.light().rays();
  }
}

TEST(FreeformLight, AgreesWithItsClosedFormOnTheWholeStandardPath) {
  const Scenario traced = FreeformScenario(), closed = FreeformScenario("[optics]\nfidelity = \"closed\"\n");
  const sim::DrawnBench drawn = sim::Draw(traced);
  sim::FreeformTwin by_rays(traced, drawn), by_formula(closed, drawn),
      quick(traced, drawn, sim::LightAsked::kQuickly);
  double most = 0.0;
  for (const Reading& r : procedure::FreeformSchedule(traced)) {
    const sim::ProbeSignals shown = by_rays.Show(r, 0.0);
    most = std::max(most, Most(shown, by_formula.Show(r, 0.0)));
    EXPECT_LT(Most(shown, quick.Show(r, 0.0)), kAgreed_V);
  }
  EXPECT_EQ(FreeformOf(traced).optics.fidelity, "traced") << "as `twinbench run` has it";
  // Of light askew by 5 mrad both ways the plate does not turn 1e-10.
  EXPECT_LT(most, 1e-8);
  EXPECT_GT(by_rays.light().rays(), 800u * 12u);
  EXPECT_EQ(by_formula.light().rays(), 0u);
  EXPECT_EQ(quick.light().rays(), 0u);  // nowhere on this path does the closed form take too much for granted
}

TEST(FreeformLight, FollowsQuicklyWhatAnyRunShows) {
  // Scenarios in which the light does not find all that the closed form takes for granted: a camera close to the
  // beam, a tip far over the surface, a lens that throws the spot off its detector, misaligned mountings.
  const char* const scenarios[] = {
      "[ccd]\nobject_mm = 20.0\nalpha_deg = 60.0\n[freeform_procedure]\nheight_mm = 30.0\nposes = 20\n",
      "[freeform_procedure]\nheight_mm = 70.0\nposes = 20\n",
      "[qpd]\nlens_mm = 400.0\n[artefact]\nmounting_um = 400.0\n[freeform_procedure]\nposes = 20\n",
      "[artefact]\nmounting_um = 3000.0\n[freeform_procedure]\nposes = 20\n",
      "[freeform_procedure]\nangle_deg = 40.0\nposes = 20\n"};
  int different = 0;
  for (const char* text : scenarios) {
    const Scenario scenario = FreeformScenario(text);
    const Scenario closed = FreeformScenario(std::string("optics.fidelity = \"closed\"\n") + text);
    const sim::DrawnBench drawn = sim::Draw(scenario);
    sim::FreeformTwin live(scenario, drawn), quick(scenario, drawn, sim::LightAsked::kQuickly),
        formula(closed, drawn);
    for (const Reading& r : procedure::FreeformSchedule(scenario)) {
      const sim::ProbeSignals shown = live.Show(r, 0.0), followed = quick.Show(r, 0.0);
      EXPECT_EQ(std::isnan(shown.ccd_px), std::isnan(followed.ccd_px)) << text;
      if (std::isnan(shown.ccd_px) || std::isnan(followed.ccd_px)) {
        ++different;
        continue;
      }
      EXPECT_LT(Most(shown, followed), kAgreed_V) << text;
      different += Most(shown, formula.Show(r, 0.0)) > kAgreed_V ? 1 : 0;
    }
  }
  EXPECT_GT(different, 50);  // else the scenarios are too tame to test anything
}

/// The same bench, traced and by its closed form, on a short course: the largest difference of a signal.
double Between(const std::string& scenario) {
  const std::string shorter = "[freeform_procedure]\nposes = 15\n" + scenario;
  const Scenario traced = FreeformScenario(shorter),
                 closed = FreeformScenario("optics.fidelity = \"closed\"\n" + shorter);
  sim::FreeformTwin by_rays(traced, sim::Draw(traced)), by_formula(closed, sim::Draw(closed));
  const std::vector<Reading> readings = procedure::FreeformSchedule(traced);
  double most = 0.0;
  for (const Reading& r : readings) {
    const double share = r.reading / static_cast<double>(readings.size());
    most = std::max(most, Most(by_rays.Show(r, share), by_formula.Show(r, share)));
  }
  return most;
}

TEST(FreeformLight, CarriesEveryEffectOfTheProbeAsTheClosedFormDoes) {
  for (const char* effect :
       {"name = \"vertex_radius\"\nratio = 0.001", "name = \"focal_length\"\nratio = 0.02",
        "name = \"spot_size\"\nratio = 0.05", "name = \"ccd_scale\"\nratio = 0.001",
        "name = \"laser_drift\"\nwhere = \"qpd_y\"\nspot_mm = 0.05", "name = \"artefact_form\"\ncosine_um = 3.0",
        "name = \"artefact_pitch\"\nwhere = \"x\"\nratio = 1e-4", "name = \"qpd_roll\"\nroll_rad = 0.1",
        "name = \"leakage\"\nwhere = \"qpd_x\"\nfraction = 0.02\nat_V = 1.0"})
    EXPECT_LT(Between(std::string("[[effect]]\n") + effect + "\n"), kAgreed_px) << effect;
}

TEST(FreeformLight, MeetsTheHeightsOfAMapAsTheClosedFormDoes) {
  const std::string path = WriteHeights(
      "traced_form.exr", [](double x_m, double y_m) { return 3.0 * std::sin(300.0 * x_m) * std::cos(200.0 * y_m); });
  EXPECT_LT(Between("[artefact]\nform_error = \"" + path + "\"\n"), kAgreed_px);
}

TEST(FreeformLight, LeaksAsTheEffectOfThatNameSays) {
  constexpr double kFace = 0.002;
  FreeformSettings leaky;
  leaky.optics.plate_reflected = kFace;
  leaky.optics.plate_tilt_x_rad = -1.2e-3;
  leaky.optics.plate_tilt_y_rad = 2.0e-3;
  const sim::TracedProbe probe(leaky);
  // The place of the leak: what a mirror in the plate's place would show.
  const Vector3 normal = (Eigen::AngleAxisd(leaky.optics.plate_tilt_x_rad, Vector3::UnitX()) *
                          Eigen::AngleAxisd(leaky.optics.plate_tilt_y_rad, Vector3::UnitY())) *
                         Vector3::UnitZ();
  sim::ProbeSpot ghost;
  ghost.reflected_T = 2.0 * normal.z() * normal - Vector3::UnitZ();
  sim::ProbeSignals at_V;
  sim::ShowQuadrants(leaky.qpd, sim::OnQuadrants_m(leaky.qpd, ghost), at_V);
  // Of what comes from artefact and plate together; the artefact's light crosses the faces four times, this one
  // two.
  const double fraction = kFace / (kFace + std::pow(1.0 - kFace, 2));
  const auto leakage = [&](const char* where, double at) {
    return fmt::format("[[effect]]\nname = \"leakage\"\nwhere = \"{}\"\nfraction = {:.17g}\nat_V = {:.17g}\n",
                       where, fraction, at);
  };
  const Scenario by_effect = FreeformScenario(leakage("qpd_x", at_V.qpd_x_V) + leakage("qpd_y", at_V.qpd_y_V));
  const sim::DrawnBench bench = OracleBench();
  sim::FreeformTwin twin(by_effect, bench);
  int readings = 0;
  for (const Reading& r : OracleRun()) {
    if (++readings % 7 != 0) continue;  // enough of them
    const optics::ProbeView view = probe.View(CellAt(r), ToolOverArtefact(r, bench, leaky), 0.0, nullptr);
    Eigen::Vector2d sum_V = Eigen::Vector2d::Zero();
    double power = 0.0;
    for (const optics::ProbePatch& patch : view.patches) {
      if (patch.returns > 1) continue;
      sim::ProbeSignals one;
      sim::ShowQuadrants(leaky.qpd, {patch.u_m, patch.v_m}, one);
      sum_V += patch.power * Eigen::Vector2d(one.qpd_x_V, one.qpd_y_V);
      power += patch.power;
    }
    const sim::ProbeSignals shown = twin.Show(r, 0.0);
    EXPECT_NEAR(sum_V.x() / power, shown.qpd_x_V, 1e-8);
    EXPECT_NEAR(sum_V.y() / power, shown.qpd_y_V, 1e-8);
  }
}

TEST(FreeformLight, AWavePlateThatReflectsIsMoreThanALeakage) {
  // Light that the plate sends back to the artefact comes again, as strong as what it leaks on a fixed place, and
  // moves: the effect, which the format defines, has no such part.
  FreeformSettings leaky;
  leaky.optics.plate_reflected = 0.002;
  const sim::TracedProbe probe(leaky);
  const sim::DrawnBench bench = OracleBench();
  double fixed = 0.0, moving = 0.0;
  for (const Reading& r : OracleRun()) {
    for (const optics::ProbePatch& patch :
         probe.View(CellAt(r), ToolOverArtefact(r, bench, leaky), 0.0, nullptr).patches) {
      fixed += patch.returns == 0 ? patch.power : 0.0;
      moving += patch.returns == 2 ? patch.power : 0.0;
    }
  }
  EXPECT_NEAR(moving / fixed, 1.0, 0.02);
}

TEST(FreeformLight, ABeamOf200UmMakesTheStatedSpotOnTheSteepCells) {
  // 0.25 mm is 2 f w / R for w = 0.1 mm on R = 40 mm; diffraction adds 0.10 mm in quadrature. On R = 80 mm the spot
  // is smaller, which the format's single radius does not say.
  for (const int i : {0, 1}) {
    FreeformSettings beam, stated;
    beam.optics.spot = "beam";
    const double by_slope_m = 0.050 * 2.0 * 0.1e-3 / stated.artefact.vertex_radius_m[static_cast<std::size_t>(i)];
    const double by_diffraction_m = 0.050 * 650e-9 / (std::numbers::pi * 0.1e-3);
    stated.qpd.spot_radius_m = std::hypot(by_slope_m, by_diffraction_m);
    const Pose X_FT(Eigen::Translation3d(i * 0.020 + 20e-6, -30e-6, 0.0));
    const sim::ProbeSignals by_beam = sim::TracedProbe(beam).Show({i, 0}, X_FT, 0.0, nullptr, {0.0, 0.0});
    const sim::ProbeSignals by_radius = sim::TracedProbe(stated).Show({i, 0}, X_FT, 0.0, nullptr, {0.0, 0.0});
    EXPECT_NEAR(by_beam.qpd_x_V, by_radius.qpd_x_V, 1e-3 * std::abs(by_radius.qpd_x_V));
    EXPECT_NEAR(by_beam.qpd_y_V, by_radius.qpd_y_V, 1e-3 * std::abs(by_radius.qpd_y_V));
    EXPECT_NEAR(by_beam.qpd_sum_V, by_radius.qpd_sum_V, 1e-3);
  }
}

TEST(FreeformLight, RefusesAClosedFormOfWhatItDoesNotKnow) {
  const std::string closed = "[optics]\nfidelity = \"closed\"\n";
  for (const char* more :
       {"spot = \"beam\"", "splitter = \"stack\"", "plate_reflected = 0.001", "splitter_p_reflected = 0.01",
        "plate_retardance_deg = 2.0", "plate_azimuth_deg = 1.0", "splitter_s_transmitted = 0.01"})
    EXPECT_THROW(sim::FreeformTwin(FreeformScenario(closed + more + "\n"), {}), InputError) << more;
}

}  // namespace
}  // namespace twinbench::freeform_test
