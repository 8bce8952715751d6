#pragma once

#include <CLI/CLI.hpp>

/// The commands of `twinbench`, one file each. Every Add... hangs a command with its options and its action under
/// `app`; the action throws InputError, BenchError or std::exception, and main turns that into an exit code.
namespace twinbench::tools {

void AddRun(CLI::App& app);
void AddCampaign(CLI::App& app);
void AddMeasure(CLI::App& app);
void AddServe(CLI::App& app);
void AddExport(CLI::App& app);
void AddImport(CLI::App& app);
void AddSeparate(CLI::App& app);
void AddCompensate(CLI::App& app);
void AddUncertainty(CLI::App& app);
void AddBudget(CLI::App& app);
void AddPlan(CLI::App& app);
void AddInvestigate(CLI::App& app);
void AddDiagnose(CLI::App& app);
void AddReport(CLI::App& app);
void AddCertificate(CLI::App& app);
void AddScore(CLI::App& app);
void AddHelp(CLI::App& app);
void AddNew(CLI::App& app);
void AddCheck(CLI::App& app);
void AddList(CLI::App& app);
void AddExplain(CLI::App& app);
void AddSchema(CLI::App& app);
void AddCompletion(CLI::App& app);

}  // namespace twinbench::tools
