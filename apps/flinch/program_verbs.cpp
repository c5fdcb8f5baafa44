// flinch help, flinch completion, flinch man: what shells and people are told of the program.
#include <algorithm>

#include "apps/flinch/man_page.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/shell_completion.h"
#include "apps/flinch/verbs.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// What is wrong with the name of a shell; "" if nothing is.
std::string known_shell(const std::string& text) {
  const std::vector<std::string> names = completed_shells();
  if (std::find(names.begin(), names.end(), text) != names.end()) return "";
  return "is '" + text + "', which is no shell that flinch knows" + did_you_mean(text, names);
}

/// The verb that words name one below the other. Throws SetupError where there is none.
const CLI::App& verb_of(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* found = &app;
  for (const std::string& word : words) {
    std::vector<std::string> known;
    const CLI::App* next = nullptr;
    for (const CLI::App* const each : found->get_subcommands([](const CLI::App*) { return true; })) {
      known.push_back(each->get_name());
      if (each->get_name() == word) next = each;
    }
    if (next == nullptr)
      throw SetupError("'" + word + "' is no verb" + (known.empty() ? "" : did_you_mean(word, known)));
    found = next;
  }
  return *found;
}

std::string help_of(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty()) return app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal);
  std::string path = "flinch";
  for (std::size_t i = 0; i + 1 < words.size(); ++i) path += " " + words[i];
  return verb_of(app, words).help(path);
}

}  // namespace

void add_program_verbs(CLI::App& app, Verbs& verbs, const std::string& version) {
  CLI::App& help = *app.add_subcommand("help", "Show the options of a verb");
  help.footer("Example:\n  flinch help run");
  help.add_option("verb", verbs.explained,
                  "Verb, and what of it, as in calibrate dynamics [the list of verbs]")
      ->type_name("VERB");
  help.callback([&app, &verbs] {
    verbs.common = &verbs.demo.common;
    verbs.chosen = [&app, &verbs] {
      print_results(help_of(app, verbs.explained));
      return ExitStatus::done;
    };
  });
  CLI::App& completion = *app.add_subcommand(
      "completion", "Print a script that lets a shell complete verbs and options: bash, fish or zsh");
  completion.footer("Example:\n  flinch completion bash > ~/.local/share/bash-completion/completions/flinch");
  completion.add_option("shell", verbs.shell, "Shell")->required()->type_name("SHELL")->check(known_shell);
  completion.callback([&app, &verbs] {
    verbs.common = &verbs.demo.common;
    verbs.chosen = [&app, &verbs] {
      print_results(completion_for(verbs.shell, app));
      return ExitStatus::done;
    };
  });
  CLI::App& manual = *app.add_subcommand("man", "Print the manual page, for 'man -l -'");
  manual.footer("Example:\n  flinch man | man -l -");
  manual.callback([&app, &verbs, version] {
    verbs.common = &verbs.demo.common;
    verbs.chosen = [&app, version] {
      print_results(man_page(app, version));
      return ExitStatus::done;
    };
  });
}

}  // namespace flinch
