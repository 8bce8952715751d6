#include "tools/twinbench/program.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string_view>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/exit_code.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/terminal.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"

namespace twinbench::tools {
namespace {

struct Opening {
  std::string_view command, answers;
  std::array<std::string_view, 2> examples;
};

constexpr auto kOpenings = std::to_array<Opening>({
    {"run", "What would this measurement give, and how far would it be from the truth?",
     {"run scenarios/rotary_4dof.toml -o runs/first", "run mine.toml -o runs/hot --set environment.temperature_degC=23 --seed 7"}},
    {"campaign", "How do the results scatter over many runs, and do their uncertainties hold?",
     {"campaign scenarios/studies/coverage_rotary.toml -o coverage.sqlite", "campaign study.toml -o study.sqlite --resume --csv study.csv"}},
    {"measure", "What are the errors of the tables on my own bench?",
     {"measure scenarios/turntable_shifts.toml --bench bench.toml --rehearse-only", "measure scenarios/turntable_shifts.toml --bench bench.toml -o runs/monday"}},
    {"serve", "Does my control software work, before the bench does?",
     {"serve scenarios/turntable_shifts.toml --speed max --write-bench bench.toml", "serve scenarios/rotary_4dof.toml --bind 0.0.0.0 --token --web 8080"}},
    {"export", "What are the readings of a run, one row each?",
     {"export runs/first --readings readings.csv", "export runs/first | head"}},
    {"import", "How does a file of my own software become a run that can be diagnosed?",
     {"import scenarios/samples/encoder.csv -o runs/encoder", "import mine.csv --look"}},
    {"separate", "What are the errors of the table under test, and what are those of its reference?",
     {"separate runs/first --tables tables", "separate readings.csv --scenario scenarios/rotary_4dof.toml --estimator published"}},
    {"compensate", "Which corrections should the controller add, and what would they leave?",
     {"compensate runs/first -o table.csv", "compensate runs/first --check runs/compensated"}},
    {"uncertainty", "How uncertain is each result of a run, and which source limits it?",
     {"uncertainty runs/first", "uncertainty runs/first --monte-carlo --set laser.u_wavelength_nm=0.01"}},
    {"budget", "Which source of the simulated bench disturbs a figure, and by how much?",
     {"budget scenarios/stability.toml", "budget scenarios/stability.toml --of stability.range"}},
    {"plan", "What would this run tell, and which run should be made next?",
     {"plan scenarios/turntable_shifts.toml --minutes 120", "plan mine.toml --goal target.ez -o next.toml"}},
    {"investigate", "Which cause is it, in as few runs as possible?",
     {"investigate mine.toml --bench bench.toml -o runs/found --ask", "investigate mine.toml --twin hidden.toml --budget 90min"}},
    {"diagnose", "Which cause of which size explains how the readings differ from the scenario?",
     {"diagnose runs/first", "diagnose readings.csv --scenario mine.toml -o extended.toml --verbose"}},
    {"report", "How do I show the results to somebody else?",
     {"report runs/first", "report runs/first --svg pictures"}},
    {"certificate", "How do I state the results in the form that customers and accreditation bodies read?",
     {"certificate --template -o laboratory.toml", "certificate runs/first --with laboratory.toml -o certificate.xml"}},
    {"score", "How far is the result from the truth, and does the stated uncertainty cover that?",
     {"score runs/first", "score runs/first --estimator published --positions"}},
    {"new", "Which keys does a scenario of this bench have?",
     {"new encoder_comparison -o mine.toml", "new rotary_4dof | less"}},
    {"check", "Is this scenario complete, and are its values possible?",
     {"check mine.toml", "check mine.toml --set procedure.positions=12"}},
    {"list", "Which benches and which effects are there?",
     {"list", "list --json"}},
    {"explain", "What does an effect do to the readings?",
     {"explain psd_nonlinearity", "explain backlash --bench encoder_comparison"}},
    {"help", "What does a key of one of my files mean, and which values may it have?",
     {"help scenario laser", "help bench"}},
    {"schema", "How does my editor complete and check the keys of a scenario?",
     {"schema > scenario.schema.json", "schema --json scenario.schema.json"}},
    {"completion", "How does my shell complete commands and options?",
     {"completion >> ~/.bashrc", "completion fish > ~/.config/fish/completions/twinbench.fish"}},
});

/// The help of the command that a command line names opens with what it answers and with two examples.
/// @param command  argv[1], or nothing where there is none; another word changes nothing.
void OpenWithExamples(CLI::App& app, const char* command) {
  const auto* opening = std::ranges::find(kOpenings, std::string_view(command ? command : ""), &Opening::command);
  if (opening == kOpenings.end()) return;
  CLI::App* named = app.get_subcommand(std::string(opening->command));
  named->description(fmt::format("{}. It answers:\n{}\n\nExamples:\n  twinbench {}\n  twinbench {}\n", named->get_description(), opening->answers,
                                 opening->examples[0], opening->examples[1]));
}

constexpr const char* kAbout =
    "A virtual test bench for precision rotary tables: it simulates the measurement that a scenario file describes,\n"
    "evaluates the readings as those of a real bench, and identifies what is wrong with them.";

constexpr const char* kExamples =
    "A first session:\n"
    "  twinbench run scenarios/rotary_4dof.toml -o runs/first     simulate, measure, separate\n"
    "  twinbench score runs/first                                 compare with the truth\n"
    "  twinbench report runs/first                                a page of plots and tables that opens offline\n"
    "  twinbench diagnose runs/first                              which cause explains the difference?\n"
    "  twinbench export runs/first --readings readings.csv        readings for other software\n"
    "  twinbench separate readings.csv --scenario scenarios/rotary_4dof.toml --json - --estimator published\n"
    "  twinbench score runs/first --against mine.csv              your own result in the same table\n"
    "\n"
    "With a recording of your own:\n"
    "  twinbench import mine.csv -o runs/mine                     angle by a reference, angle by the encoder\n"
    "  twinbench diagnose runs/mine                               what is wrong, how large, how sure\n"
    "\n"
    "The same scenario many times:\n"
    "  twinbench campaign study.toml -o study.sqlite              trials in parallel, one table, a summary\n"
    "\n"
    "With a bench, here an emulated one:\n"
    "  twinbench serve scenarios/rotary_4dof.toml --speed max --write-bench bench.toml\n"
    "  twinbench measure scenarios/rotary_4dof.toml --bench bench.toml --rehearse -o runs/monday\n"
    "\n"
    "  twinbench help scenario     every key of a scenario file with unit, default and bounds; of one BENCH or TABLE with its name\n"
    "  twinbench help effects      every effect that a scenario can hide in the bench\n"
    "  twinbench help bench        every key of a bench file\n"
    "  twinbench help map          every key of a map for importing recordings, and the ready maps\n"
    "\n";
constexpr const char* kExitCodes =
    "Exit codes: 0 done, 1 the bench, the disk or the network failed, 2 a file or an option is wrong, 3 an axis was commanded\n"
    "to stop and it is not known whether it stands.";

std::vector<std::string> NamesOf(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  return names;
}

std::string Names(const std::vector<const CLI::App*>& commands) {
  return fmt::format("{}", fmt::join(NamesOf(commands), ", "));
}

/// The first word that a command does not take, with what comes nearest.
std::string NotTaken(const CLI::App& command, const std::string& word) {
  if (!word.starts_with("-"))
    return fmt::format("unexpected argument \"{}\": an option takes one value, and is given again for another",
                       ForTerminal(word));
  std::vector<std::string> options;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  return fmt::format("there is no option {}{}", ForTerminal(word), OrNearest(word.substr(0, word.find('=')), options));
}

std::string InWords(const CLI::App& command, const CLI::Error& error) {
  const std::vector<std::string> left = command.remaining();
  const bool is_extra = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && !left.empty();
  return is_extra ? NotTaken(command, left.front()) : error.what();
}

/// A wrong command line in one line, like any other bad input.
std::string Complaint(const CLI::App* app, const CLI::Error& error) {
  const std::vector<CLI::App*> chosen = app->get_subcommands();
  if (chosen.empty()) {
    const std::vector<std::string> words = app->remaining();
    const std::vector<const CLI::App*> commands = app->get_subcommands([](const CLI::App*) { return true; });
    return fmt::format("twinbench: {}; expected one of {}{}\n",
                       words.empty() ? "there is no command" : "unknown command " + ForTerminal(words.front()), Names(commands),
                       words.empty() ? "" : "; the nearest is " + Nearest(words.front(), NamesOf(commands)));
  }
  const std::string command = "twinbench " + chosen.front()->get_name();
  return fmt::format("{}: {}; expected what {} --help lists\n", command, InWords(*chosen.front(), error), command);
}

/// Without "twinbench: " before it and the end of the line behind.
std::string InOneLine(std::string complaint) {
  while (complaint.ends_with('\n')) complaint.pop_back();
  constexpr std::string_view kName = "twinbench: ";
  return complaint.starts_with(kName) ? complaint.substr(kName.size()) : complaint;
}

/// What was printed may be an answer that somebody keeps.
/// @throws BenchError if some of it went nowhere: a full disk, a pipe that was closed.
void RequireAllSaid() {
  std::cout.flush();
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout)
    throw BenchError("not all of the answer could be written to stdout");
}

int Obey(int argc, char** argv) {
  CLI::App app(kAbout, "twinbench");
  app.footer(kExitCodes);  // of the commands too
  app.set_version_flag("--version", std::string(TWINBENCH_VERSION));
  app.require_subcommand(1);
  app.failure_message(Complaint);
  for (const auto add : {AddRun, AddCampaign, AddMeasure, AddServe, AddExport, AddImport, AddSeparate,
                         AddCompensate, AddUncertainty, AddBudget, AddPlan, AddInvestigate, AddDiagnose, AddReport, AddCertificate, AddScore, AddNew,
                         AddCheck, AddList, AddExplain, AddHelp, AddSchema, AddCompletion})
    add(app);
  app.footer(std::string(kExamples) + kExitCodes);
  OpenWithExamples(app, argc > 1 ? argv[1] : nullptr);
  try {
    app.parse(argc, argv);
    RequireAllSaid();
    return kDone;
  } catch (const CLI::ParseError& error) {
    const bool is_wrong = app.exit(error) != 0;
    if (is_wrong && AsksJsonOnStdout(argc, argv)) JsonAnswer("-").Write(WrongCommandLineJson(InOneLine(Complaint(&app, error))));
    return is_wrong ? kBadInput : kDone;
  }
}

/// Matrices of some megabytes come and go all the time; giving each back to the system costs a fifth of a long
/// diagnosis in page faults.
void KeepFreedMemory() {
#ifdef __GLIBC__
  constexpr int kLarge = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kLarge);
  mallopt(M_TRIM_THRESHOLD, kLarge);
#endif
}

/// Says it even where nobody can read it any more: a closed session must not turn one failure into another.
int Failed(const std::exception& error) {
  const std::string text = FailureText(error);
  const bool is_red = MayColour(stderr);
  std::fputs((is_red ? "\033[31m" + text + "\033[0m\n" : text + "\n").c_str(), stderr);
  return ExitCodeOf(error);
}

}  // namespace

int Main(int argc, char** argv) {
  KeepFreedMemory();
  try {
    return Obey(argc, argv);
  } catch (const std::exception& error) {
    return Failed(error);
  }
}

}  // namespace twinbench::tools
