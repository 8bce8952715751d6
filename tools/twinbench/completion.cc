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

/// The commands, and as cases of a shell the options of each, between what begins and ends a list there.
struct Known {
  std::string commands, cases;
};

Known KnownOf(const CLI::App& app, const char* begin, const char* end) {
  Known known;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    known.commands += (known.commands.empty() ? "" : " ") + command->get_name();
    known.cases += fmt::format("    {}) found={}{}{} ;;\n", command->get_name(), begin, OptionsOf(*command), end);
  }
  return known;
}

/// Commands first, then the options of the command, and files everywhere.
std::string ForBash(const CLI::App& app) {
  const Known known = KnownOf(app, "\"", "\"");
  return fmt::format(
      "# eval \"$(twinbench completion)\" in ~/.bashrc\n"
      "_twinbench() {{\n"
      "  local here=\"${{COMP_WORDS[COMP_CWORD]}}\" found=\"\"\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    COMPREPLY=($(compgen -W \"{} --help --version\" -- \"$here\"))\n"
      "    return\n"
      "  fi\n"
      "  case \"${{COMP_WORDS[1]}}\" in\n{}"
      "  esac\n"
      "  COMPREPLY=($(compgen -W \"$found\" -- \"$here\") $(compgen -f -- \"$here\"))\n"
      "}}\n"
      "complete -o filenames -F _twinbench twinbench\n",
      known.commands, known.cases);
}

/// The same; as a file _twinbench of $fpath too.
std::string ForZsh(const CLI::App& app) {
  const Known known = KnownOf(app, "(", ")");
  return fmt::format(
      "#compdef twinbench\n"
      "# eval \"$(twinbench completion zsh)\" in ~/.zshrc\n"
      "_twinbench() {{\n"
      "  local -a found\n"
      "  if (( CURRENT == 2 )); then\n"
      "    compadd -- {} --help --version\n"
      "    return\n"
      "  fi\n"
      "  case $words[2] in\n{}"
      "  esac\n"
      "  compadd -- $found\n"
      "  _files\n"
      "}}\n"
      "(( $+functions[compdef] )) || {{ autoload -Uz compinit && compinit }}\n"
      "if [[ $funcstack[1] == _twinbench ]]; then _twinbench \"$@\"; else compdef _twinbench twinbench; fi\n",
      known.commands, known.cases);
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
  command->add_option("shell", *shell, "bash, zsh or fish")->check(OneOf({"bash", "zsh", "fish"}))->capture_default_str();
  AnswerWith(*command, "it", [&app, shell](JsonAnswer& answer) {
    if (!answer.IsOnStdout()) fmt::print("{}", For(*shell, app));
    answer.Write({{"shell", *shell}, {"script", For(*shell, app)}});
  });
}

}  // namespace twinbench::tools
