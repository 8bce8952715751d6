#include "tools/twinbench/examples.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

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

}  // namespace

void OpenWithExamples(CLI::App& app, const char* command) {
  const auto* opening = std::ranges::find(kOpenings, std::string_view(command ? command : ""), &Opening::command);
  if (opening == kOpenings.end()) return;
  CLI::App* named = app.get_subcommand(std::string(opening->command));
  named->description(fmt::format("{}. It answers:\n{}\n\nExamples:\n  twinbench {}\n  twinbench {}\n", named->get_description(), opening->answers,
                                 opening->examples[0], opening->examples[1]));
}

}  // namespace twinbench::tools
