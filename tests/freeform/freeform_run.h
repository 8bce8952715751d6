#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "optics/height_map.h"
#include "tests/support/thresholds.h"
#include "twin/benches/freeform_five_axis/bench.h"
#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/procedure.h"
#include "twin/benches/freeform_five_axis/twin/chain.h"
#include "twin/benches/freeform_five_axis/twin/twin.h"
#include "twin/benches/names.h"
#include "twin/core/csv.h"
#include "twin/core/stream.h"

/// Runs of the bench freeform_five_axis, live ones and those of an independent implementation.
namespace twinbench::freeform_test {

using namespace benches::freeform;

inline Scenario FreeformScenario(const std::string& more = "") {
  return ParseScenario("bench = \"freeform_five_axis\"\n" + more, "freeform.toml", ".");
}

inline std::string OraclePath(const std::string& name) {
  return TWINBENCH_TEST_DATA "/oracle/freeform_" + name;
}

inline std::vector<Reading> OracleRun() {
  return ReadReadingsCsv(OraclePath("run.csv"), kFreeformBench);
}

inline sim::ArtefactCell CellAt(const Reading& r) {
  return {static_cast<int>(kCellI(r)), static_cast<int>(kCellJ(r))};
}

inline double UnitOfError(std::size_t error) {
  return IsRotation(static_cast<int>(error)) ? units::arcsec : units::um;
}

inline sim::DrawnBench OracleBench() {
  const nlohmann::json truth = nlohmann::json::parse(std::ifstream(OraclePath("truth.json"))).at("machine");
  sim::DrawnBench bench;
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    for (std::size_t error = 0; error < kBodyErrors; ++error) {
      for (std::size_t term = 0; term < kCubicTerms; ++term)
        bench.machine.errors[axis][error][term] =
            truth.at("poly").at(kAxisNames[axis]).at(error).at(term).get<double>() * UnitOfError(error);
    }
  }
  for (std::size_t k = 0; k < kSquarenesses; ++k)
    bench.machine.squareness_rad[k] =
        truth.at("squareness_arcsec").at(kSquarenessNames[k]).get<double>() * units::arcsec;
  for (const nlohmann::json& mounting : truth.at("mount_um_arcsec")) {
    sim::BodyError& error = bench.mountings.emplace_back();
    for (std::size_t k = 0; k < kBodyErrors; ++k) error[k] = mounting.at(k).get<double>() * UnitOfError(k);
  }
  return bench;
}

/// Where the tool stands over the artefact at a reading.
inline Pose ToolOverArtefact(const Reading& r, const sim::DrawnBench& bench, const FreeformSettings& settings) {
  const auto setup = static_cast<std::size_t>(r.setup);
  sim::MachineCommand at{};
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) at[axis] = kCommanded[axis](r);
  const sim::MachineErrors errors = sim::ErrorsAt(bench.machine, at);
  const Pose X_MF =
      sim::X_MS(at, errors) * sim::X_SF(settings.freeform_procedure.mounts[setup], bench.mountings[setup]);
  return X_MF.inverse() * sim::X_MT(at, errors, bench.machine.pivot_m);
}

/// What the scenario's twin shows on the course of its own procedure.
inline std::vector<Reading> RunOf(const Scenario& scenario, const sim::DrawnBench& drawn) {
  sim::FreeformTwin twin(scenario, drawn);
  std::vector<Reading> readings = procedure::FreeformSchedule(scenario);
  const double run_s = ToSeconds(readings.back().time);
  const FreeformSettings& own = FreeformOf(scenario);
  Stream noise(scenario.seed, "test.noise");
  for (Reading& r : readings) {
    r.temperature_degC = 20.0 + 0.5 * std::sin(ToSeconds(r.time) / 700.0);
    const sim::ProbeSignals shown = twin.Show(r, ToSeconds(r.time) / run_s);
    const double share = scenario.noise_free ? 0.0 : 1.0;
    kQpdX_V(r) = shown.qpd_x_V + share * own.qpd.noise_V * noise.Normal();
    kQpdY_V(r) = shown.qpd_y_V + share * own.qpd.noise_V * noise.Normal();
    kQpdSum_V(r) = shown.qpd_sum_V;
    kCcd_px(r) = shown.ccd_px + share * own.ccd.noise_px * noise.Normal();
  }
  return readings;
}

inline std::vector<Reading> RunOf(const Scenario& scenario) {
  return RunOf(scenario, sim::Draw(scenario));
}

/// Heights 1 mm apart, in a file that goes with the tests' other files. Cubic interpolation between pixels nearly hits tilts and waves.
/// @param height_um  By x_m and y_m.
inline std::string WriteHeights(const std::string& name, const std::function<double(double, double)>& height_um) {
  optics::HeightMap map{241, 241, 1.0 * units::mm, {}};
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column)
      map.height_um.push_back(static_cast<float>(height_um((column - 120) * map.pitch_m, (120 - row) * map.pitch_m)));
  }
  const std::string path = std::filesystem::path(testing::TempDir()) / name;
  optics::WriteHeightMap(path, map);
  return path;
}

/// The diagnosis with thresholds from as many runs as are enough for one.
inline diagnose::Diagnosis DiagnosisOf(const std::vector<Reading>& readings, const Scenario& believed) {
  return benches::freeform::Diagnose(readings, believed, test::QuickOptions()).diagnosis;
}

inline std::vector<std::string> NamesOf(const diagnose::Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const diagnose::Cause& cause : diagnosis.causes) names.push_back(cause.effect);
  return names;
}

}  // namespace twinbench::freeform_test
