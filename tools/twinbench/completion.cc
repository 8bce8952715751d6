#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/json_answer.h"

namespace twinbench::tools {
namespace {

std::string OptionsOf(const CLI::App& command) {
  std::string words;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) words += (words.empty() ? "--" : " --") + name;
  }
  return words;
}

/// Commands first, then the options of the command, and files everywhere.
std::string ForBash(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands += (commands.empty() ? "" : " ") + command->get_name();
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), OptionsOf(*command));
  }
  return fmt::format(
      "# eval \"$(twinbench completion)\" in ~/.bashrc\n"
      "_twinbench() {{\n"
      "  local here=\"${{COMP_WORDS[COMP_CWORD]}}\" words=\"\"\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    COMPREPLY=($(compgen -W \"{} --help --version\" -- \"$here\"))\n"
      "    return\n"
      "  fi\n"
      "  case \"${{COMP_WORDS[1]}}\" in\n{}"
      "  esac\n"
      "  COMPREPLY=($(compgen -W \"$words\" -- \"$here\") $(compgen -f -- \"$here\"))\n"
      "}}\n"
      "complete -o filenames -F _twinbench twinbench\n",
      commands, cases);
}

}  // namespace

void AddCompletion(CLI::App& app) {
  auto* command = app.add_subcommand("completion", "Print what bash needs to complete commands and options");
  AnswerWith(*command, "it", [&app](JsonAnswer& answer) {
    if (!answer.IsOnStdout()) fmt::print("{}", ForBash(app));
    answer.Write({{"shell", "bash"}, {"script", ForBash(app)}});
  });
}

}  // namespace twinbench::tools
