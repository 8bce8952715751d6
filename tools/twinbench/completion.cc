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

/// zsh reads what bash does.
std::string ForZsh(const CLI::App& app) {
  return "# eval \"$(twinbench completion zsh)\" in ~/.zshrc\nautoload -Uz compinit bashcompinit && compinit && bashcompinit\n" + ForBash(app);
}

std::string ForFish(const CLI::App& app) {
  std::string text = "# twinbench completion fish > ~/.config/fish/completions/twinbench.fish\n";
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    text += fmt::format("complete -c twinbench -n __fish_use_subcommand -f -a {}\n", command->get_name());
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames())
        text += fmt::format("complete -c twinbench -n '__fish_seen_subcommand_from {}' -l {}\n", command->get_name(), name);
    }
  }
  return text;
}

std::string For(const std::string& shell, const CLI::App& app) {
  return shell == "fish" ? ForFish(app) : shell == "zsh" ? ForZsh(app) : ForBash(app);
}

}  // namespace

void AddCompletion(CLI::App& app) {
  auto* command = app.add_subcommand("completion", "Print the completion of commands and options for bash, zsh or fish");
  auto shell = std::make_shared<std::string>("bash");
  command->add_option("shell", *shell, "bash, zsh or fish")->check(CLI::IsMember({"bash", "zsh", "fish"}))->capture_default_str();
  AnswerWith(*command, "it", [&app, shell](JsonAnswer& answer) {
    if (!answer.IsOnStdout()) fmt::print("{}", For(*shell, app));
    answer.Write({{"shell", *shell}, {"script", For(*shell, app)}});
  });
}

}  // namespace twinbench::tools
